// The stack of media that travels with a ray. Where solids overlap, the medium of highest priority applies;
// among equal priorities, the last entered (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced
// Images").
#include "plain/path/scene_ray.cl"

// Index of the effective medium; 0 is the world's.
static inline int current_medium(UNIFORM __global const Medium* media, const MediaStack* stack) {
  u32 low = (u32)stack->low, high = (u32)stack->high;
  int best = max((int)(low & 0xFFu) - 1, 0);
  while (low > 0xFFu) {
    low = low >> 8 | high << 24;
    high = high >> 8;
    const int medium = (int)(low & 0xFFu) - 1;
    if (media[medium].priority > media[best].priority) best = medium;
  }
  return best;
}
static inline int current_media(UNIFORM __global const Medium* media, const SceneRay* ray) {
  return current_medium(media, &ray->media);
}

// Removes the newest byte `entry` of a word; `above`: the next word. Returns whether it was there.
static inline bool remove_entry(int* word, int above, u32 entry) {
  const u32 old = (u32)*word, moved = old >> 8 | (u32)above << 24, other = old ^ entry * 0x01010101u;
  const u32 alike = (other - 0x01010101u) & ~other & 0x80808080u;  // its lowest bit ends the newest
  const u32 newer = ((alike & (0u - alike)) >> 7) - 1u;
  if (alike != 0u) *word = (int)((old & newer) | (moved & ~newer));
  return alike != 0u;
}

// Enters or leaves `medium`. Returns false if the stack is full or the medium was never entered.
static inline bool cross_boundary(MediaStack* stack, int medium, bool entering) {
  const u32 entry = (u32)medium + 1u, low = (u32)stack->low, high = (u32)stack->high;
  bool done = high <= 0xFFFFFFu;
  if (!entering) {
    done = remove_entry(&stack->low, stack->high, entry);
    if (done)
      stack->high = (int)(high >> 8);
    else
      done = remove_entry(&stack->high, 0, entry);
  } else if (done) {
    stack->high = (int)(high << 8 | low >> 24);
    stack->low = (int)(low << 8 | entry);
  }
  return done;
}

// Adds a medium below all others, if there is room.
static inline bool append_entry(int* word, u32 entry) {
  for (u32 shift = 0u; shift < 32u; shift += 8u)
    if ((u32)*word >> shift == 0u) {
      *word = *word | (int)(entry << shift);
      return true;
    }
  return false;
}
ENTRY static inline UNIFORM bool put_below(UNIFORM MediaStack* stack, UNIFORM int medium) {
  const u32 entry = (u32)medium + 1u;
  return append_entry(&stack->low, entry) || append_entry(&stack->high, entry);
}

// cross_boundary() for hand-written code about one ray.
ENTRY static inline UNIFORM bool cross_one(UNIFORM MediaStack* stack, UNIFORM int medium,
                                           UNIFORM bool entering) {
  return cross_boundary(stack, medium, entering);
}
ENTRY static inline UNIFORM int current_of_one(UNIFORM __global const Medium* media,
                                               UNIFORM const MediaStack* stack) {
  return current_medium(media, stack);
}

// Beer-Lambert: transmittance over `distance` in a medium.
ENTRY static inline float3 absorb(UNIFORM __global const Medium* media, int medium, float distance) {
  float3 kept = (float3)(1.0f);
  if (HAS_ABSORPTION) EACH_ALIKE(int, index, medium) {
      const float3 a = media[index].absorption.xyz;
      // Unabsorbed colours keep their bits, even over infinite distances.
      if (a.x != 0.0f) kept.x = real_exp(-a.x * distance);
      if (a.y != 0.0f) kept.y = real_exp(-a.y * distance);
      if (a.z != 0.0f) kept.z = real_exp(-a.z * distance);
    }
  return kept;
}

static inline float refraction_index(UNIFORM __global const Medium* media, int medium) {
  float index = 1.0f;
  EACH_ALIKE(int, at, medium) index = media[at].absorption.w;
  return index;
}

// Refractive index behind an interface over that before it.
static inline float relative_index(UNIFORM __global const Medium* media, int before, int after) {
  if (!HAS_MEDIA) return 1.0f;
  return refraction_index(media, after) / refraction_index(media, before);
}

// Whether an interface between these media refracts at no wavelength.
static inline bool same_index(UNIFORM __global const Medium* media, int a, int b) {
  bool same = media[a].absorption.w == media[b].absorption.w;
  if (HAS_DISPERSION && same) same = media[a].spectrum == media[b].spectrum;
  return same;
}

HAVING(HAS_DISPERSION);

// The index at a wavelength: a (fractional) row of the table `spectra`.
static inline float index_at(UNIFORM const Scene* scene, int medium, float row) {
  float index = 1.0f;
  EACH_ALIKE(int, at, medium) {
    const u32 first = scene->media[at].spectrum;
    if (first == NO_SPECTRUM)
      index = scene->media[at].absorption.w;
    else
      index = spectrum_at(scene, first, row);
  }
  return index;
}
static inline float relative_index_at(UNIFORM const Scene* scene, int before, int after, float row) {
  return index_at(scene, after, row) / index_at(scene, before, row);
}

// Whether the relative index depends on the wavelength.
static inline bool disperses(UNIFORM const Scene* scene, int before, int after) {
  bool found = false;
  if (before == after) return false;
  EACH_ALIKE(int, at, before) found = scene->media[at].spectrum != NO_SPECTRUM;
  EACH_ALIKE(int, at, after) found = found || scene->media[at].spectrum != NO_SPECTRUM;
  return found;
}
