// A slow tracer of the compiled tables in double precision, the reference for the kernels and the BVH.
#pragma once
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

struct HostRay {
  glm::dvec3 origin, direction;
  double t_min = 0, t_max = std::numeric_limits<double>::infinity();
};

struct HostHit {
  double t = 0, u = 0, v = 0;  // u, v: barycentric, of triangles only
  u32 prim = 0;                // TriangleShading index; 0 for solids
  u32 instance = 0;
  glm::dvec3 ng{0};  // object space, outward, not normalised
};

/// Nearest hit with t in (t_min, t_max), through the two-level BVH.
std::optional<HostHit> trace_host(const CompiledScene& scene, const HostRay& ray);

/// Every crossing of one instance's surface, nearest first, t in (t_min, t_max).
std::vector<HostHit> crossings(const CompiledScene& scene, u32 instance, const HostRay& ray);

/// The nearest crossing of one instance's surface, through its BVH.
std::optional<HostHit> trace_instance(const CompiledScene& scene, u32 instance, const HostRay& ray);

/// The ray in an instance's object space (t unchanged).
HostRay object_ray(const Instance& instance, const HostRay& ray);

}  // namespace sundog
