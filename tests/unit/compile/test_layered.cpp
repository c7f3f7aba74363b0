// Layered materials on the host: a film's colours against a sum of its reflections, and the terms that
// OpenPBR's values become.
#include <cmath>
#include <complex>
#include <numbers>

#include "catch.h"
#include "compile/layers/film.h"
#include "compile/layers/layers.h"
#include "compile/layers/round_facets.h"
#include "scene_text.h"

using namespace sundog;

namespace {

using Complex = std::complex<double>;

/// An interface's amplitudes (Born and Wolf, section 1.5.2), of which the field across the plane is one.
struct Fresnel {
  Complex reflected, passed;
};

Fresnel field_across(double n, Complex cos_n, double m, Complex cos_m) {
  return {(n * cos_n - m * cos_m) / (n * cos_n + m * cos_m), 2.0 * n * cos_n / (n * cos_n + m * cos_m)};
}
Fresnel field_along(double n, Complex cos_n, double m, Complex cos_m) {
  return {(m * cos_n - n * cos_m) / (m * cos_n + n * cos_m), 2.0 * n * cos_n / (m * cos_n + n * cos_m)};
}

/// The first reflection, and those that have gone through the film once, twice, ... two hundred times.
template <class Interface>
double summed(const ThinFilm& film, double cosine, double wavelength, const Interface& interface) {
  const auto behind = [&](double m) {
    return std::sqrt(Complex(1 - (1 - cosine * cosine) * film.before * film.before / (m * m)));
  };
  const Complex cos_film = behind(film.index), cos_base = behind(film.behind);
  const Fresnel in = interface(film.before, Complex(cosine), film.index, cos_film),
                out = interface(film.index, cos_film, film.before, Complex(cosine)),
                base = interface(film.index, cos_film, film.behind, cos_base);
  const Complex turn =
      std::exp(Complex(0, 4 * std::numbers::pi * film.index * film.thickness / wavelength) * cos_film);
  Complex field = in.reflected, way = in.passed * base.reflected * turn * out.passed;
  for (int i = 0; i < 200; ++i) {
    field += way;
    way *= out.reflected * base.reflected * turn;
  }
  return std::norm(field);
}

}  // namespace

TEST_CASE("a film reflects what the sum of its reflections is") {
  for (const ThinFilm& film :
       {ThinFilm{1, 1.4, 1.5, 300}, ThinFilm{1, 1.33, 2.4, 550}, ThinFilm{1.6, 1.9, 3, 120}})
    for (const double cosine : {1.0, 0.7, 0.35, 0.1})
      for (const double wavelength : {420.0, 550.0, 680.0}) {
        INFO(film.thickness << " nm at " << cosine << ", " << wavelength << " nm");
        const double sum =
            (summed(film, cosine, wavelength, field_across) + summed(film, cosine, wavelength, field_along)) /
            2;
        CHECK(film_reflectance(film, cosine, wavelength) == Approx(sum).epsilon(1e-9));
      }
}

TEST_CASE("a film of no thickness is not there, and a quarter wave of the root's index reflects nothing") {
  const double plain = std::pow((1.5 - 1) / (1.5 + 1), 2);
  CHECK(film_reflectance({1, 1.4, 1.5, 0}, 1, 550) == Approx(plain).epsilon(1e-9));
  const double index = std::sqrt(1.5);
  CHECK(film_reflectance({1, index, 1.5, 550 / (4 * index)}, 1, 550) == Approx(0).margin(1e-12));
  CHECK(film_reflectance({1.5, 1.4, 1.5, 0}, 0.01, 550) == 1);  // beyond the angle of total reflection
  const dvec3 color = film_color({1, 1.4, 1.5, 0}, 1, dvec3(0));
  for (int i = 0; i < 3; ++i) CHECK(color[i] == Approx(plain).epsilon(1e-3));
}

