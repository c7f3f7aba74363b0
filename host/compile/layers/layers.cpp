// See layers.h. The lobes are those of kernels/lib/shade/layer_lobes.cl.
#include "compile/layers/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compile/layers/albedos.h"
#include "compile/layers/base.h"
#include "compile/layers/film.h"
#include "scene/materials/by_integrator.h"
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

/// What the base has about it, and what coat and fuzz pass to it.
struct Above {
  BaseSurroundings around;
  AlbedoRow past_fuzz, past_coat;
  FacetGains coat_gains;  // where there is a coat
  double fuzz_weight;
};

Above layers_above(const OpenPbr& v, const Layers& to, const FilmColors& film) {
  const FacetWidths coat_widths{to.coat_alpha, to.coat_alpha_y};
  Above above;
  FacetAlbedo coat{};
  if (v.coat_weight > 0) {
    above.coat_gains = facet_gains(coat_widths);
    coat = facet_albedo(coat_widths, above.coat_gains, {v.coat_ior, 0, {}});
  }
  const AlbedoRow fuzz = v.fuzz_weight > 0 ? fuzz_albedo(to.fuzz_alpha) : AlbedoRow{};
  above.fuzz_weight = v.fuzz_weight / std::max(1.0, *std::ranges::max_element(fuzz));
  above.around.interface = {to.eta, v.thin_film_weight, {}};
  above.around.tint = greatest(v.specular_color);
  above.around.matte_roughness = v.base_diffuse_roughness;
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    above.around.interface.film_row[i] = greatest(film.glass[i]);
    above.past_fuzz[i] = 1 - above.fuzz_weight * fuzz[i];
    above.past_coat[i] = 1 - v.coat_weight * std::min(coat.of_interface[i], 1.0);
    above.around.above[i] = above.past_fuzz[i] * above.past_coat[i];
  }
  return above;
}

void set_numbers(const OpenPbr& v, double above, Layers& to) {
  const double index = weighted_index(v.specular_ior / above, v.specular_weight),
               turn = glm::radians(v.geometry_tangent);
  const FacetWidths widths = wide_enough(facet_widths(roughened(v), v.specular_roughness_anisotropy)),
                    stretched = facet_widths(std::sqrt(0.5), v.specular_roughness_anisotropy);
  to.alpha_x = float(widths.x), to.alpha_y = float(widths.y);
  to.eta = float(index < 1 ? 1 / index : index);
  to.film = float(v.thin_film_weight);
  const FacetWidths coat = wide_enough(facet_widths(v.coat_roughness, v.coat_roughness_anisotropy));
  to.coat_alpha = float(coat.x), to.coat_alpha_y = float(coat.y);
  to.coat_eta = float(v.coat_ior);
  to.fuzz_alpha = float(std::max(v.fuzz_roughness * v.fuzz_roughness, 0.01));
  to.metal = float(std::min(v.specular_weight, 1.0));
  to.matte_roughness = float(v.base_diffuse_roughness);
  to.glass = float(v.transmission_weight);
  to.turn_x = float(std::cos(turn)), to.turn_y = float(std::sin(turn));
  to.darkening = float(v.coat_weight * v.coat_darkening);
  to.inner_smooth = float(inner_reflectance(v.coat_ior, 0));
  to.inner_matte = float(inner_reflectance(v.coat_ior, 1));
  to.roughness = float(v.specular_roughness);
  to.haze = float(2 * std::pow(v.coat_roughness, 4));
  to.stretch = float(2 * stretched.x);
  to.narrowed = float(1 - v.specular_roughness_anisotropy);
}

}  // namespace

Layers make_layers(const OpenPbr& v, const MaterialTextures& textures, LayerRows& rows) {
  Layers to{};
  const double index_above = 1 + v.coat_weight * (v.coat_ior - 1);
  set_numbers(v, index_above, to);
  const FilmColors film =
      film_colors(v, index_above, weighted_index(v.specular_ior / index_above, v.specular_weight));
  const Above above = layers_above(v, to, film);
  const FacetWidths widths{to.alpha_x, to.alpha_y};
  const FacetGains gains = facet_gains(widths);
  const BaseInterface base = base_interface(widths, gains, above.around);
  const double of_glass = std::lerp(1.0, v.specular_roughness, base.straight);
  to.straight = float(base.straight);
  to.inner =
      float(inner_reflectance(v.coat_ior, std::lerp(of_glass, v.specular_roughness, v.base_metalness)));
  to.shine_scale = float(base.shine_scale);
  to.matte_scale = float(base.matte_scale);
  to.matte_scale_bare = float(base.matte_scale_bare);
  to.specular = pack(v.specular_color, v.base_metalness);
  to.coat = pack(v.coat_color, v.coat_weight);
  to.fuzz = pack(v.fuzz_color, above.fuzz_weight);
  to.first = u32(rows.values.size());
  for (const AlbedoRow* row : {&above.past_fuzz, &above.past_coat, &base.past})
    rows.values.insert(rows.values.end(), row->begin(), row->end());
  for (const auto* colors : {&film.glass, &film.metal})
    for (int channel = 0; channel < 3; ++channel)
      for (const dvec3& color : *colors) rows.values.push_back(float(color[channel]));
  for (const AlbedoRow& row : gains) rows.values.insert(rows.values.end(), row.begin(), row.end());
  to.coat_gains = NO_LAYER_GAINS;
  if (v.coat_weight > 0 && to.coat_alpha != to.coat_alpha_y) {
    to.coat_gains = u32(rows.values.size());
    for (const AlbedoRow& row : above.coat_gains)
      rows.values.insert(rows.values.end(), row.begin(), row.end());
  }
  to.grid = NO_LAYER_GRID;
  if (textures.roughness >= 0) to.grid = add_layer_grid(v.specular_roughness_anisotropy, above.around, rows);
  return to;
}

void add_layers(const SceneDescription& scene, CompiledScene& out) {
  if (std::ranges::none_of(scene.materials, [&](const MaterialDescription& m) {
        return surface_for(scene, m).layers.has_value();
      }))
    return;
  LayerRows rows;
  std::vector<Layers> layers;
  for (const MaterialDescription& any : scene.materials) {
    const MaterialDescription& material = surface_for(scene, any);
    const MaterialTextures& textures = material.textures;
    layers.push_back(material.layers ? make_layers(*material.layers, textures, rows) : Layers{});
    if (!material.layers) continue;
    out.features.layers = true;
    out.features.layer_maps |= std::max({textures.metalness, textures.roughness, textures.glass}) >= 0;
    if (std::max(material.layers->specular_roughness_anisotropy, material.layers->coat_roughness_anisotropy) >
        0)
      out.features.surface_coordinates = true;
  }
  layers.push_back({});  // of things without a material
  out.layers = std::move(layers);
  out.layer_rows = std::move(rows.values);
}

}  // namespace sundog
