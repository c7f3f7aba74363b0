// Orders primary rays by tiles, and starts the other kinds at their hits; glass rays cross up to 5 surfaces.
#include "bench/rays/ray_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "bench/plain/random.h"
#include "bench/plain/surface.h"
#include "scene/kinds.h"

namespace sundog {
namespace {

using glm::vec3;

constexpr float endless = std::numeric_limits<float>::infinity();
constexpr unsigned tile = 16, block = 4;

float uniform(u32 x) { return unit_float(random_word(x)); }

Ray make_ray(const vec3& o, const vec3& d, float t_max) { return {o.x, o.y, o.z, 0, d.x, d.y, d.z, t_max}; }

vec3 origin(const Ray& ray) { return {ray.ox, ray.oy, ray.oz}; }
vec3 direction(const Ray& ray) { return {ray.dx, ray.dy, ray.dz}; }
vec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

/// The point where a ray hit a surface, and the data needed to start a ray there.
struct Surface {
  vec3 p, n;      // n: unit, against the ray
  float offset;   // of the start of new rays from the surface
  bool entering;  // the ray comes from outside
};

std::optional<Surface> surface_at(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  if (hit.instance == NO_INSTANCE) return std::nullopt;
  const Instance& instance = scene.instances[hit.instance];
  const vec3 ng(hit.ng_x, hit.ng_y, hit.ng_z);
  const vec3 n = plain::world_normal(instance, ng);
  const float length = glm::length(n);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  Surface surface;
  surface.p = origin(ray) + hit.t * direction(ray);
  surface.n = n / length;
  surface.entering = glm::dot(surface.n, direction(ray)) < 0;
  if (!surface.entering) surface.n = -surface.n;
  const plain::Hit met{hit.t, hit.u, hit.v, hit.prim, hit.instance, ng};
  surface.offset = plain::start_offset(scene, origin(ray), met, surface.p, n);
  return surface;
}

vec3 cosine_direction(const vec3& n, u32 seed) {
  const float u = uniform(2 * seed + 1), angle = 2 * std::numbers::pi_v<float> * uniform(2 * seed + 2);
  const vec3 t = glm::normalize(glm::cross(std::abs(n.x) > 0.5f ? vec3(0, 1, 0) : vec3(1, 0, 0), n));
  const vec3 b = glm::cross(n, t);
  const float r = std::sqrt(u);
  return glm::normalize(r * std::cos(angle) * t + r * std::sin(angle) * b + std::sqrt(1 - u) * n);
}

/// Appends the reflected and the refracted rays of rays that hit a glass surface. `reflect_outside`: also
/// reflect rays that come from outside.
void glass_children(const CompiledScene& scene, const std::vector<Ray>& rays, const std::vector<Hit>& hits,
                    bool reflect_outside, std::vector<Ray>& reflected, std::vector<Ray>& refracted) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto s = surface_at(scene, rays[i], hits[i]);
    if (!s) continue;
    const vec3 d = direction(rays[i]);
    const float eta = s->entering ? 1.5f : 1 / 1.5f;  // transmitting side over incident side
    const float cos_i = -glm::dot(d, s->n), sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (!s->entering || reflect_outside)
      reflected.push_back(make_ray(s->p + s->offset * s->n, glm::normalize(d + 2 * cos_i * s->n), endless));
    if (sin2_t < 1)
      refracted.push_back(make_ray(s->p - s->offset * s->n,
                                   glm::normalize(d / eta + (cos_i / eta - std::sqrt(1 - sin2_t)) * s->n),
                                   endless));
  }
}

RaySet glass_rays(const CompiledScene& scene, std::vector<Ray> rays, std::vector<Hit> hits,
                  const TraceFunction& trace) {
  constexpr int surfaces = 5;
  RaySet set{.kind = "glass"};
  for (int surface = 1; surface <= surfaces; ++surface) {
    std::vector<Ray> reflected, refracted;
    glass_children(scene, rays, hits, false, reflected, refracted);
    rays = std::move(refracted);
    rays.insert(rays.end(), reflected.begin(), reflected.end());
    if (rays.empty()) break;
    set.rays.insert(set.rays.end(), rays.begin(), rays.end());
    if (surface < surfaces) hits = trace(rays);
  }
  return set;
}

void shuffle(std::vector<Ray>& rays) {
  for (std::size_t i = rays.size(); i-- > 1;)
    std::swap(rays[i], rays[random_word(static_cast<u32>(i) ^ 0x5bd1e995u) % (i + 1)]);
}