TEST_CASE("widths of facets keep their mean square and have the given ratio") {
  const FacetWidths round = facet_widths(0.5, 0), brushed = facet_widths(0.5, 0.8);
  CHECK(round.x == Approx(0.25));
  CHECK(round.y == Approx(0.25));
  CHECK(brushed.y / brushed.x == Approx(0.2));
  CHECK(brushed.x * brushed.x + brushed.y * brushed.y == Approx(2 * 0.25 * 0.25));
}

TEST_CASE("OpenPBR's values become a material's terms") {
  const SceneDescription scene = load_scene_text(R"({"materials": {
    "paint": {"type": "openpbr", "base_color": [0.5, 0.2, 0.1], "base_weight": 0.5, "coat_weight": 1},
    "ink": {"type": "openpbr", "transmission_weight": 1, "transmission_color": [0.5, 1, 1], "transmission_depth": 2,
      "transmission_scatter": [0.2, 0.5, 0], "transmission_scatter_anisotropy": 0.3,
      "specular_ior": 1.4, "specular_roughness": 0.1, "emission_luminance": 2}},
    "objects": [{"type": "sphere", "material": "ink"}, {"type": "sphere", "material": "paint"}]})");
  const MaterialDescription& ink =
      scene.materials[0].layers->transmission_weight > 0 ? scene.materials[0] : scene.materials[1];
  const MaterialDescription& paint = &ink == &scene.materials[0] ? scene.materials[1] : scene.materials[0];
  CHECK(paint.diffuse == dvec3(0.25, 0.1, 0.05));
  CHECK(paint.medium == -1);
  CHECK(paint.layers->coat_weight == 1);
  CHECK(ink.type == MaterialType::dielectric);
  CHECK(ink.emission == dvec3(2));
  const MediumDescription& inside = scene.media.at(static_cast<std::size_t>(ink.medium));
  CHECK(inside.ior == 1.4);
  // The medium scatters more green than it loses: all colours lose as much more.
  CHECK(inside.scattering == dvec3(0.1, 0.25, 0));
  CHECK(inside.anisotropy == 0.3);
  CHECK(inside.absorption.x == Approx(std::log(2) / 2 - 0.1 + 0.25));
  CHECK(inside.absorption.y == 0);
  CHECK(inside.absorption.z == Approx(0.25));
  const CompiledScene compiled = compile(scene);
  CHECK(compiled.features.layers);
  CHECK(compiled.layers.size() == scene.materials.size() + 1);
}

TEST_CASE("scenes without layered materials have no tables of theirs") {
  const CompiledScene plain = compile(
      load_scene_text(R"({"objects": [{"type": "sphere", "material": "m"}], "materials": {"m": {}}})"));
  CHECK_FALSE(plain.features.layers);
  CHECK(plain.layers.empty());
  CHECK(plain.layer_rows.empty());
}

TEST_CASE("textures of roughness have a grid, which materials that differ in colour share") {
  const CompiledScene scene = compile(load_scene_text(R"({
    "textures": {"t": {"type": "noise"}},
    "materials": {
      "a": {"type": "openpbr", "specular_roughness": "t"},
      "b": {"type": "openpbr", "specular_roughness": "t", "base_color": [0.1, 0.2, 0.3], "base_metalness": "t"},
      "c": {"type": "openpbr", "specular_roughness": "t", "specular_ior": 1.9},
      "d": {"type": "openpbr", "base_metalness": "t", "transmission_weight": 0.5}},
    "objects": [{"type": "sphere", "material": "a"}, {"type": "sphere", "material": "b"}, {"type": "sphere", "material": "c"},
      {"type": "sphere", "material": "d"}]})"));
  CHECK(scene.features.layer_maps);
  std::vector<u32> grids;
  for (std::size_t i = 0; i < 4; ++i) grids.push_back(scene.layers[i].grid);
  CHECK(grids[0] == grids[1]);
  CHECK(grids[2] != grids[0]);
  CHECK(grids[3] == NO_LAYER_GRID);
  CHECK(scene.layers[0].roughness == 1);
  CHECK(scene.layers[1].specular.w == 1);  // the texture is a factor on it
  CHECK(scene.materials[3].flags & MATERIAL_TRANSMITS);
  CHECK(scene.materials[3].transmission.x == 0.5f);
}

