// Follows a ray to its next visible surface, adds the lights through shadow filters, then recurses into the
// reflected and the refracted ray; surface.h shades, media.h keeps the media.
#include "bench/plain/whitted.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/image_compare.h"
#include "bench/plain/media.h"
#include "bench/plain/random.h"
#include "bench/plain/surface.h"
#include "compile/surfaces/lobes.h"

namespace sundog {
namespace plain {
namespace {

using glm::vec3;

constexpr int most_crossings = 64;  // invisible interfaces, or filters, along one ray

float greatest(const vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

// The next surface on a ray.
struct Encounter {
  bool found = false;
  Hit hit;
  u32 before = 0, after = 0;  // media in front of and behind the surface
  bool entering = false;
  vec3 absorbed{1};
};

bool has_interior(const Material& material) {
  return (material.flags & MATERIAL_TRANSMITS) && !(material.flags & MATERIAL_THIN);
}

bool is_invisible(const CompiledScene& scene, const Encounter& e, const Material& material) {
  return e.after == e.before || ((material.flags & MATERIAL_CLEAR) &&
                                 scene.media[e.after].absorption.w == scene.media[e.before].absorption.w);
}

/// Follows the ray to the next visible surface. `media`: in, the media at the ray's start; out, those in
/// front of the surface.
Encounter next_surface(const CompiledScene& scene, Ray ray, MediaStack& media) {
  Encounter e;
  float from = 0;
  for (int crossing = 0;; ++crossing) {
    e.before = e.after = media.current(scene);
    e.found = closest_hit(scene, ray, e.hit);
    if (!e.found) {
      e.absorbed *= absorb(scene, e.before, ray.t_max - from);
      return e;
    }
    const Material& material = material_of(scene, e.hit);
    e.entering = glm::dot(world_normal(scene.instances[e.hit.instance], e.hit.ng), ray.d) < 0;
    if (has_interior(material)) {
      MediaStack crossed = media;
      crossed.cross(material.medium, e.entering);
      e.after = crossed.current(scene);
      if (is_invisible(scene, e, material) && crossing < most_crossings) {
        if (e.after != e.before) {
          e.absorbed *= absorb(scene, e.before, e.hit.t - from);
          from = e.hit.t;
        }
        media = crossed;
        ray.t_min = e.hit.t;
        continue;
      }
    }
    e.absorbed *= absorb(scene, e.before, e.hit.t - from);
    return e;
  }
}

/// The share of light that passes straight through one transmissive interface.
vec3 filter(const CompiledScene& scene, const Material& material, const Hit& hit, const vec3& wi, u32 here,
            u32 there) {
  vec3 through = rgb(material.transmission);
  if (material.kind == MATERIAL_DIELECTRIC) {
    const float ratio = scene.media[there].absorption.w / scene.media[here].absorption.w;
    const vec3 n = glm::normalize(world_normal(scene.instances[hit.instance], hit.ng));
    through *= 1 - fresnel(std::min(std::abs(glm::dot(n, wi)), 1.0f), std::max(ratio, 1 / ratio));
  }
  return through;
}

/// The share of a light that arrives along the ray from t_max.
vec3 visibility(const CompiledScene& scene, Ray ray, MediaStack media) {
  if (!scene.features.shadow_filters)
    return any_hit(scene, ray) ? vec3(0) : absorb(scene, media.current(scene), ray.t_max);
  vec3 through(1);
  float from = 0;
  for (int i = 0; i < most_crossings; ++i) {
    Hit hit;
    const u32 here = media.current(scene);
    if (!closest_hit(scene, ray, hit)) return through * absorb(scene, here, ray.t_max - from);
    const Material& material = material_of(scene, hit);
    if (!(material.flags & MATERIAL_TRANSMITS) || (material.flags & MATERIAL_SHADOW_OPAQUE)) return vec3(0);
    ray.t_min = hit.t;
    u32 there = here;
    if (has_interior(material)) {
      media.cross(material.medium, glm::dot(world_normal(scene.instances[hit.instance], hit.ng), ray.d) < 0);
      there = media.current(scene);
      if (there == here) continue;
      through *= absorb(scene, here, hit.t - from);
      from = hit.t;
    }
    through *= filter(scene, material, hit, ray.d, here, there);
    if (!(greatest(through) > 0)) return vec3(0);
  }
  return vec3(0);
}

struct Path {
  Ray ray;
  MediaStack media;
  u32 depth = 1;
  vec3 throughput{1};
};

vec3 trace(const CompiledScene& scene, const Path& start, float* coverage);

vec3 background(const SceneInfo& info, const vec3& d) {
  const float s = std::clamp(0.5f + 0.5f * glm::dot(d, rgb(info.up)), 0.0f, 1.0f);
  return glm::mix(rgb(info.background_bottom), rgb(info.background_top), s);
}

vec3 direct_light(const CompiledScene& scene, const Path& path, const Surface& s) {
  vec3 sum = s.ambient * rgb(scene.info.ambient);
  for (const Light& light : scene.lights) {
    const LightSample sample = sample_light(light, s.p);
    if (!(glm::dot(s.ns, sample.wi) > 0)) continue;
    const vec3 possible = sample.radiance * local_reflection(s, path.ray.d, sample.wi);
    if (!(greatest(possible) >= std::numeric_limits<float>::min())) continue;
    const float share = scene.info.cutoff * LEAST_OF_LIGHT * greatest(sample.radiance);
    if (greatest(path.throughput * possible) < share) continue;
    sum += possible *
           visibility(scene, {s.p + (s.offset + s.lift) * s.ng, sample.wi, 0, sample.distance}, path.media);
  }
  return sum;
}

/// kr I(reflected) or kt I(transmitted), unless the ray is too weak or too deep.
vec3 follow(const CompiledScene& scene, const Path& parent, const vec3& factor, const vec3& o, const vec3& d,
            const MediaStack& media) {
  const vec3 throughput = parent.throughput * factor;
  if (!(greatest(throughput) > 0) || greatest(throughput) < scene.info.cutoff ||
      parent.depth >= scene.info.max_depth)
    return vec3(0);
  const Ray ray{o, d, 0, std::numeric_limits<float>::infinity()};
  return factor * trace(scene, {ray, media, parent.depth + 1, throughput}, nullptr);
}

vec3 reflected(const vec3& d, const Surface& s) {
  const vec3 direction = glm::reflect(d, s.ns);
  return glm::normalize(glm::dot(direction, s.side) > 0 ? direction : glm::reflect(d, s.side));
}

vec3 bend(const vec3& d, const vec3& n, float eta) {
  const float cos_i = std::clamp(-glm::dot(n, d), 0.0f, 1.0f);
  return glm::normalize(d / eta + (cos_i / eta - refracted_cosine(cos_i, eta)) * n);
}

vec3 refracted(const vec3& d, const Surface& s, float eta) {
  if (eta == 1) return d;
  const vec3 direction = bend(d, s.ns, eta);
  return glm::dot(direction, s.ng) < 0 ? direction : bend(d, s.ng, eta);
}

vec3 secondary_light(const CompiledScene& scene, const Path& path, const Encounter& e, const Surface& s) {
  const Material& material = *s.material;
  const bool transmits = material.flags & MATERIAL_TRANSMITS, interior = has_interior(material);
  vec3 kr = rgb(material.reflection), kt = transmits ? rgb(material.transmission) : vec3(0);
  if (!(greatest(kr) > 0) && !(greatest(kt) > 0)) return vec3(0);
  const float eta = interior ? scene.media[e.after].absorption.w / scene.media[e.before].absorption.w : 1;
  const float cos_i = std::clamp(-glm::dot(s.ns, path.ray.d), 0.0f, 1.0f);
  if (material.kind == MATERIAL_DIELECTRIC) {
    const float f = fresnel(cos_i, eta);
    kr *= f;
    kt *= 1 - f;
  } else if (transmits && refracted_cosine(cos_i, eta) <= 0) {
    kr += kt;
    kt = vec3(0);
  }
  const vec3 off = s.offset * s.ng;
  const vec3 before = s.p + (s.offset + s.lift) * s.ng;
  vec3 sum = follow(scene, path, kr, before, reflected(path.ray.d, s), path.media);
  if (!transmits) return sum;
  MediaStack inside = path.media;
  if (interior) inside.cross(material.medium, e.entering);
  return sum + follow(scene, path, kt, s.p - off, refracted(path.ray.d, s, eta), inside);
}

/// I = ka Ia + sum of Ij (kd n.l + ks (r.v)^b) Vj + kr I(reflected) + kt I(transmitted).
vec3 trace(const CompiledScene& scene, const Path& start, float* coverage) {
  Path path = start;
  const Encounter e = next_surface(scene, path.ray, path.media);
  if (!e.found) return e.absorbed * background(scene.info, path.ray.d);
  if (coverage) *coverage = 1;
  path.throughput *= e.absorbed;
  const Surface s = make_surface(scene, path.ray, e.hit);
  return e.absorbed * (direct_light(scene, path, s) + secondary_light(scene, path, e, s));
}

/// The media that contain the camera: those that a line from it leaves without having entered them.
MediaStack camera_media(const CompiledScene& scene) {
  MediaStack entered, holding;
  if (!scene.features.camera_inside) return holding;
  Ray ray{rgb(scene.info.camera_position), glm::normalize(vec3(0.3141f, 0.8660f, 0.3890f)), 0,
          std::numeric_limits<float>::infinity()};
  Hit hit;
  for (int i = 0; i < 4096 && closest_hit(scene, ray, hit); ++i, ray.t_min = hit.t) {
    const Material& material = material_of(scene, hit);
    if (!has_interior(material)) continue;
    const bool entering = glm::dot(world_normal(scene.instances[hit.instance], hit.ng), ray.d) < 0;
    if (!entered.cross(material.medium, entering) && !entering) holding.put_under(material.medium);
  }
  return holding;
}

/// The kernels' sample positions, so that the pictures can be compared: a Hammersley set shifted in each
/// pixel.
glm::vec2 sample_offset(u32 x, u32 y, u32 sample, u32 samples) {
  if (samples <= 1) return glm::vec2(0.5f);
  u32 mirrored = 0;
  for (u32 bit = 0; bit < 32; ++bit) mirrored |= (sample >> bit & 1u) << (31 - bit);
  const float a = (static_cast<float>(sample) + 0.5f) / static_cast<float>(samples) +
                  unit_float(random_word(x + random_word(y + random_word(0))));
  return {std::min(a - std::floor(a), 0x1.fffffep-1f),
          unit_float(mirrored + random_word(x + random_word(y + random_word(1))))};
}

Path camera_path(const SceneInfo& info, float x, float y, const MediaStack& media) {
  const vec3 along = rgb(info.camera_corner) + x * rgb(info.camera_dx) + y * rgb(info.camera_dy);
  const float length = glm::length(along);
  Path path;
  path.ray = {rgb(info.camera_position), along / length, info.camera_forward.w * length,
              info.background_bottom.w * length};
  path.media = media;
  return path;
}

}  // namespace
}  // namespace plain

std::string plain_refusal(const CompiledScene& scene) {
  if (scene.features.shapes[SHAPE_SDF]) return "the plain C++ program knows no distance fields";
  if (scene.features.maps) return "the plain C++ program knows no textures, emission or opacity";
  if (scene.features.fog || scene.features.glow) return "the plain C++ program knows no fog and no glow";
  if (scene.features.sampler != SAMPLER_AUTO || scene.features.filter)
    return "the plain C++ program knows the default sampler and filter alone";
  for (const LobeRow& lobe : lobe_rows)
    if (lobe.feature && scene.features.*lobe.feature && !plain::knows_lobe(lobe.name))
      return fmt::format("the plain C++ program knows no {} lobe", lobe.name);
  if (scene.features.thin_walls) return "the plain C++ program knows no thin walls";
  if (scene.features.object_motion) return "the plain C++ program knows no motion";
  if (scene.features.sky) return "the plain C++ program knows no sky";
  if (!std::ranges::all_of(scene.lights, [](const Light& light) { return plain::knows_light(light.kind); }))
    return "the plain C++ program knows no such light";
  return {};
}

std::string plain_difference(const Image& plain, const Image& device) {
  constexpr double visible = 0.02, most_mean = 1e-3;
  const ImageDifference difference = compare_images(plain, device, visible);
  // One pixel in 200, and one more for pictures of a few pixels.
  if (difference.over_tolerance <= 1 + difference.pixels / 200 && difference.mean <= most_mean) return {};
  return fmt::format(
      "its image is not the device's: {} of {} pixels differ by more than {}, {:.2g} in the mean",
      difference.over_tolerance, difference.pixels, visible, difference.mean);
}

Image render_plain(const CompiledScene& scene) {
  const SceneInfo& info = scene.info;
  const plain::MediaStack media = plain::camera_media(scene);
  Image image(static_cast<int>(info.width), static_cast<int>(info.height), 4);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const auto x = static_cast<u32>(column), y = static_cast<u32>(row);
      glm::vec4 sum(0);
      for (u32 sample = 0; sample < info.samples; ++sample) {
        const glm::vec2 at = plain::sample_offset(x, y, sample, info.samples);
        float coverage = 0;
        const plain::Path path =
            plain::camera_path(info, static_cast<float>(x) + at.x, static_cast<float>(y) + at.y, media);
        const glm::vec3 color = plain::trace(scene, path, &coverage);
        sum += glm::vec4(color, coverage);
      }
      for (int c = 0; c < 4; ++c) image.pixel(column, row)[c] = sum[c] / static_cast<float>(info.samples);
    }
  return image;
}

}  // namespace sundog
