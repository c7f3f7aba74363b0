// Packs OpenPBR parameters, then appends rows of fuzz, coat, base, film and gains; textures of roughness or
// coat weight add grids (base.h). Lobes as in kernels/plain/shade/layer_lobes.cl.
#include "compile/layers/layers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compile/layers/albedos.h"
#include "compile/layers/base.h"
#include "compile/layers/film.h"
#include "compile/layers/round_facets.h"
#include "models/values/lowering.h"
#include "scene/pack.h"

namespace sundog {
namespace {

/// The index above the base, under a coat of this weight.
double index_above(const OpenPbr& v, double coat_weight) {
  return v.coat_bends ? 1 + coat_weight * (v.coat_ior - 1) : 1;
}

/// The base's index relative to the index above it, inverted if below 1.
double base_eta(const OpenPbr& v, double coat_weight) {
  return lowering::base_index(v.specular_ior, std::sqrt(v.specular_weight), index_above(v, coat_weight));
}

/// The coat's `haze` for lowering::seen_roughness().
double haze(const OpenPbr& v) { return v.coat_bends ? 2 * std::pow(v.coat_roughness, 4) : 0; }

/// Internal reflectance of a coat for light from a base (OpenPBR 1.1, "Coat", "Darkening"): at normal
/// incidence for a smooth base, diffuse for a rough one.
double inner_reflectance(double eta, double roughness) {
  constexpr int steps = 256;
  const Interface outer{eta, 0, {}};
  double outside = 0;  // diffuse reflectance from outside
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    outside += 2 * cosine * interface_reflects(cosine, outer) / steps;
  }
  return std::lerp(interface_reflects(1, outer), 1 - (1 - outside) / (eta * eta), roughness);
}

double greatest(const dvec3& color) { return std::max({color.x, color.y, color.z}); }

/// A film's rows; empty without a film.
struct FilmColors {
  std::array<dvec3, LAYER_STEPS> glass{}, metal{};
};

FilmColors film_colors(const OpenPbr& v, double coat_weight) {
  FilmColors colors;
  if (v.thin_film_weight == 0) return colors;
  const double above = index_above(v, coat_weight), eta = base_eta(v, coat_weight);
  const double below = v.specular_ior < above ? above / eta : above * eta;
  const ThinFilm film{above, v.thin_film_ior, below, v.thin_film_thickness * 1000};
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    const double cosine = std::max(double(i) / (LAYER_STEPS - 1), 1e-3);
    colors.glass[i] = film_color(film, cosine, dvec3(0));
    colors.metal[i] = film_color(film, cosine, glm::max(v.base_weight * v.base_color, dvec3(1e-4)));
  }
  return colors;
}

void write_film(const FilmColors& film, std::vector<float>& to) {
  for (const auto* colors : {&film.glass, &film.metal})
    for (int channel = 0; channel < 3; ++channel)
      for (const dvec3& color : *colors) to.push_back(float(color[channel]));
}

/// Light that weighted fuzz transmits, and the albedo of a coat of weight 1.
struct Above {
  AlbedoRow past_fuzz, coat;
  FacetGains coat_gains;  // if there is a coat
  double fuzz_weight;
};

Above layers_above(const OpenPbr& v, const Layers& to) {
  const FacetWidths coat_widths{to.coat_alpha, to.coat_alpha_y};
  Above above;
  FacetAlbedo coat{};
  if (v.coat_weight > 0) {
    const Facets facets(coat_widths);
    above.coat_gains = facets.gains();
    coat = facets.albedo({v.coat_ior, 0, {}});
  }
  const AlbedoRow fuzz = v.fuzz_weight > 0 ? fuzz_between(to.fuzz_alpha) : AlbedoRow{};
  above.fuzz_weight = v.fuzz_weight / std::max(1.0, *std::ranges::max_element(fuzz));
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    above.past_fuzz[i] = 1 - above.fuzz_weight * fuzz[i];
    above.coat[i] = std::min(coat.of_interface[i], 1.0);
  }
  return above;
}

AlbedoRow past_coat(const Above& above, double coat_weight) {
  AlbedoRow past;
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) past[i] = 1 - coat_weight * above.coat[i];
  return past;
}

/// The base's surroundings under a coat of this weight.
BaseSurroundings surroundings(const OpenPbr& v, double coat_weight, const Above& above,
                              const FilmColors& film) {
  BaseSurroundings around;
  around.interface = {float(base_eta(v, coat_weight)), v.thin_film_weight, {}};
  around.tint = greatest(v.specular_color);
  around.matte_roughness = v.base_diffuse_roughness;
  const AlbedoRow past = past_coat(above, coat_weight);
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
    around.interface.film_row[i] = greatest(film.glass[i]);
    around.above[i] = above.past_fuzz[i] * past[i];
  }
  return around;
}

FacetWidths base_widths(const OpenPbr& v, double coat_weight) {
  const double roughness = lowering::seen_roughness(v.specular_roughness, haze(v), coat_weight);
  return wide_enough(facet_widths(roughness, v.specular_roughness_anisotropy));
}

