// Compiles shading data: lights with the environment, and surfaces.
#include <algorithm>
#include <cmath>

#include "compile/environment.h"
#include "compile/halo/halo_map.h"
#include "compile/layers/layers.h"
#include "compile/materials.h"
#include "compile/parts/steps.h"
#include "compile/textures.h"
#include "scene/pack.h"

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

Halo compile_halo(const HaloInputs& in) {
  const EnvironmentDescription& e = *in.environment;
  if (e.type != EnvironmentType::halo) return nullptr;
  return e.halo_map ? e.halo_map : std::make_shared<const HaloMap>(trace_halo(plan_halo(e)));
}

Lights compile_lights(const LightInputs& in) {
  Lights lights;
  add_lights(in, lights);
  add_environment(in, lights);
  lights.fog = pack(in.fog_color, in.fog_density);
  lights.features.fog = in.fog_density > 0;
  return lights;
}

Surfaces compile_surfaces(const SurfaceInputs& in) {
  Surfaces surfaces;
  SceneFeatures& features = surfaces.features;
  surfaces.default_material = add_materials(in, surfaces);
  add_textures(in, surfaces);
  add_layers(in, surfaces);
  features.media = absorbs(surfaces.media[0]);
  features.absorption = std::ranges::any_of(surfaces.media, absorbs);
  features.scattering = in.paths && std::ranges::any_of(surfaces.media, scatters);
  features.fractional_exponents = std::ranges::any_of(surfaces.materials, has_fractional_exponent);
  return surfaces;
}

}  // namespace sundog
