// Searches environment, lights, materials, fields, background and fog for light; the warning proposes a box
// filled with the world's medium.
#include "scene/dark_world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "scene/integrators.h"

namespace sundog {
namespace {

bool shines(const EnvironmentDescription& environment) {
  return environment.type != EnvironmentType::none && environment.intensity > 0 &&
         environment.color != dvec3(0);
}
bool shines(const LightDescription& light) { return light.intensity > 0 && light.color != dvec3(0); }
bool glows(const MaterialDescription& material) { return material.emission != dvec3(0); }

bool shines_from_afar(const SceneDescription& scene) {
  return shines(scene.environment) || std::ranges::any_of(scene.lights, [](const LightDescription& light) {
           return light.type == LightType::directional && shines(light);
         });
}

std::array<double, 3> numbers(const dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

bool has_light(const SceneDescription& scene) {
  return shines(scene.environment) ||
         std::ranges::any_of(scene.lights, [](const LightDescription& light) { return shines(light); }) ||
         std::ranges::any_of(scene.materials, glows) ||
         std::ranges::any_of(scene.fields, [](const SdfDescription& f) { return f.glow != dvec3(0); }) ||
         scene.image.background_bottom != dvec3(0) || scene.image.background_top != dvec3(0) ||
         (scene.fog.density > 0 && scene.fog.color != dvec3(0));
}

void warn_of_dark_world(SceneDescription& scene) {
  const MediumDescription& world = scene.media[0];
  const bool fog =
      integrator_of(scene.render.integrator).scatters && scene.fog.anisotropy && scene.fog.density > 0;
  const dvec3 scattering = world.scattering +
                           (fog ? scene.fog.density * glm::min(scene.fog.color, dvec3(1)) : dvec3(0)),
              taken = world.scattering + world.absorption + (fog ? dvec3(scene.fog.density) : dvec3(0));
  if (taken == dvec3(0) || !shines_from_afar(scene)) return;
  scene.warnings.push_back(fmt::format(
      "{}: no light of a sun, a sky or a directional light gets through what has no end; put the scene into "
      "a box instead, of a medium with \"scattering\": [{:.4g}], \"absorption\": [{:.4g}]",
      fog ? "/world/fog" : "/world/medium", fmt::join(numbers(scattering), ", "),
      fmt::join(numbers(taken - scattering), ", ")));
}

}  // namespace sundog
