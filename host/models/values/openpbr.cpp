// Copies the values to material.layers, derives diffuse, reflection, transmission, emission and opacity, and
// the medium inside from colour and depth.
#include "models/values/openpbr.h"

#include <algorithm>
#include <cmath>

#include "models/values/material.h"

namespace sundog {

FacetWidths facet_widths(double roughness, double anisotropy) {
  const double alpha = roughness * roughness, across = 1 - anisotropy;
  const double along = std::min(alpha * std::sqrt(2 / (1 + across * across)), 1.0);
  return {along, across * along};
}

bool set_openpbr(const OpenPbr& values, MaterialDescription& material, MediumDescription& inside) {
  const double dielectric = material.textures.metalness >= 0 ? 1 : 1 - values.base_metalness,
               through = values.transmission_weight * dielectric;
  const bool in_depth = values.transmission_depth > 0 && !values.geometry_thin_walled;
  material.diffuse = values.base_weight * values.base_color;
  const double matte = material.textures.glass >= 0 ? 1 : 1 - values.transmission_weight;
  material.ambient = 0.1 * dielectric * matte * material.diffuse;
  material.specular = dvec3(0);
  material.reflection = through * values.specular_color;
  material.transmission = through * (in_depth ? dvec3(1) : values.transmission_color);
  material.roughness = values.specular_roughness;
  material.emission = values.emission_luminance * values.emission_color;
  material.opacity = values.geometry_opacity;
  material.layers = values;
  if (through == 0) return false;
  material.type = MaterialType::dielectric;
  material.wall_ior = values.geometry_thin_walled ? values.specular_ior : 0;
  if (values.geometry_thin_walled) return false;
  inside.name = material.name;
  inside.ior = values.specular_ior;
  if (values.transmission_dispersion_scale > 0) {
    const double abbe = values.transmission_dispersion_abbe_number / values.transmission_dispersion_scale;
    inside.dispersion = cauchy_of_abbe(values.specular_ior, std::max(abbe, 1.0));
  }
  if (in_depth) {
    const dvec3 lost =
        -glm::log(glm::max(values.transmission_color, dvec3(1e-6))) / values.transmission_depth + 0.0;
    inside.scattering = values.transmission_scatter / values.transmission_depth;
    inside.anisotropy = values.transmission_scatter_anisotropy;
    // If more of a colour is scattered than lost in total, all colours lose the excess.
    const dvec3 rest = lost - inside.scattering;
    inside.absorption = rest - std::min({rest.x, rest.y, rest.z, 0.0});
  }
  return true;
}

}  // namespace sundog
