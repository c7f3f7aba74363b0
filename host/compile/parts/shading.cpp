// Compiles shading data: lights with the environment, and surfaces.
#include <algorithm>
#include <cmath>

#include "compile/environment.h"
#include "compile/halo/halo_map.h"
#include "compile/layers/layers.h"
#include "compile/materials.h"
#include "compile/parts/parts.h"
#include "compile/textures.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

bool absorbs(const Medium& medium) {
  const float4& a = medium.absorption;
  return a.x != 0 || a.y != 0 || a.z != 0;
}

bool scatters(const Medium& medium) {
  const float4& s = medium.scattering;
  return s.x != 0 || s.y != 0 || s.z != 0;
}

/// By the test of highlight() in kernels/plain/shade/lobes/highlight.cl.
bool has_fractional_exponent(const Material& material) {
  const float exponent = material.specular.w;
  return exponent != std::floor(exponent) || exponent > GREATEST_WHOLE_EXPONENT;
}

}  // namespace

ContentKey lights_key(const SceneDescription& scene, const dvec3& origin) {
  KeyMaker key;
  key.add(origin).add_all(scene.lights).add(scene.environment);
  return key.add(scene.fog.color).add(scene.fog.density).add(fog_scatters(scene)).key();
}

ContentKey halo_key(const SceneDescription& scene) {
  KeyMaker key;
  key.add(scene.environment.type);
  if (scene.environment.type == EnvironmentType::halo) key.add_halo(scene.environment);
  return key.key();
}

HaloPart make_halo(const SceneDescription& scene) {
  HaloPart part;
  const EnvironmentDescription& e = scene.environment;
  if (e.type == EnvironmentType::halo)
    part.map = e.halo_map ? e.halo_map : std::make_shared<const HaloMap>(trace_halo(plan_halo(e)));
  return part;
}

ScenePart make_lights(const SceneDescription& scene, const dvec3& origin, const HaloPart& halo) {
  ScenePart part;
  part.made.origin = origin;
  add_lights(scene, part.made);
  add_environment(scene, part.made, halo.map.get());
  add_fog(scene, part.made);
  return part;
}

ContentKey surfaces_key(const SceneDescription& scene) {
  KeyMaker key;
  key.add_all(scene.media).add_all(scene.images).add_all(scene.textures).add_all(scene.materials);
  if (fog_scatters(scene)) key.add(scene.fog.color).add(scene.fog.density).add(*scene.fog.anisotropy);
  key.add(scene.render.caustics);
  return key.add(lacks_materials(scene)).add(traces_paths(scene.render.integrator)).key();
}

SurfacesPart make_surfaces(const SceneDescription& scene) {
  SurfacesPart part;
  CompiledScene& made = part.made;
  part.default_material = add_materials(scene, made);
  add_textures(scene, made);
  add_layers(scene, made);
  made.features.media = absorbs(made.media[0]);
  made.features.absorption = std::ranges::any_of(made.media, absorbs);
  made.features.scattering =
      traces_paths(scene.render.integrator) && std::ranges::any_of(made.media, scatters);
  made.features.fractional_exponents = std::ranges::any_of(made.materials, has_fractional_exponent);
  return part;
}

}  // namespace sundog
