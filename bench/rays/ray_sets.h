// The rays of a frame by kind, to time a tracer without shading: from the camera, to a point light, from a
// diffuse bounce and through glass. Every machine gets the same rays: random numbers are a hash of the pixel.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

/// Rays in a renderer's order, one block of 4x4 pixels after the other, so 16 successive rays belong
/// together.
struct RaySet {
  std::string kind;
  bool any = false;       // only whether there is a hit matters
  bool coherent = false;  // 16 successive rays run close together
  std::vector<Ray> rays = {};
};

/// Finds the nearest hits of rays, from which secondary rays start.
using TraceFunction = std::function<std::vector<Hit>(std::span<const Ray>)>;

/// A pinhole camera and a point light.
struct Viewpoint {
  glm::vec3 eye{0}, forward{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};  // unit vectors
  float tangent = 0.5f;                                              // of half the angle of view
  glm::vec3 light{0};
};

/// The scene's own camera, and its first point or spot light (else one beside the camera).
Viewpoint scene_viewpoint(const CompiledScene& scene);

/// A view along -`from` in which 65 % of the rays hit the scene, or as many as possible, with a light at the
/// upper right.
Viewpoint framing_viewpoint(const CompiledScene& scene, const glm::vec3& from, const TraceFunction& trace);

/// size x size pixels (rounded up to a multiple of 16), through their centres.
RaySet primary_rays(const Viewpoint& view, unsigned size);

/// All kinds of rays, in the order of frame_rays().
///   primary     the camera's
///   shadow      from the point towards the light, where the light is in front of the surface
///   bounce      cosine-weighted about the normal (towards the camera)
///   shuffled    the bounce rays in random order
///   reflection  the mirrored camera rays
///   glass       the rays inside and behind a solid of index 1.5: refracted, then refracted and reflected at
///               each further surface, up to 5 surfaces along a path
inline const std::vector<std::string> ray_kinds = {"primary",  "shadow",     "bounce",
                                                   "shuffled", "reflection", "glass"};

/// The camera rays of size x size pixels (see primary_rays()) and the rays that follow from their hits: a set
/// for each of `kinds`, or for all kinds if empty. Kinds without rays have no set.
std::vector<RaySet> frame_rays(const CompiledScene& scene, const Viewpoint& view, unsigned size,
                               const TraceFunction& trace, const std::vector<std::string>& kinds);

}  // namespace sundog
