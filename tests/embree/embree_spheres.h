// The balls of a scene as Embree takes them.
#pragma once
#include <optional>
#include <vector>

#include "embree_query.h"
#include "scene/description.h"

namespace sundog {

/// A ball in world space: centre and radius.
struct Ball {
  glm::vec3 center{0};
  float radius = 0;
};

/// The object as a ball; nothing when it is another shape, or a sphere that its transform squeezes.
std::optional<Ball> as_ball(const Object& object);

/// A committed geometry, a primitive a ball; the caller releases it.
RTCGeometry embree_spheres(RTCDevice device, const std::vector<Ball>& balls);

}  // namespace sundog
