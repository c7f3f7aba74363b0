// One bounce of a path: its ray to the next interface, the light that it meets there, the light of one lamp
// that the surface chooses, and the ray that continues.
#include "plain/light/relief_shadow.cl"
#include "plain/pathtracer/gather_photons.cl"
#include "plain/pathtracer/guides.cl"
#include "plain/pathtracer/hero.cl"
#include "plain/pathtracer/leave_surface.cl"
#include "plain/pathtracer/met_light.cl"
#include "plain/pathtracer/scatter_media.cl"
#include "plain/pathtracer/shadow_catcher.cl"

// Light on its way to a surface, of a lamp that the surface has chosen. The shadow ray waits until the path
// has its next ray: then a GPU's registers hold that and no longer the surface.
typedef struct LampLight {
  SceneRay ray;           // from the surface to the lamp
  SampledSpectrum light;  // what the surface makes of it, if all arrives
  SampledSpectrum other;  // what the path gains besides: on a GPU in memory, not in registers
  HAVING(HAS_LIGHT_GROUPS) int chosen;
  HAVING(HAS_LIGHT_PARTS) LobeShares shares;  // of the lobes that scattered it last before the camera
  HAVING(HAS_LIGHT_PARTS) bool direct;        // those are the surface's
} LampLight;

// Chooses a lamp: the light that the surface returns of it if all arrives, and the shadow ray. Returns
// whether there is any.
static bool choose_lamp(UNIFORM const Scene* scene, const PathState* path, const SceneRay* ray,
                        const Encounter* met, const SurfaceShading* at, const LobeSet* lobes, LampLight* lamp,
                        UNIFORM u32* counts) {
  const bool chooses = HAS_LIGHT_TREE || scene->info->light_count > 1u;
  const Numbers u = numbers_at(&path->at, dimension_here(path->depth, BOUNCE_LIGHT_POINT), true, chooses);
  bool seen;  // rays may meet the lamp: the path's next ray has its share
  float scattered;
  int chosen;
  const LightSample light = choose_one(scene, at->s.p, &u, &chosen, &seen);
  const float3 scattering = bsdf_scatter(scene, &at->bsdf, lobes, -ray->d, light.wi, &scattered);
  scattered = guided_pdf(scene, lobes, at->s.p, light.wi, scattered);
  const float weight = weight_of_chosen(scene, light.pdf, seen ? scattered : 0.0f);
  // The radiance of a delta light is its irradiance / pi.
  const float inverse_pdf = light.delta ? 1.0f / light.pdf : 1.0f / (M_PI_F * light.pdf);
  SampledSpectrum possible = spectrum_of(&path->wavelengths, scattering);
  possible = possible * spectrum_of(&path->wavelengths, light.radiance) * (weight * inverse_pdf);
  const bool below = dot(at->s.side, light.wi) < 0.0f;
  if (HAS_RELIEF && !below) possible *= terminator(&at->s, light.wi);
  if (HAS_PARALLAX) {
    possible *= relief_visibility(scene, &at->s, light.wi);
    possible *= walls_visibility(scene, ray, &at->s, light.wi, counts);
  }
  if (HAS_MEDIA && below) possible *= 1.0f / (lobes->interface.eta * lobes->interface.eta);
  possible *= path->throughput;
  lamp->light = kept_hero(scene, at, &lobes->interface, path->wavelengths.alone, possible);
  lamp->ray = ray_to_light(scene, ray, met, at, &light, below);
  if (HAS_LIGHT_GROUPS) lamp->chosen = chosen;
  if (HAS_LIGHT_PARTS) {
    lamp->direct = path->scatterings == 0;
    lamp->shares = path->shares;
    if (lamp->direct)
      lamp->shares = shares_of_lobes(scene, &path->wavelengths, &at->bsdf, lobes, -ray->d, light.wi, below);
  }
  return spectrum_greatest(possible) >= FLT_MIN && light.distance > 0.0f;
}

// The part of the lamp's light that arrives.
static SampledSpectrum arriving_of_lamp(UNIFORM const Scene* scene, PathState* path, LampLight* lamp,
                                        UNIFORM u32* counts) {
  count(counts, COUNT_SHADOW);
  note_ray(counts);
  const SampledSpectrum arriving =
      arriving_spectrum(scene, &path->wavelengths, &lamp->ray, lamp->light, counts);
  if (HAS_LIGHT_GROUPS) note_group(path, group_of(scene, lamp->chosen), arriving);
  if (HAS_LIGHT_PARTS) add_scattered(path, &lamp->shares, lamp->direct, arriving);
  return arriving;
}

