// Checks rays in parallel; where the tracers differ, traces the ray and copies moved by the rounding error in
// double precision, and accepts an answer within their range.
#include "bench/rays/check_hits.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "bench/plain/tracer.h"
#include "bench/rays/exact_tracer.h"

namespace sundog {
namespace {

using glm::dvec3;

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double relative = 1e-4;     // of the distance: the precision that solids of high degree lose
constexpr double rounding = 0x1p-20;  // of the greatest coordinate: the error of a few float operations
constexpr std::size_t enough = 1000;  // wrong answers

HostRay host_ray(const Ray& ray) {
  return {dvec3(ray.ox, ray.oy, ray.oz), dvec3(ray.dx, ray.dy, ray.dz), double(ray.t_min), double(ray.t_max)};
}

double greatest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The size of the hit primitive in the instance's space: 1 for a solid, or the triangle's extent.
double size_met(const CompiledScene& scene, u32 instance, u32 prim) {
  if (scene.instances[instance].shape != SHAPE_MESH) return 1;
  return prim < scene.triangles.size() ? double(scene.triangles[prim].extent) : 0;
}

/// How far rounding may move the ray near `t`, in world units, from the size of the coordinates there in
/// world space and in the space of the hit instance.
double reach(const CompiledScene& scene, const HostRay& ray, double t, u32 instance, u32 prim) {
  const auto greater = [&](const HostRay& r) {
    return std::max(greatest(r.origin), greatest(r.origin + t * r.direction));
  };
  double result = greater(ray);
  if (instance != NO_INSTANCE) {
    const HostRay inside = object_ray(scene.instances[instance], ray);
    const double scale = glm::length(inside.direction) / glm::length(ray.direction);
    result = std::max(result, (greater(inside) + size_met(scene, instance, prim)) / scale);
  }
  return rounding * result;
}

/// reach() of a ray that hits nothing: at the end of the ray or of the scene.
double reach_of_none(const CompiledScene& scene, const HostRay& ray) {
  const float4& ball = scene.info.scene_center;
  const double length = glm::length(ray.direction);
  const double beyond = glm::length(dvec3(ball.x, ball.y, ball.z) - ray.origin) + double(ball.w);
  return reach(scene, ray, std::min(ray.t_max, beyond / length), NO_INSTANCE, 0);
}

/// A ray moved by rounding.
struct Copy {
  HostRay ray;
  double ahead;  // how far its origin is ahead, in the ray's unit of t
};

std::vector<Copy> moved_copies(const HostRay& ray, double distance) {
  const double length = glm::length(ray.direction);
  const dvec3 along = ray.direction / length;
  const dvec3 across =
      glm::normalize(glm::cross(along, std::abs(along.x) > 0.5 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
  const dvec3 up = glm::cross(along, across);
  std::vector<Copy> copies{{ray, 0}};
  for (const double ahead : {-1.0, 0.0, 1.0})
    for (int i = 0; i < 8; ++i) {
      const double angle = 0.25 * std::numbers::pi * i;
      HostRay copy = ray;
      copy.origin += distance * (std::cos(angle) * across + std::sin(angle) * up + ahead * along);
      copies.push_back({copy, ahead * distance / length});
    }
  return copies;
}

/// Hits of a ray and its moved copies in double precision. `found`: the checked tracer's distance; infinite
/// for none.
struct Findings {
  std::vector<Copy> copies;
  double nearest = unlimited, farthest = 0;
  double last = 0;   // the farthest hit
  double slack = 0;  // along the ray

  Findings(const CompiledScene& scene, const HostRay& ray, double found, u32 instance, u32 prim) {
    const std::optional<HostHit> hit = trace_host(scene, ray);
    double distance =
        std::isfinite(found) ? reach(scene, ray, found, instance, prim) : reach_of_none(scene, ray);
    if (hit) distance = std::max(distance, reach(scene, ray, hit->t, hit->instance, hit->prim));
    slack = distance / glm::length(ray.direction);
    copies = moved_copies(ray, distance);
    for (const Copy& copy : copies) {
      const std::optional<HostHit> other = trace_host(scene, copy.ray);
      const double t = other ? std::max(0.0, other->t + copy.ahead) : unlimited;
      nearest = std::min(nearest, t), farthest = std::max(farthest, t);
      if (other) last = std::max(last, t);
    }
  }

  double room(double t) const { return slack + (std::isfinite(t) ? relative * t : 0); }
  bool hold(double t) const { return t >= nearest - room(nearest) && t <= farthest + room(farthest); }

  /// Whether one of the copies meets the instance near `t`.
  bool meet(const CompiledScene& scene, u32 instance, double t) const {
    const double about = 2 * room(t) + std::max(0.0, last - nearest);
    return std::any_of(copies.begin(), copies.end(), [&](const Copy& copy) {
      HostRay ray = copy.ray;
      ray.t_min = t - about, ray.t_max = t + about;
      return trace_instance(scene, instance, ray).has_value();
    });
  }
};

plain::Ray plain_ray(const Ray& ray) {
  return {{ray.ox, ray.oy, ray.oz}, {ray.dx, ray.dy, ray.dz}, ray.t_min, ray.t_max};
}

/// Whether the answer is the plain tracer's.
bool agrees(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  plain::Hit found;
  if (!plain::closest_hit(scene, plain_ray(ray), found)) return hit.instance == NO_INSTANCE;
  return hit.instance == found.instance &&
         std::abs(hit.t - found.t) <= static_cast<float>(relative) * std::abs(found.t);
}

bool agrees(const CompiledScene& scene, const Ray& ray, bool occluded) {
  return occluded == plain::any_hit(scene, plain_ray(ray));
}

/// Counts one answer. `judge`: check it in double precision if it is not the plain tracer's.
template <class Answer>
void count(const CompiledScene& scene, const Ray& ray, const Answer& answer, bool judge, HitCheck& sum) {
  ++sum.checked;
  if (!agrees(scene, ray, answer)) ++(judge && is_right(scene, ray, answer) ? sum.rounded : sum.differ);
}

}  // namespace

bool is_right(const CompiledScene& scene, const Ray& ray, const Hit& hit) {
  const bool met = hit.instance != NO_INSTANCE;
  if (met && (hit.instance >= scene.info.instance_count || !std::isfinite(hit.t))) return false;
  const double t = met ? double(hit.t) : unlimited;
  const Findings findings(scene, host_ray(ray), t, hit.instance, hit.prim);
  return findings.hold(t) && (!met || findings.meet(scene, hit.instance, t));
}

bool is_right(const CompiledScene& scene, const Ray& ray, bool occluded) {
  const Findings findings(scene, host_ray(ray), unlimited, NO_INSTANCE, 0);
  return occluded ? std::isfinite(findings.nearest) : !std::isfinite(findings.farthest);
}

HitCheck check_hits(const CompiledScene& scene, const RaySet& set, const Answers& answers) {
  tbb::enumerable_thread_specific<HitCheck> parts;
  std::atomic<std::size_t> wrong{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, set.rays.size(), 1024), [&](const auto& range) {
    HitCheck& part = parts.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::size_t before = part.differ;
      if (set.any) {
        part.hits += answers.occluded[i] != 0;
        count(scene, set.rays[i], answers.occluded[i] != 0, wrong < enough, part);
      } else {
        part.hits += answers.hits[i].instance != NO_INSTANCE;
        count(scene, set.rays[i], answers.hits[i], wrong < enough, part);
      }
      wrong += part.differ - before;
    }
  });
  HitCheck sum;
  for (const HitCheck& part : parts)
    sum.hits += part.hits, sum.checked += part.checked, sum.rounded += part.rounded,
        sum.differ += part.differ;
  return sum;
}

}  // namespace sundog