void set_numbers(const OpenPbr& v, Layers& to) {
  const double turn = glm::radians(v.geometry_tangent);
  const FacetWidths widths = base_widths(v, v.coat_weight),
                    stretched = facet_widths(std::sqrt(0.5), v.specular_roughness_anisotropy);
  to.alpha_x = float(widths.x), to.alpha_y = float(widths.y);
  to.eta = float(base_eta(v, v.coat_weight));
  to.film = float(v.thin_film_weight);
  const FacetWidths coat = wide_enough(facet_widths(v.coat_roughness, v.coat_roughness_anisotropy));
  to.coat_alpha = float(coat.x), to.coat_alpha_y = float(coat.y);
  to.coat_eta = float(v.coat_ior);
  to.fuzz_alpha = float(std::max(v.fuzz_roughness * v.fuzz_roughness, least_fuzz_alpha));
  to.metal = float(std::min(v.specular_weight, 1.0));
  to.matte_roughness = float(v.base_diffuse_roughness);
  to.glass = float(v.transmission_weight);
  to.turn_x = float(std::cos(turn)), to.turn_y = float(std::sin(turn));
  to.darkening = float(v.coat_weight * v.coat_darkening);
  to.inner_smooth = float(inner_reflectance(v.coat_ior, 0));
  to.inner_matte = float(inner_reflectance(v.coat_ior, 1));
  to.roughness = float(v.specular_roughness);
  to.haze = float(haze(v));
  to.coat_bends = v.coat_bends ? float(v.coat_ior - 1) : 0;
  to.stretch = float(2 * stretched.x);
  to.narrowed = float(1 - v.specular_roughness_anisotropy);
  to.index = float(v.specular_ior);
  to.index_scale = float(std::sqrt(v.specular_weight));
}

bool maps_coat(const OpenPbr& v, const MaterialTextures& textures) {
  return v.coat_weight > 0 && textures.coat >= 0;
}

/// Adds the grid by coat weight, and by roughness too if a texture sets it.
void add_coat_steps(const OpenPbr& v, bool rough, const Above& above, LayerRows& rows, Layers& to) {
  const double anisotropy = v.specular_roughness_anisotropy;
  std::vector<BaseSurroundings> around;
  std::vector<FacetWidths> widths;
  for (std::size_t i = 0; i < LAYER_GRID_STEPS; ++i) {
    const double weight = v.coat_weight * double(i) / (LAYER_GRID_STEPS - 1);
    const FilmColors film = film_colors(v, weight);
    around.push_back(surroundings(v, weight, above, film));
    widths.push_back(base_widths(v, weight));
    if (v.thin_film_weight > 0) write_film(film, rows.values);
  }
  to.coat_grid = rough ? layer_grid_size(anisotropy) : 0;
  to.grid =
      rough ? add_roughness_grids(anisotropy, around, rows) : add_coat_grid(anisotropy, widths, around, rows);
}

}  // namespace

Layers make_layers(const OpenPbr& v, const MaterialTextures& textures, LayerRows& rows) {
  Layers to{};
  set_numbers(v, to);
  const FilmColors film = film_colors(v, v.coat_weight);
  const Above above = layers_above(v, to);
  const BaseSurroundings around = surroundings(v, v.coat_weight, above, film);
  const Facets facets({to.alpha_x, to.alpha_y});
  const BaseInterface base = base_interface(facets.albedo(around.interface), around);
  to.straight = float(base.straight);
  to.inner = float(inner_reflectance(
      v.coat_ior, lowering::base_diffuseness(base.straight, v.base_metalness, v.specular_roughness)));
  to.shine_scale = float(base.shine_scale);
  to.matte_scale = float(base.matte_scale);
  to.matte_scale_bare = float(base.matte_scale_bare);
  to.specular = pack(v.specular_color, v.base_metalness);
  to.coat = pack(v.coat_color, v.coat_weight);
  to.fuzz = pack(v.fuzz_color, above.fuzz_weight);
  to.first = u32(rows.values.size());
  const AlbedoRow past = past_coat(above, v.coat_weight);
  for (const AlbedoRow* row : {&above.past_fuzz, &past, &base.past})
    rows.values.insert(rows.values.end(), row->begin(), row->end());
  write_film(film, rows.values);
  for (const AlbedoRow& row : facets.gains()) rows.values.insert(rows.values.end(), row.begin(), row.end());
  to.grid = to.coat_grid = NO_LAYER_GRID;
  if (maps_coat(v, textures))
    add_coat_steps(v, textures.roughness >= 0, above, rows, to);
  else if (textures.roughness >= 0)
    to.grid = add_roughness_grids(v.specular_roughness_anisotropy, {&around, 1}, rows);
  to.coat_gains = NO_LAYER_GAINS;
  if (v.coat_weight > 0 && to.coat_alpha != to.coat_alpha_y) {
    to.coat_gains = u32(rows.values.size());
    for (const AlbedoRow& row : above.coat_gains)
      rows.values.insert(rows.values.end(), row.begin(), row.end());
  }
  return to;
}

void add_layers(const SurfaceInputs& in, Surfaces& out) {
  if (std::ranges::none_of(in.materials, [](const MaterialDescription& m) { return m.layers.has_value(); }))
    return;
  LayerRows rows;
  std::vector<Layers> layers;
  for (const MaterialDescription& material : in.materials) {
    const MaterialTextures& textures = material.textures;
    layers.push_back(material.layers ? make_layers(*material.layers, textures, rows) : Layers{});
    if (!material.layers) continue;
    const bool coat = maps_coat(*material.layers, textures);
    out.features.coat_maps |= coat;
    out.features.specular_maps |= textures.specular >= 0;
    out.features.fuzz_maps |= textures.fuzz >= 0;
    out.features.layer_maps |=
        coat || std::max({textures.metalness, textures.roughness, textures.glass}) >= 0;
    if (std::max(material.layers->specular_roughness_anisotropy, material.layers->coat_roughness_anisotropy) >
        0)
      out.features.surface_coordinates = true;
  }
  layers.push_back({});  // for objects without a material
  out.layers = std::move(layers);
  out.layer_rows = std::move(rows.values);
}

}  // namespace sundog