// Notes which lobes sent the path in the direction of `sample`.
HAVING(HAS_LIGHT_PARTS)
static void note_sample(UNIFORM const Scene* scene, const SurfaceShading* at, const LobeSet* lobes, float3 wo,
                        const BsdfSample* sample, bool below, PathState* path) {
  LobeShares shares = no_lobes();
  if (below) shares.transmitted = (SampledSpectrum)(1.0f);
  if (path->scatterings == 0 && !below && !sample->specular)
    shares = shares_of_lobes(scene, &path->wavelengths, &at->bsdf, lobes, wo, sample->wi, false);
  note_scattering(path, &shares);
}

// The surface scatters: the path's next ray, and whether the path continues. `cut_out`: its texture leaves it
// out here, so the ray continues as if no surface were met, at no cost in depth.
static bool scatter(UNIFORM const Scene* scene, const Encounter* met, const SurfaceShading* at,
                    const LobeSet* lobes, bool cut_out, PathState* path, SceneRay* ray, UNIFORM u32* counts) {
  const int dimension = dimension_here(path->depth, BOUNCE_DIRECTION);
  const bool chooses = HAS_GUIDES || any(lobes->diffuse != lobes->all) ||  // matte surfaces have one lobe
                       any(path->depth >= (int)scene->info->roulette_depth);
  const Numbers u = numbers_at(&path->at, dimension, true, chooses);
  const float3 wo = -ray->d;
  const BsdfSample sample = sample_guided(scene, &at->bsdf, lobes, at->s.p, wo, &u, &path->spread);
  const bool some = greatest(sample.weight) > 0.0f, below = some && dot(at->s.side, sample.wi) < 0.0f;
  path->throughput *= spectrum_of(&path->wavelengths, sample.weight);
  if (HAS_DISPERSION && some)
    part_wavelengths(scene, at, &lobes->interface, sample.specular && !below, &path->wavelengths,
                     &path->throughput);
  if (HAS_RELIEF && !below && !sample.specular) path->throughput *= terminator(&at->s, sample.wi);
  if (HAS_MEDIA && below) {  // the radiance is spread, or comes together again
    const float square = lobes->interface.eta * lobes->interface.eta;
    path->throughput *= 1.0f / square;
    path->spread *= square;
  }
  // Shadow rays pass this surface too, so MIS still compares with light chosen at the vertex before it.
  const bool passes = below && sample.specular, straight = lobes->interface.eta == 1.0f,
             filtered = passes && (at->bsdf.flags & (int)MATERIAL_SHADOW_OPAQUE) == 0;
  if (!filtered) {
    path->pdf = sample.specular ? 0.0f : sample.pdf;
    path->from = at->s.p;
    if (HAS_FOG) path->unfog = 1.0f;
    if (HAS_SCATTERING) path->scattered.is = false;
    if (HAS_CAUSTICS) note_gathered(path, sample.specular, narrow_part(scene, &at->bsdf, lobes, wo, &sample));
  }
  if (HAS_LIGHT_PARTS) {
    if (!((passes && straight) || (filtered && path->scatterings > 0)))
      note_sample(scene, at, lobes, wo, &sample, below, path);
  }
  bool going = cut_out;
  if (some && !cut_out) going = survives(scene, path, u.w);
  if (!cut_out) ++path->depth;
  if (HAS_SHADOW_FILTERS && filtered && straight && !cut_out) ++path->passed;
  if (HAS_SHADOW_FILTERS && going &&
      (limited_depth(path) > (int)scene->info->max_depth + 1 || path->depth > MOST_SURFACES)) {
    count(counts, COUNT_DEPTH_LIMIT);
    if (path->straight) count(counts, COUNT_CAMERA_DEPTH_LIMIT);
    going = false;
  }
  path->straight = path->straight && passes && (HAS_CLEAR_GLASS || straight);
  if (!going) return false;
  if (below)
    count(counts, COUNT_REFRACTION);
  else
    count(counts, COUNT_REFLECTION);
  note_ray(counts);
  leave_surface(scene, met, at, &sample, below, cut_out, ray);
  return true;
}

