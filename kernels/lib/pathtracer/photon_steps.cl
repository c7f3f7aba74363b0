// One step of a batch of photons: each moves to the next interface, where it lands or continues. Photons that
// were mirrored or bent land on surfaces that scatter light; shadow rays find the light of all others. A
// photon a lane.
#ifndef SUNDOG_LIB_PHOTON_STEPS_CL
#define SUNDOG_LIB_PHOTON_STEPS_CL
#include "lib/pathtracer/leave_surfaces.cl"
#include "lib/pathtracer/photon_start.cl"

typedef struct Photons {
  PathStates paths;  // throughput is the flux; depth 1 + what has sent the photon on
  MASK bent;         // it has been mirrored or bent
  MASK dimmed;       // PhotonStarts.dimmed, while that is not done
} Photons;

// Photons that have landed, with the light that they bring.
typedef struct Landings {
  REAL3 p, wi, flux;  // wi points to where they come from
  MASK sent_on;       // how often they were
  MASK lanes;
} Landings;

static inline Photons begun_photons(const Scene* scene, const PhotonStarts* starts, const LaneSamples* at) {
  Photons photons;
  photons.paths = start_paths(scene, at, starts->lanes);
  photons.paths.throughput = spectrum_of(&photons.paths.wavelengths, starts->flux);
  photons.bent = NO_LANES;
  photons.dimmed = starts->dimmed;
  return photons;
}

// A light without extent falls off by its own rule up to the points p, where its photons are first bent, and
// beyond them as the rays spread. So glass receives as much as any surface there.
static inline void dim_with_distance(const Scene* scene, REAL3 p, MASK lanes, Photons* photons) {
  u32 index;
  for (u32 left = lane_bits(lanes & MASK_OF(photons->dimmed != NOT_DIMMED)); left;) {
    const MASK mine = take_alike(photons->dimmed, &left, &index);
    const LightSamples light = way_to_lamp(scene->lights + index, p);
    const REAL3 sent = scale3(light.radiance, M_PI_F * light.distance * light.distance);
    photons->paths.throughput = spectrum_select(
        photons->paths.throughput,
        spectrum_multiply(photons->paths.throughput, spectrum_of(&photons->paths.wavelengths, sent)), mine);
  }
  photons->dimmed = select(photons->dimmed, (MASK)(NOT_DIMMED), lanes);
}

// What shading normals change of a flux that is sent from wo to wi (Veach 1997, section 5.3.2). 1 where they
// are those of the geometry.
static inline REAL flux_by_normals(const Bsdfs* bsdf, REAL3 wo, REAL3 wi) {
  const REAL least = (REAL)(0.01f);
  const REAL shading = fabs(dot3(bsdf->ns, wo)) * fabs(dot3(bsdf->ng, wi));
  const REAL faces = fabs(dot3(bsdf->ng, wo)) * fabs(dot3(bsdf->ns, wi));
  return real_min(real_max(shading, least) / real_max(faces, least), (REAL)(8.0f));
}

// The photons of `lanes` are sent on in the directions of `sample`. Returns those that continue.
static inline MASK send_on(const Scene* scene, const Encounters* met, const Shading* at, const Lobes* lobes,
                           const BsdfSamples* sample, Photons* photons, SceneRays* rays, MASK lanes) {
  PathStates* paths = &photons->paths;
  const REAL3 wo = negate3(rays->d);
  const MASK below = lanes & MASK_OF(dot3(at->s.ng, sample->wi) < 0.0f);
  const MASK passes = below & MASK_OF((at->bsdf.flags & (int)MATERIAL_SHADOW_OPAQUE) == 0);
  const MASK turns = lanes & ~passes;
  dim_with_distance(scene, at->s.p, turns, photons);
  const REAL change = select((REAL)(1.0f), flux_by_normals(&at->bsdf, wo, sample->wi), turns);
  const SampledSpectrum weight = spectrum_of(&paths->wavelengths, scale3(sample->weight, change));
  paths->throughput = spectrum_select(paths->throughput, spectrum_multiply(paths->throughput, weight), lanes);
  part_wavelengths(scene, at, &lobes->split, paths, lanes, lanes & ~below);
  photons->bent |= turns;
  const MASK free = cut_away(&at->bsdf, &lobes->split, lanes) & may_cross(rays);
  paths->depth -= lanes & ~free;
  const MASK going = lanes & (free | MASK_OF(paths->depth <= (int)scene->info->max_depth));
  leave_surface(scene, met, at, sample, going & below, going & free, rays, going);
  return going;
}

// Moves the photons of `lanes` by one step. Returns those that continue; `landed` are those that end on a
// surface that scatters light.
NEVER_INLINE MASK step_photons(const Scene* scene, Photons* photons, SceneRays* rays, MASK lanes,
                               Landings* landed, u32* counts) {
  Encounters met;
  PathStates* paths = &photons->paths;
  landed->lanes = NO_LANES;
  const MASK unseen = lanes & meet_interfaces(scene, rays, lanes, false, &met, counts);
  forget_glow(rays);
  paths->throughput = spectrum_select(
      paths->throughput,
      spectrum_multiply(paths->throughput, spectrum_kept(&paths->wavelengths, met.absorbed)), lanes);
  const MASK hit = lanes & ~unseen & hit_anything(&met.hit);
  if (!any_lane(hit)) return unseen;
  if (HAS_FOG) paths->throughput = spectrum_scale(paths->throughput, clear_of_fog(scene, &met, hit));
  Shading at;
  shade_hits(scene, rays, &met, hit, &at);
  follow_hero(&paths->wavelengths, &at.bsdf);
  const REAL3 wo = negate3(rays->d);
  const Lobes lobes = make_lobes(scene, &at.bsdf, wo, hit);
  const FourNumbers u = wanted_lanes(&paths->at, dimension_here(paths, BOUNCE_DIRECTION), false, true);
  const BsdfSamples sample = sample_perfect_lobes(&at.bsdf, &lobes, wo, u.z, hit);
  const MASK perfect = hit & sample.specular, some = MASK_OF(greatest3(sample.weight) > 0.0f);
  // On a surface that scatters and mirrors, chance decides which of the two the photon represents.
  const REAL one = (REAL)(1.0f), rest = scattered_share(&lobes);
  const MASK lands = hit & ~perfect & photons->bent & MASK_OF(rest > 0.0f) &
                     MASK_OF(spectrum_greatest(paths->throughput) > 0.0f);
  landed->p = at.s.p;
  landed->wi = wo;
  landed->sent_on = paths->depth - 1;
  landed->lanes = lands;
  if (any_lane(lands)) {
    const SampledSpectrum flux = spectrum_scale(paths->throughput, lobes.all / select(one, rest, lands));
    landed->flux = spectrum_seen(scene, &paths->wavelengths, &flux, lands);
  }
  return unseen | send_on(scene, &met, &at, &lobes, &sample, photons, rays, perfect & some);
}

#endif
