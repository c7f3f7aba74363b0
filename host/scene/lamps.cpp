// See lamps.h.
#include "scene/lamps.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/kinds.h"

namespace sundog {
namespace {

/// The rotation and place of something whose axis is +y and whose middle is its origin.
dmat4 placed_along(const LampAxes& axes, const dvec3& middle) {
  return {glm::dvec4(glm::normalize(axes.u), 0), glm::dvec4(axes.normal, 0),
          glm::dvec4(-glm::normalize(axes.v), 0), glm::dvec4(middle, 1)};
}

Mesh rectangle_mesh(const dvec2& size) {
  const float x = static_cast<float>(size.x / 2), z = static_cast<float>(size.y / 2);
  Mesh mesh;
  mesh.positions = {{-x, 0, -z}, {-x, 0, z}, {x, 0, z}, {x, 0, -z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.source_vertex_count = 4;
  return mesh;
}

Shape lamp_shape(const LightDescription& light, SceneDescription& scene) {
  if (light.type == LightType::sphere) return SphereShape{light.radius};
  if (light.type == LightType::disk) return DiskShape{light.radius, 0};
  scene.meshes.push_back(rectangle_mesh(light.size));
  scene.meshes.back().name = "lamp";
  return MeshShape{static_cast<int>(scene.meshes.size()) - 1};
}

}  // namespace

LampAxes lamp_axes(const LightDescription& light) {
  LampAxes axes;
  axes.normal = glm::normalize(light.direction);
  dvec3 side = glm::cross(light.up, axes.normal);
  // An "up" along the light's direction says nothing: then z, and for a light along that x.
  if (glm::length(side) < 1e-6 * glm::length(light.up)) side = glm::cross(dvec3(0, 0, 1), axes.normal);
  if (glm::length(side) < 1e-6) side = glm::cross(dvec3(1, 0, 0), axes.normal);
  side = glm::normalize(side);
  const bool round = light.type == LightType::disk;
  axes.u = side * (round ? light.radius : light.size.x);
  axes.v = glm::cross(axes.normal, side) * (round ? light.radius : light.size.y);
  return axes;
}

void add_lamps(SceneDescription& scene) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const LightDescription& light = scene.lights[i];
    if (!facts_of(light.type).extent || !light.visible) continue;
    MaterialDescription material;
    material.name = "lamp";
    material.ambient = material.diffuse = dvec3(0);
    material.emission = light.color * light.intensity;
    material.shadow_opaque = true;
    const Shape shape = lamp_shape(light, scene);
    const bool aimed = facts_of(light.type).aimed;
    const dmat4 place = aimed ? placed_along(lamp_axes(light), light.position)
                              : dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0),
                                      glm::dvec4(light.position, 1));
    scene.materials.push_back(material);
    scene.objects.push_back({"lamp", shape, static_cast<int>(scene.materials.size()) - 1, place,
                             fmt::format("/lights/{}", i), static_cast<int>(i)});
  }
}

}  // namespace sundog