TEST_CASE(
    "textures of the coat's weight have a grid by it, with grids by roughness where a texture gives that") {
  const CompiledScene scene = compile(load_scene_text(R"({
    "textures": {"t": {"type": "noise"}},
    "materials": {
      "a": {"type": "openpbr", "coat_weight": "t"},
      "b": {"type": "openpbr", "coat_weight": "t", "coat_color": [0.1, 0.2, 0.3]},
      "c": {"type": "openpbr", "coat_weight": "t", "specular_roughness": "t"},
      "d": {"type": "openpbr", "coat_weight": 0.5}},
    "objects": [{"type": "sphere", "material": "a"}, {"type": "sphere", "material": "b"}, {"type": "sphere", "material": "c"},
      {"type": "sphere", "material": "d"}]})"));
  CHECK(scene.features.coat_maps);
  CHECK(scene.features.layer_maps);
  const Layers &a = scene.layers[0], &c = scene.layers[2];
  CHECK(a.coat.w == 1);  // the texture is a factor on it
  CHECK(a.grid == scene.layers[1].grid);
  CHECK(a.coat_grid == 0);
  CHECK(c.coat_grid == LAYER_GRID_STEPS * (LAYER_GRID_NUMBERS + 2 * LAYER_STEPS));
  CHECK(scene.layers[3].coat_grid == NO_LAYER_GRID);
  CHECK(scene.layers[3].grid == NO_LAYER_GRID);
}

TEST_CASE("numbers alone have no grid") {
  const CompiledScene scene =
      compile(load_scene_text(R"({"materials": {"m": {"type": "openpbr", "base_color": [1, 0, 0]}},
    "objects": [{"type": "sphere", "material": "m"}]})"));
  CHECK_FALSE(scene.features.layer_maps);
  CHECK_FALSE(scene.features.coat_maps);
  CHECK(scene.layers[0].grid == NO_LAYER_GRID);
  CHECK(scene.layer_rows.size() == LAYER_ROWS * LAYER_STEPS);
}

TEST_CASE("the tables of facets are computed when sundog is built") {
  CHECK(std::ranges::equal(built_layer_tables(), make_layer_tables()));
}

TEST_CASE("facets between the rows of their tables are those of a quadrature") {
  Interface film{1.5, 0.7, {}};
  for (std::size_t i = 0; i < LAYER_STEPS; ++i) film.film_row[i] = 0.5 + 0.5 * std::cos(0.2 * double(i));
  for (const double roughness : {0.05, 0.17, 0.31, 0.5, 0.77, 0.98}) {
    const FacetWidths widths{roughness * roughness, roughness * roughness};
    const FacetGains gains = facet_gains(widths);
    const Facets facets(widths);
    for (const Interface& interface :
         {Interface{1.5, 0, {}}, Interface{3, 0, {}}, Interface{1.05, 0, {}}, film}) {
      INFO("roughness " << roughness << ", index " << interface.eta << ", film " << interface.film);
      const FacetAlbedo wanted = facet_albedo(widths, gains, interface), found = facets.albedo(interface);
      for (std::size_t i = 0; i < LAYER_STEPS; ++i) {
        const double margin =
            i < 2 ? 0.03 : 5e-3;  // along the surface quadratures of neighbouring widths differ
        CHECK(facets.gains()[3][i] == Approx(gains[0][i]).epsilon(2e-3));
        CHECK(found.of_interface[i] == Approx(wanted.of_interface[i]).margin(margin));
      }
      CHECK(found.scale == Approx(wanted.scale).epsilon(2e-3));
    }
  }
  for (const double alpha : {0.01, 0.3, 0.8})
    for (std::size_t i = 0; i < LAYER_STEPS; ++i)
      CHECK(fuzz_between(alpha)[i] == Approx(fuzz_albedo(alpha)[i]).epsilon(5e-3).margin(2e-3));
}