// The path at a surface: adds what that sends along it to `light`. Returns whether the path continues.
static bool reach_surface(UNIFORM const Scene* scene, const Encounter* met, PathState* path, SceneRay* ray,
                          SampledSpectrum* light, OUT LampLight* lamp, UNIFORM u32* counts) {
  SurfaceShading at;
  shade_hit(scene, ray, met, &at);
  follow_hero(&path->wavelengths, &at.bsdf);
  if (HAS_CATCHERS && path->straight && (at.bsdf.flags & (int)MATERIAL_CATCHER) != 0 && may_cross(ray)) {
    pass_catcher(scene, met, &at, path, ray, counts);
    note_matte(path, at.s.instance, at.s.material, true);
    return true;
  }
  if (HAS_EMISSION)
    *light += met_light(
        path, SEEN_EMISSION, at.bsdf.flags >> (int)MATERIAL_GROUP_SHIFT,
        path->throughput * spectrum_of(&path->wavelengths, met_surface(scene, path, ray, &met->hit, &at)));
  const bool deep = limited_depth(path) > (int)scene->info->max_depth;
  const LobeSet lobes = make_lobes(scene, &at.bsdf, -ray->d);
  const bool nothing = (at.bsdf.flags & (int)MATERIAL_TRANSMITS) != 0 && cut_away(&at.bsdf, &lobes.interface);
  const bool cut_out = nothing && may_cross(ray);
  if (!nothing && path->depth == 1) count(counts, COUNT_PRIMARY_HIT);
  const int kind = at.bsdf.flags & (int)(MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE);
  const bool may_pass = cut_out || (HAS_SHADOW_FILTERS && kind == (int)MATERIAL_TRANSMITS);
  if (deep && !may_pass && (at.bsdf.flags & (int)MATERIAL_EMITS) == 0) {
    count(counts, COUNT_DEPTH_LIMIT);
    if (path->straight) count(counts, COUNT_CAMERA_DEPTH_LIMIT);
  }
  const bool scatters = !deep && scattered_share(&lobes) > 0.0f;
  bool lit = false;
  if (scene->info->light_count > 0u && scatters)
    lit = choose_lamp(scene, path, ray, met, &at, &lobes, lamp, counts);
  const Arrival arrival = arrival_of(path, ray);
  bool going = false;
  if (!deep || may_pass) going = scatter(scene, met, &at, &lobes, cut_out, path, ray, counts);
  note_matte(path, at.s.instance, at.s.material, going);
  SampledSpectrum by_photons = (SampledSpectrum)(0.0f);
  // After scatter(), for a GPU needs the most registers here.
  if (scatters) by_photons = light_of_photons(scene, path, &arrival, ray, &at, &lobes);
  if (lit) *light += arriving_of_lamp(scene, path, lamp, counts);
  *light += by_photons;
  return going;
}

// Takes the path a step further: whether it continues. The light of one that does not is complete.
// `coherent`: the rays run close together.
ENTRY static bool step_path(UNIFORM const Scene* scene, PathState* path, SceneRay* ray, OUT LampLight* lamp,
                            UNIFORM bool coherent, UNIFORM u32* counts) {
  Encounter met;
  if (HAS_MATTES) path->matte = 0.0f;
  const BegunRay begun = begun_ray_of(ray);
  const bool unseen = meet_interfaces(scene, ray, coherent, &met, counts);
  bool crossing = unseen;
  if (!crossing && path->depth == 1) crossing = pass_hidden(scene, ray, &met);
  if (HAS_GLOW)
    path->radiance += met_light(path, SEEN_EMISSION, NO_LIGHT_GROUP,
                                path->throughput * spectrum_of(&path->wavelengths, emitted(ray)));
  forget_glow(ray);
  bool turned;  // the medium has scattered the path, which may continue
  if (scatter_in_media(scene, path, &begun, ray, &met, &turned, counts)) return turned;
  path->throughput *= spectrum_kept(&path->wavelengths, met.absorbed);
  if (HAS_MATTES && unseen) note_matte(path, met.hit.instance, met.face.material, true);
  if (crossing) {  // light chosen at the last vertex cannot pass it if it stops shadow rays
    if ((met.face.flags & (int)MATERIAL_SHADOW_OPAQUE) != 0) path->pdf = 0.0f;
    return true;
  }
  lamp->other = (SampledSpectrum)(0.0f);
  if (HAS_FOG) lamp->other = met_light(path, SEEN_MEDIUM, NO_LIGHT_GROUP, met_fog(scene, &met, path));
  bool going = false;
  if (hit_anything(&met.hit)) {
    going = reach_surface(scene, &met, path, ray, &lamp->other, lamp, counts);
    path->straight = path->straight && going;
  } else {
    SampledSpectrum sky = path->throughput * spectrum_of(&path->wavelengths, met_sky(scene, path, ray->d));
    if (path->straight && scene->info->transparent != 0u) sky = (SampledSpectrum)(0.0f);
    int group = NO_LIGHT_GROUP;
    if (HAS_LIGHT_GROUPS) group = note_suns(scene, path, ray->d);
    lamp->other += met_light(path, SEEN_SKY, group, sky);
  }
  path->radiance += lamp->other;
  return going;
}
