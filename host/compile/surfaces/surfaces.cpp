// Compiles surfaces: materials, media, textures and layers.
#include <algorithm>
#include <cmath>

#include "compile/layers/layers.h"
#include "compile/steps.h"
#include "compile/surfaces/materials.h"
#include "compile/surfaces/textures.h"
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

/// Uses the test of highlight() in kernels/plain/shade/lobes/highlight.cl.
bool has_fractional_exponent(const Material& material) {
  const float exponent = material.specular.w;
  return exponent != std::floor(exponent) || exponent > GREATEST_WHOLE_EXPONENT;
}

}  // namespace

bool fog_scatters(const SceneDescription& scene) {
  return integrator_of(scene.render.integrator).scatters && scene.fog.anisotropy && scene.fog.density > 0;
}

SurfaceInputs surface_inputs(const SceneDescription& scene) {
  return {.file = file_of(scene),
          .paths = integrator_of(scene.render.integrator).own_materials,
          .caustics = scene.render.caustics,
          .lacks_materials = lacks_materials(scene),
          .media = scene.media,
          .materials = scene.materials,
          .images = scene.images,
          .textures = scene.textures,
          .fog = fog_scatters(scene) ? &scene.fog : nullptr};
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