/// All kinds but primary.
std::vector<RaySet> secondary_rays(const CompiledScene& scene, const Viewpoint& view, const RaySet& primary,
                                   const TraceFunction& trace, bool glass) {
  const std::vector<Hit> hits = trace(primary.rays);
  RaySet shadow{.kind = "shadow", .any = true, .coherent = true}, bounce{.kind = "bounce"},
      shuffled{.kind = "shuffled"}, reflection{.kind = "reflection"};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto s = surface_at(scene, primary.rays[i], hits[i]);
    if (!s) continue;
    const vec3 p = s->p + s->offset * s->n, d = direction(primary.rays[i]);
    const float distance = glm::length(view.light - p);
    const vec3 wi = (view.light - p) / distance;
    if (glm::dot(wi, s->n) > 0) shadow.rays.push_back(make_ray(p, wi, distance));
    bounce.rays.push_back(make_ray(p, cosine_direction(s->n, static_cast<u32>(i)), endless));
    reflection.rays.push_back(make_ray(p, glm::normalize(d - 2 * glm::dot(d, s->n) * s->n), endless));
  }
  shuffled.rays = bounce.rays;
  shuffle(shuffled.rays);
  std::vector<RaySet> sets;
  for (RaySet* set : {&shadow, &bounce, &shuffled, &reflection}) sets.push_back(std::move(*set));
  if (glass) sets.push_back(glass_rays(scene, primary.rays, hits, trace));
  return sets;
}

}  // namespace

Viewpoint scene_viewpoint(const CompiledScene& scene) {
  const SceneInfo& info = scene.info;
  Viewpoint view;
  view.eye = xyz(info.camera_position);
  view.forward = xyz(info.camera_forward);
  view.right = glm::normalize(xyz(info.camera_dx));
  view.up = -glm::normalize(xyz(info.camera_dy));
  view.tangent = 0.5f * glm::length(xyz(info.camera_dy)) * static_cast<float>(info.height);
  const float radius = info.scene_center.w;
  view.light = view.eye + radius * (view.right + view.up);
  for (const Light& light : scene.lights)
    if (light.kind < LIGHT_KINDS && facts_of_kind(light.kind).placed) {
      view.light = xyz(light.position);
      break;
    }
  return view;
}

Viewpoint framing_viewpoint(const CompiledScene& scene, const vec3& from, const TraceFunction& trace) {
  constexpr float wanted = 0.65f;
  const vec3 center = xyz(scene.info.scene_center), away = glm::normalize(from);
  const float size = 2 * scene.info.scene_center.w;
  Viewpoint view;
  view.forward = -away;
  view.right =
      glm::normalize(glm::cross(view.forward, std::abs(away.y) < 0.99f ? vec3(0, 1, 0) : vec3(0, 0, 1)));
  view.up = glm::cross(view.right, view.forward);
  view.eye = center + 1.4f * size * away;
  view.light = center + 2 * size * glm::normalize(0.9f * view.right + 0.9f * view.up + 0.8f * away);
  const auto share = [&](float tangent) {
    view.tangent = tangent;
    const std::vector<Hit> hits = trace(primary_rays(view, 256).rays);
    const auto met =
        std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.instance != NO_INSTANCE; });
    return static_cast<float>(met) / static_cast<float>(hits.size());
  };
  // Starts with the widest view, as the middle may be empty, and takes the first view that is filled enough,
  // or the fullest.
  constexpr float widest = 0.6f, narrowest = 0.01f, step = 0.9f;
  float best = 0, narrow = widest, wide = widest;
  for (float tangent = widest; tangent > narrowest && best < wanted; tangent *= step) {
    const float met = share(tangent);
    if (met > best) best = met, narrow = tangent, wide = std::min(tangent / step, widest);
  }
  for (int i = 0; best >= wanted && i < 12; ++i) {
    const float middle = 0.5f * (narrow + wide);
    (share(middle) > wanted ? narrow : wide) = middle;
  }
  view.tangent = narrow;
  return view;
}

RaySet primary_rays(const Viewpoint& view, unsigned size) {
  const unsigned tiles = (size + tile - 1) / tile, width = tiles * tile;
  RaySet set{.kind = "primary", .coherent = true};
  set.rays.reserve(std::size_t(width) * width);
  const unsigned blocks = tile / block;
  for (unsigned i = 0; i < width * width; ++i) {  // pixels in a block, in a tile, in the image
    const unsigned pixel = i % (block * block), in_tile = i / (block * block) % (blocks * blocks),
                   of_image = i / (tile * tile);
    const unsigned x = of_image % tiles * tile + in_tile % blocks * block + pixel % block;
    const unsigned y = of_image / tiles * tile + in_tile / blocks * block + pixel / block;
    const auto place = [&](unsigned at) {
      return ((static_cast<float>(at) + 0.5f) / static_cast<float>(width) * 2 - 1) * view.tangent;
    };
    const vec3 d = view.forward + place(x) * view.right - place(y) * view.up;
    set.rays.push_back(make_ray(view.eye, glm::normalize(d), endless));
  }
  return set;
}

std::vector<RaySet> frame_rays(const CompiledScene& scene, const Viewpoint& view, unsigned size,
                               const TraceFunction& trace, const std::vector<std::string>& kinds) {
  const auto wanted = [&](const std::string& kind) {
    return kinds.empty() || std::ranges::count(kinds, kind) > 0;
  };
  std::vector<RaySet> sets;
  sets.push_back(primary_rays(view, size));
  if (std::any_of(ray_kinds.begin() + 1, ray_kinds.end(), wanted))
    for (RaySet& set : secondary_rays(scene, view, sets[0], trace, wanted("glass")))
      sets.push_back(std::move(set));
  std::erase_if(sets, [&](const RaySet& set) { return set.rays.empty() || !wanted(set.kind); });
  return sets;
}

}  // namespace sundog
