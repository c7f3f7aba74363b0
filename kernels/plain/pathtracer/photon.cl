// One step of a photon: it moves to the next interface, where it lands or continues. Photons that were
// mirrored or bent land on surfaces that scatter light; shadow rays find the light of all others.
#include "plain/pathtracer/hero.cl"
#include "plain/pathtracer/leave_surface.cl"
#include "plain/pathtracer/medium_segment.cl"
#include "plain/pathtracer/photon_start.cl"

// The segment on which a medium scatters a photon that was mirrored or bent: one of them, chosen by how much
// light each of them scatters.
typedef struct Beam {
  float scattered;  // light on all segments so far
  float number;     // in [0, 1), to choose by
} Beam;

typedef struct Photon {
  SampledSpectrum flux;
  int depth;                              // 1 + what has sent it on
  HAVING(HAS_SHADOW_FILTERS) int passed;  // surfaces, straight on, that shadow rays pass, too
  int place;                              // among those of its launch
  SampledWavelengths wavelengths;
  bool bent;   // it has been mirrored or bent
  int dimmed;  // the light whose falling off with distance is still to come, or NOT_DIMMED
  HAVING(HAS_SCATTERING) Beam beam;
} Photon;

// The sample that has the photon's random numbers.
SampleAt sample_of_photon(UNIFORM const Scene* scene, UNIFORM const PhotonLaunch* launch, int place);

// Keeps a segment as the photon's beam, of which `beam` is the first row; `flux`: over the segment's part of
// the light.
HAVING(HAS_SCATTERING)
void keep_beam(UNIFORM __global float4* landed, int beam, float3 o, float length, float3 d,
               int slice_and_sent, float3 flux, HERE);

// The first of the three rows of a photon's beam, behind those of all photons that have landed.
ENTRY static inline int row_of_beam(UNIFORM const PhotonLaunch* launch, int place) {
  return (int)(2u * (launch->last - launch->first)) + 3 * place;
}

// A photon that has landed, with the light that it brings.
typedef struct Landing {
  bool is;
  float3 p, wi, flux;  // wi points to where it comes from
  int sent_on;         // how often it was
  int instance;        // that it lies on
} Landing;

ENTRY static inline Photon begun_photon(UNIFORM const Scene* scene, int place, const SampleAt* at,
                                        const PhotonStart* start) {
  Photon photon;
  photon.place = place;
  photon.wavelengths = choose_wavelengths(scene, at);
  photon.flux = spectrum_of(&photon.wavelengths, start->flux);
  photon.depth = 1;
  if (HAS_SHADOW_FILTERS) photon.passed = 0;
  photon.bent = false;
  photon.dimmed = start->dimmed;
  if (HAS_SCATTERING) {
    photon.beam.scattered = 0.0f;
    photon.beam.number = numbers_at(at, (int)DIMENSION_STRETCH, true, false).x;
  }
  return photon;
}

// How often surfaces have sent the photon on, without those that shadow rays pass at no cost.
static inline int times_sent_on(const Photon* photon) {
  if (HAS_SHADOW_FILTERS) return photon->depth - photon->passed - 1;
  return photon->depth - 1;
}

// A delta light falls off by its own rule up to the point p, where its photon is first bent, and beyond it as
// the rays spread. So glass receives as much as any surface there.
static inline void dim_with_distance(UNIFORM const Scene* scene, float3 p, Photon* photon) {
  if (photon->dimmed == NOT_DIMMED) return;
  EACH_ALIKE(int, index, photon->dimmed) {
    const LightSample light = way_to_lamp(scene->lights + index, p);
    const float3 sent = light.radiance * (M_PI_F * light.distance * light.distance);
    photon->flux *= spectrum_of(&photon->wavelengths, sent);
  }
  photon->dimmed = NOT_DIMMED;
}

// The factor of a flux sent from wo to wi that corrects for shading normals (Veach 1997, section 5.3.2);
// 1 where they are the geometry's.
static inline float flux_by_normals(const SurfaceInteraction* s, float3 wo, float3 wi) {
  const float shading = fabs(dot(s->ns, wo)) * fabs(dot(s->ng, wi));
  const float faces = fabs(dot(s->ng, wo)) * fabs(dot(s->ns, wi));
  return real_min(real_max(shading, 0.01f) / real_max(faces, 0.01f), 8.0f);
}

