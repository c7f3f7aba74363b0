// The parts of a path's light (shared/light_parts.h). Light that the camera sees without a scattering between
// is emission, sky or a medium's. All other light belongs to the lobe that scattered it last on its way to
// the camera. It is direct if nothing else did: shadow rays count as scattered by nothing in the filters that
// they pass. A lobe's part is the light that it returns of a direction, whichever lobe chose the direction.
#include "plain/pathtracer/path_state.cl"
#include "plain/shade/lobes.cl"

#define SEEN_EMISSION 0
#define SEEN_MEDIUM 1
#define SEEN_SKY 2

// bsdf_scatter() of the lobes that are not diffuse.
HAVING(HAS_LIGHT_PARTS)
static inline float3 glossy_scatter(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                    float3 wo, float3 wi) {
  float unused;
  Bsdf glossy_bsdf = *bsdf;
  LobeSet glossy = *lobes;
#define KEEP_GLOSSY(feature, name, flags) \
  if (feature) drop_matte_##name(&glossy_bsdf, &glossy);
  MATTE_LOBES(KEEP_GLOSSY)
  return bsdf_scatter(scene, &glossy_bsdf, &glossy, wo, wi, &unused);
}

// a over b; 0 where b is.
static inline float part_of(float a, float b) { return b > 0.0f ? real_clamp(a / b, 0.0f, 1.0f) : 0.0f; }
static inline SampledSpectrum spectrum_part(SampledSpectrum a, SampledSpectrum b) {
  SampledSpectrum part;
  part.x = part_of(a.x, b.x);
  part.y = part_of(a.y, b.y);
  part.z = part_of(a.z, b.z);
  if (HAS_DISPERSION) part.w = part_of(a.w, b.w);
  return part;
}

static inline LobeShares no_lobes(void) {
  LobeShares shares;
  shares.diffuse = (SampledSpectrum)(0.0f);
  shares.transmitted = (SampledSpectrum)(0.0f);
  shares.medium = false;
  return shares;
}

static inline LobeShares all_of_medium(void) {
  LobeShares shares = no_lobes();
  shares.medium = true;
  return shares;
}

// The shares of a surface's lobes in light from wi; `below`: from behind it.
HAVING(HAS_LIGHT_PARTS)
static LobeShares shares_of_lobes(UNIFORM const Scene* scene, const SampledWavelengths* w, const Bsdf* bsdf,
                                  const LobeSet* lobes, float3 wo, float3 wi, bool below) {
  LobeShares shares = no_lobes();
  if (below) {
    shares.transmitted = (SampledSpectrum)(1.0f);
  } else {
    float unused;
    const float3 all = bsdf_scatter(scene, bsdf, lobes, wo, wi, &unused);
    const float3 diffuse = all - glossy_scatter(scene, bsdf, lobes, wo, wi);
    shares.diffuse = spectrum_part(spectrum_of(w, diffuse), spectrum_of(w, all));
  }
  return shares;
}

// Adds light to the parts of the lobes that scattered it last before the camera.
HAVING(HAS_LIGHT_PARTS)
static void add_scattered(PathState* path, const LobeShares* shares, bool direct, SampledSpectrum light) {
  const SampledSpectrum none = (SampledSpectrum)(0.0f), of_surface = shares->medium ? none : light;
  const SampledSpectrum volume = light - of_surface, diffuse = of_surface * shares->diffuse,
                        transmitted = of_surface * shares->transmitted;
  const SampledSpectrum glossy = of_surface - diffuse - transmitted;
  if (direct) {
    path->parts.diffuse_direct += diffuse;
    path->parts.glossy_direct += glossy;
    path->parts.transmission_direct += transmitted;
    path->parts.volume_direct += volume;
  } else {
    path->parts.diffuse_indirect += diffuse;
    path->parts.glossy_indirect += glossy;
    path->parts.transmission_indirect += transmitted;
    path->parts.volume_indirect += volume;
  }
}

// Adds light to its group of lights, whatever has scattered it.
HAVING(HAS_LIGHT_GROUPS)
static inline void note_group(PathState* path, int group, SampledSpectrum light) {
  int number = 0;
  bool here;
#define ADD_TO_GROUP(name)             \
  here = group == number;              \
  if (here) path->parts.name += light; \
  ++number;
  LIGHT_PARTS(ADD_TO_GROUP)
}

// Light that the path's ray meets, which is the part `seen` where nothing has scattered the ray.
static inline SampledSpectrum met_light(PathState* path, UNIFORM int seen, int group, SampledSpectrum light) {
  if (HAS_LIGHT_GROUPS) note_group(path, group, light);
  if (HAS_LIGHT_PARTS) {
    if (path->scatterings > 0) {
      add_scattered(path, &path->shares, path->scatterings == 1, light);
    } else {
      if (seen < SEEN_MEDIUM) path->parts.emission += light;
      if (seen > SEEN_MEDIUM) path->parts.sky += light;
      if (seen >= SEEN_MEDIUM && seen < SEEN_SKY) path->parts.volume_direct += light;
    }
  }
  return light;
}

// Light that a surface or a medium with these shares scatters to the path; `direct`: of a lamp.
HAVING(HAS_LIGHT_PARTS)
static inline void note_sent(PathState* path, const LobeShares* shares, bool direct, SampledSpectrum light) {
  if (path->scatterings > 0)
    add_scattered(path, &path->shares, false, light);
  else
    add_scattered(path, shares, direct, light);
}

// The path's ray is scattered by lobes with these shares.
HAVING(HAS_LIGHT_PARTS)
static inline void note_scattering(PathState* path, const LobeShares* shares) {
  if (path->scatterings == 0) path->shares = *shares;
  ++path->scatterings;
}
