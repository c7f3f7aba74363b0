// Layered materials as tests have them: white ones for the furnace, one with all lobes for all else.
#pragma once
#include "lobe_testing.h"
#include "scene/description.h"

namespace sundog::lobes {

/// The material of `values` as the kernels have it, of the index of refraction `index` where light goes
/// through.
struct Layered {
  Material material{};
  double index = 1;
};

inline Layered layered(const OpenPbr& values) {
  MaterialDescription description;
  MediumDescription inside;
  Layered to;
  const bool through = set_openpbr(values, description, inside);
  to.material.flags = MATERIAL_LAYERED | MATERIAL_REFLECTS | (through ? MATERIAL_TRANSMITS : MATERIAL_THIN);
  to.material.kind = through ? MATERIAL_DIELECTRIC : MATERIAL_PHONG;
  if (description.wall_ior > 0) {
    to.material.flags |= MATERIAL_TRANSMITS | MATERIAL_WALL | MATERIAL_FROSTED;
    to.material.kind = MATERIAL_DIELECTRIC;
  }
  const auto packed = [](const dvec3& c, double w) {
    return float4{float(c.x), float(c.y), float(c.z), float(w)};
  };
  to.material.diffuse = packed(description.diffuse, 0);
  to.material.reflection =
      packed(description.reflection, values.specular_roughness * values.specular_roughness);
  to.material.transmission = packed(description.transmission, description.wall_ior);
  if (through) to.index = inside.ior;
  return to;
}

/// White materials, each with another lobe on top.
struct Named {
  const char* name;
  OpenPbr values;
  double least = 0.9;  // of the light that it returns
};

inline std::vector<Named> white_materials(double roughness) {
  const dvec3 white(1);
  OpenPbr metal{.base_color = white, .base_metalness = 1, .specular_roughness = roughness};
  OpenPbr brushed = metal, half = metal, plastic{.base_color = white, .specular_roughness = roughness};
  brushed.specular_roughness_anisotropy = 0.8;
  half.base_metalness = 0.5;
  OpenPbr clay = plastic, painted = plastic, lacquered = metal, grooved = metal, velvet = plastic,
          film = plastic, all = plastic;
  clay.base_diffuse_roughness = 1;
  painted.coat_weight = lacquered.coat_weight = 1;
  painted.coat_roughness = roughness, lacquered.coat_roughness = 0.3;
  grooved.coat_weight = 1, grooved.coat_roughness = roughness;
  grooved.coat_roughness_anisotropy = 0.8, grooved.coat_ior = 2.5;
  velvet.fuzz_weight = 1, velvet.fuzz_roughness = roughness;
  film.thin_film_weight = 1;
  all.coat_weight = all.fuzz_weight = all.thin_film_weight = 0.7;
  all.base_metalness = 0.4, all.coat_roughness = 0.2, all.specular_roughness_anisotropy = 0.5;
  return {{"metal", metal, 0.98},     {"half metal", half, 0.98}, {"brushed", brushed, 0.9},
          {"plastic", plastic, 0.98}, {"clay", clay, 0.9},        {"painted", painted, 0.95},
          {"lacquered", lacquered},   {"grooved", grooved, 0.77}, {"velvet", velvet, 0.9},
          {"film", film, 0.95},       {"all", all, 0.82}};
}

inline OpenPbr colored() {
  OpenPbr v{.base_diffuse_roughness = 0.6, .base_color = {0.8, 0.5, 0.2}, .base_metalness = 0.3};
  v.specular_roughness = 0.5, v.specular_roughness_anisotropy = 0.6;
  v.coat_weight = 0.8, v.coat_roughness = 0.4, v.coat_color = {0.9, 0.8, 0.6};
  v.fuzz_weight = 0.6, v.fuzz_roughness = 0.6;
  v.thin_film_weight = 0.5, v.thin_film_thickness = 0.35;
  return v;
}

/// The share of light that a surface returns, from its lobes in even directions.
inline double mean_value(const std::vector<Lobe>& field) {
  double sum = 0;
  for (const Lobe& one : field) sum += one.value.x;
  return sum * 4 / double(field.size());
}

}  // namespace sundog::lobes
