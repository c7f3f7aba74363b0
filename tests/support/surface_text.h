// Text for tests' kernels: the surface of one material without textures.
#pragma once
#include <string>

/// Defines Bsdfs make_surface(materials, n, before, after): the first material, with normal n, between two
/// media.
inline const std::string surface_text = R"(
#include "lib/shade/bsdf.cl"
#include "plain/shade/lobes.cl"
Bsdfs make_surface(__global const Material* materials, REAL3 n, int before, int after) {
  const REAL3 none = real3(0.0f, 0.0f, 0.0f);
  Bsdfs bsdf = {n, n, none, all3(materials[0].diffuse.xyz), 0, (int)materials[0].flags, before, after};
#if HAS_MAPS
  bsdf.specular = all3(materials[0].specular.xyz);
  bsdf.reflection = all3(materials[0].reflection.xyz);
  bsdf.transmission = all3(materials[0].transmission.xyz);
  bsdf.emission = none;
  bsdf.exponent = (REAL)(materials[0].specular.w);
#endif
#if HAS_OPACITY
  bsdf.there = (REAL)(1.0f);
#endif
  return bsdf;
}
)";
