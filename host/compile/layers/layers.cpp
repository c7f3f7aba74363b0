// See layers.h. The lobes are those of kernels/lib/shade/layer_lobes.cl.
#include "compile/layers/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compile/layers/albedos.h"
#include "compile/layers/facets.h"
#include "compile/layers/film.h"
#include "scene/pack.h"

namespace sundog {
namespace {

/// The index that reflects `weight` times what `index` does, straight on.
double weighted_index(double index, double weight) {
  const double root = (index - 1) / (index + 1);
  const double wanted = std::min(weight * root * root, 0.999);
  const double signed_root = std::copysign(std::sqrt(wanted), root);
  return (1 + signed_root) / (1 - signed_root);
}

/// A coat's facets bend the view of the base's: it is as rough as both together.
double roughened(const OpenPbr& v) {
  const double both =
      std::pow(std::min(1.0, std::pow(v.specular_roughness, 4) + 2 * std::pow(v.coat_roughness, 4)), 0.25);
  return std::lerp(v.specular_roughness, both, v.coat_weight);
}

/// What a coat's inside sends back of the light from a base (OpenPBR 1.1, "Coat", "Darkening"): of one
/// without roughness what it sends back straight on, of a rough one as of a matte one.
double inner_reflectance(double eta, double roughness) {
  constexpr int steps = 256;
  const Interface outer{eta, 0, {}};
  double outside = 0;  // what it reflects of light from all around
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    outside += 2 * cosine * interface_reflects(cosine, outer) / steps;
  }
  return std::lerp(interface_reflects(1, outer), 1 - (1 - outside) / (eta * eta), roughness);
}

double greatest(const dvec3& color) { return std::max({color.x, color.y, color.z}); }

/// The rows of a film; empty without one.
struct FilmColors {
  std::array<dvec3, LAYER_STEPS> glass{}, metal{};
};

FilmColors film_colors(const OpenPbr& v, double above, double index) {
  FilmColors colors;
  if (v.thin_film_weight == 0) return colors;
  const ThinFilm film{above, v.thin_film_ior, above * index, v.thin_film_thickness * 1000};
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    const double cosine = std::max(double(i) / (LAYER_STEPS - 1), 1e-3);
    colors.glass[i] = film_color(film, cosine, dvec3(0));
    colors.metal[i] = film_color(film, cosine, glm::max(v.base_weight * v.base_color, dvec3(1e-4)));
  }
  return colors;
}

}  // namespace

Layers make_layers(const OpenPbr& v, std::vector<float>& rows) {
  Layers to{};
  const FacetWidths widths = facet_widths(roughened(v), v.specular_roughness_anisotropy);
  const double least = LEAST_LAYER_ALPHA, above = 1 + v.coat_weight * (v.coat_ior - 1);
  const double index = weighted_index(v.specular_ior / above, v.specular_weight),
               turn = glm::radians(v.geometry_tangent);
  to.alpha_x = float(std::max(widths.x, least)), to.alpha_y = float(std::max(widths.y, least));
  to.eta = float(index < 1 ? 1 / index : index);
  to.film = float(v.thin_film_weight);
  to.coat_alpha = float(std::max(v.coat_roughness * v.coat_roughness, least)),
  to.coat_eta = float(v.coat_ior);
  to.fuzz_alpha = float(std::max(v.fuzz_roughness * v.fuzz_roughness, 0.01));
  to.metal = float(std::min(v.specular_weight, 1.0));
  to.matte_roughness = float(v.base_diffuse_roughness);
  to.glass = float(v.transmission_weight);
  to.turn_x = float(std::cos(turn)), to.turn_y = float(std::sin(turn));
  to.first = u32(rows.size());
  const FilmColors film = film_colors(v, above, index);
  AlbedoRow film_row{};
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) film_row[i] = greatest(film.glass[i]);
  const FacetWidths base_widths{to.alpha_x, to.alpha_y}, coat_widths{to.coat_alpha, to.coat_alpha};
  const FacetGains gains = facet_gains(base_widths);
  const FacetAlbedo shine = facet_albedo(base_widths, gains, {to.eta, v.thin_film_weight, film_row});
  FacetAlbedo coat{};
  if (v.coat_weight > 0) coat = facet_albedo(coat_widths, facet_gains(coat_widths), {v.coat_ior, 0, {}});
  const AlbedoRow fuzz = v.fuzz_weight > 0 ? fuzz_albedo(to.fuzz_alpha) : AlbedoRow{};
  const double fuzz_weight = v.fuzz_weight / std::max(1.0, *std::ranges::max_element(fuzz));
  AlbedoRow past_fuzz, past_coat, past_shine, past_all;
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    past_fuzz[i] = 1 - fuzz_weight * fuzz[i];
    past_coat[i] = 1 - v.coat_weight * std::min(coat.of_interface[i], 1.0);
    past_shine[i] = 1 - std::min(greatest(v.specular_color) * shine.of_interface[i], 1.0);
    past_all[i] = past_fuzz[i] * past_coat[i] * past_shine[i];
  }
  const double straight = std::min(shine.of_interface.back(), 1.0);
  const double of_glass = std::lerp(1.0, v.specular_roughness, straight);
  to.straight = float(straight);
  to.darkening = float(v.coat_weight * v.coat_darkening);
  to.inner =
      float(inner_reflectance(v.coat_ior, std::lerp(of_glass, v.specular_roughness, v.base_metalness)));
  to.shine_scale = float(shine.scale);
  to.matte_scale = float(1 / matte_albedo(v.base_diffuse_roughness, past_all));
  to.matte_scale_bare = float(1 / matte_albedo(v.base_diffuse_roughness, past_shine));
  to.specular = pack(v.specular_color, v.base_metalness);
  to.coat = pack(v.coat_color, v.coat_weight);
  to.fuzz = pack(v.fuzz_color, fuzz_weight);
  for (const AlbedoRow* row : {&past_fuzz, &past_coat, &past_shine})
    rows.insert(rows.end(), row->begin(), row->end());
  for (const auto* colors : {&film.glass, &film.metal})
    for (int channel = 0; channel < 3; ++channel)
      for (const dvec3& color : *colors) rows.push_back(float(color[channel]));
  for (const AlbedoRow& row : gains) rows.insert(rows.end(), row.begin(), row.end());
  return to;
}

void add_layers(const SceneDescription& scene, CompiledScene& out) {
  if (std::ranges::none_of(scene.materials,
                           [](const MaterialDescription& m) { return m.layers.has_value(); }))
    return;
  std::vector<float> rows;
  std::vector<Layers> layers;
  for (const MaterialDescription& material : scene.materials) {
    layers.push_back(material.layers ? make_layers(*material.layers, rows) : Layers{});
    if (!material.layers) continue;
    out.features.layers = true;
    if (material.layers->specular_roughness_anisotropy > 0) out.features.surface_coordinates = true;
  }
  layers.push_back({});  // of things without a material
  out.layers = std::move(layers);
  out.layer_rows = std::move(rows);
}

}  // namespace sundog
