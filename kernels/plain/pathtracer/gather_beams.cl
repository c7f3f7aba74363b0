// Light that photons bring into media. A photon scatters light all along its way through a medium, as a beam,
// and a segment of a path gets the light of those beams that pass within a radius of it (Jarosz and others
// 2011, "A Comprehensive Theory of Volumetric Radiance Estimation using Photon Points and Beams", equation
// 38).
#include "plain/pathtracer/light_parts.cl"
#include "plain/pathtracer/medium_segment.cl"

#define BEAM_SINE 0.01f  // beams that are nearly parallel to a path count as if they met it at this angle

HAVING(HAS_SCATTERING);

// Adds what the segment scatters of a beam towards its beginning, over the scattering and twice the radius.
HAVING(HAS_CAUSTICS)
static inline void scatter_beam(const PathState* path, const MediumSegment* s,
                                UNIFORM __global const float4* beam, UNIFORM float radius, int slice,
                                int deepest, SampledSpectrum* sum) {
  const float4 begin = beam[0], way = beam[1], flux = beam[2];
  const int slice_and_sent = (int)way.w;
  const float3 d = way.xyz, to = begin.xyz - s->o, normal = cross(s->d, d);
  const float sine2 = dot(normal, normal), apart = dot(to, normal);
  if (apart * apart < radius * radius * sine2 && slice_and_sent / (int)PHOTON_SLICES <= deepest &&
      slice_and_sent % (int)PHOTON_SLICES == slice) {
    const float at = dot(cross(to, d), normal) / sine2, of_beam = dot(cross(to, s->d), normal) / sine2;
    if (at > 0.0f && at < s->length && of_beam > 0.0f && of_beam < begin.w) {
      const float turned = phase_pdf(s->g, -dot(s->d, d)) / real_max(real_sqrt(sine2), BEAM_SINE);
      *sum += spectrum_over(s->decay, s->begin + at + of_beam) * spectrum_of(&path->wavelengths, flux.xyz) *
              turned;
    }
  }
}

// Whether the segment's line may meet the cone of a group of beams. At a distance x from where line and axis
// come nearest, their distance is sqrt(apart^2 + x^2 sine^2), and the cone's radius grows by growth x cosine.
HAVING(HAS_CAUSTICS)
static inline bool may_meet_beams(const MediumSegment* s, UNIFORM __global const float4* group) {
  const float4 point = group[0], way = group[1];
  const float3 to = point.xyz - s->o, normal = cross(s->d, way.xyz);
  const float sine2 = dot(normal, normal), apart = dot(to, normal),
              radius = fma(point.w, sine2, way.w * dot(cross(to, s->d), normal)),
              steep = sine2 - way.w * way.w * (1.0f - sine2);
  return !(steep > 1e-7f) || (radius >= 0.0f && radius * radius >= apart * apart * steep);
}

// The light of photons that the segment scatters towards its beginning. Each sample of a pixel looks at its
// quarter of the beams of its map, which all pixels share.
HAVING(HAS_CAUSTICS)
static SampledSpectrum gather_beams(UNIFORM const Scene* scene, PathState* path, const SceneRay* ray,
                                    const MediumSegment* s) {
  const int slice = photon_slice_of(ray), deepest = (int)scene->info->max_depth - limited_depth(path);
  SampledSpectrum sum = (SampledSpectrum)(0.0f);
  float radius = 1.0f;
  EACH_ALIKE(u32, sample, (u32)path->at.sample) {
    __global const PhotonMap* map = map_of_sample(scene, sample);
    const u32 groups = map->beam_groups, first = groups * (sample % PHOTON_MAP_SAMPLES);
    radius = map->radius;
    for (u32 i = first; i < first + groups; ++i) {
      __global const float4* group = scene->photons + map->first_beam + BEAM_GROUP_ROWS * i;
      if (may_meet_beams(s, group))
        for (u32 k = 0; k < BEAM_GROUP; ++k)
          scatter_beam(path, s, group + 2u + 3u * k, map->radius, slice, deepest, &sum);
    }
  }
  const float factor = (float)(PHOTON_MAP_SAMPLES * PHOTON_SLICES) / (2.0f * radius);
  const SampledSpectrum light = path->throughput * s->scattering * sum * factor;
  if (HAS_LIGHT_PARTS) {
    const LobeShares shares = all_of_medium();
    note_sent(path, &shares, false, light);
  }
  return light;
}