// The photon is sent on in the direction of `sample`. Returns whether it continues.
static inline bool send_on(UNIFORM const Scene* scene, const Encounter* met, const SurfaceShading* at,
                           const LobeSet* lobes, const BsdfSample* sample, Photon* photon, SceneRay* ray) {
  const bool below = dot(at->s.side, sample->wi) < 0.0f;
  const bool turns = !below || (at->bsdf.flags & (int)MATERIAL_SHADOW_OPAQUE) != 0;
  float change = 1.0f;
  if (turns) {
    dim_with_distance(scene, at->s.p, photon);
    change = flux_by_normals(&at->s, -ray->d, sample->wi);
    photon->bent = true;
  }
  photon->flux *= spectrum_of(&photon->wavelengths, sample->weight * change);
  if (HAS_DISPERSION)
    part_wavelengths(scene, at, &lobes->interface, !below, &photon->wavelengths, &photon->flux);
  const bool cut_out = cut_away(&at->bsdf, &lobes->interface) && may_cross(ray);
  if (!cut_out) ++photon->depth;
  if (HAS_SHADOW_FILTERS && !turns && !cut_out && lobes->interface.eta == 1.0f) ++photon->passed;
  if (!cut_out && times_sent_on(photon) >= (int)scene->info->max_depth) return false;
  leave_surface(scene, met, at, sample, below, cut_out, ray);
  return true;
}

// A number that has made one choice is as good for the next.
HAVING(HAS_SCATTERING)
static inline void choose_scattering(UNIFORM const Scene* scene, UNIFORM const PhotonLaunch* launch,
                                     const BegunRay* begun, const SceneRay* ray, const Encounter* met,
                                     Photon* photon, UNIFORM __global float4* landed) {
  const MediumSegment s = find_medium_segment(scene, begun, ray, met, &photon->wavelengths, photon->flux);
  if (!photon->bent || !s.scatters) return;
  const SampledSpectrum flux = photon->flux * spectrum_over(s.decay, s.begin);
  const float light = spectrum_greatest(flux) * lost_part(s.mean * s.length);
  if (!(light > 0.0f)) return;
  photon->beam.scattered += light;
  const float chance = light / photon->beam.scattered;
  const bool taken = photon->beam.number < chance;
  photon->beam.number =
      taken ? photon->beam.number / chance : (photon->beam.number - chance) / real_max(1.0f - chance, 1e-6f);
  if (!taken) return;
  const float3 seen = spectrum_seen(scene, &photon->wavelengths, &flux) * (1.0f / light);
  keep_beam(landed, row_of_beam(launch, photon->place), s.o, s.length, s.d,
            photon_slice_of(ray) + (int)PHOTON_SLICES * times_sent_on(photon), seen);
}

// Perhaps takes the photon's segment for its beam.
static inline void choose_beam(UNIFORM const Scene* scene, UNIFORM const PhotonLaunch* launch,
                               const BegunRay* begun, const SceneRay* ray, const Encounter* met,
                               Photon* photon, UNIFORM __global float4* landed) {
  if (HAS_SCATTERING) choose_scattering(scene, launch, begun, ray, met, photon, landed);
}

// Moves the photon by one step. Returns whether it continues; `landing`: it ends on a surface that scatters
// light.
ENTRY static bool step_photon(UNIFORM const Scene* scene, UNIFORM const PhotonLaunch* launch, Photon* photon,
                              SceneRay* ray, Landing* landing, UNIFORM __global float4* landed,
                              UNIFORM u32* counts) {
  Encounter met;
  landing->is = false;
  const BegunRay begun = begun_ray_of(ray);
  const bool unseen = meet_interfaces(scene, ray, false, &met, counts);
  forget_glow(ray);
  choose_beam(scene, launch, &begun, ray, &met, photon, landed);
  photon->flux *= spectrum_kept(&photon->wavelengths, met.absorbed);
  if (unseen || !hit_anything(&met.hit)) return unseen;
  if (HAS_FOG) photon->flux *= clear_of_fog(scene, &met);
  SurfaceShading at;
  shade_hit(scene, ray, &met, &at);
  follow_hero(&photon->wavelengths, &at.bsdf);
  const LobeSet lobes = make_lobes(scene, &at.bsdf, -ray->d);
  const SampleAt sampled = sample_of_photon(scene, launch, photon->place);
  const Numbers u = numbers_at(&sampled, dimension_here(photon->depth, BOUNCE_DIRECTION), false, true);
  const BsdfSample sample = sample_perfect(&at.bsdf, &lobes, -ray->d, u.z * lobes.all);
  if (!sample.specular) {
    // On a surface that scatters and mirrors, chance decides which of the two the photon represents.
    const float rest = scattered_share(&lobes);
    if (photon->bent && rest > 0.0f && spectrum_greatest(photon->flux) > 0.0f) {
      const SampledSpectrum flux = photon->flux * (lobes.all / rest);
      const Landing here = {true,
                            at.s.p,
                            -ray->d,
                            spectrum_seen(scene, &photon->wavelengths, &flux),
                            times_sent_on(photon),
                            at.s.instance};
      *landing = here;
    }
    return false;
  }
  if (!(greatest(sample.weight) > 0.0f)) return false;
  return send_on(scene, &met, &at, &lobes, &sample, photon, ray);
}
