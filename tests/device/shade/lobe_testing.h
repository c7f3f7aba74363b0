// A material's lobes at a surface z = 0 as integrators see them that follow one ray on: values, densities and
// samples of a batch of directions at a time.
#pragma once
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "catch.h"
#include "compile/layers/layers.h"
#include "compile/surfaces/lobe_energy.h"
#include "devices.h"
#include "shared/scene.h"
#include "surface_text.h"

namespace sundog::lobes {

using glm::dvec3;

inline constexpr double pi = std::numbers::pi;
inline constexpr u32 count = 1u << 12;

inline const std::string lobe_kernel = surface_text + R"(
#include "lib/core/sampler.cl"
#include "shared/lobes.h"
// The surface z = 0 of one material, seen from above, or from below where `below`, behind it the other of the media 0 and 1.
Bsdfs surface(__global const Material* materials, u32 below, float4 base, float4 tint) {
  const REAL3 n = real3(0.0f, 0.0f, below ? -1.0f : 1.0f), none = real3(0.0f, 0.0f, 0.0f);
  Bsdfs bsdf = make_surface(materials, n, (int)below, 1 - (int)below);
#if HAS_LAYERS
  bsdf.base = bsdf.diffuse;
  bsdf.tangent = real3(1.0f, 0.0f, 0.0f);
  bsdf.bitangent = real3(0.0f, 1.0f, 0.0f);
  const MASK layered = MASK_OF((bsdf.flags & (int)MATERIAL_LAYERED) != 0), inside = MASK_OF(below != 0u && !(materials[0].flags & MATERIAL_THIN));
  if (layered) bsdf.diffuse = none;
  bsdf.coated = layered & ~inside;
  bsdf.coated_behind = layered & inside;
#endif
#if HAS_LAYER_MAPS
  bsdf.metalness = base.x;
  bsdf.roughness = base.y;
  bsdf.glass = base.z;
#endif
#if HAS_COAT_MAPS
  bsdf.coat = base.w;
#endif
#if HAS_SPECULAR_MAPS
  bsdf.tint = real3(tint.x, tint.y, tint.z);
#endif
  return bsdf;
}
#define SHARE_OF_LOBE(feature, name, flags) +lobes.name
// Draws where `wi` has no length, else takes wi. Out: wi, density, weight or pi BSDF cos, whether it is specular,
// and red of the lobes' albedo.
__kernel void run(__global const Material* materials, __global const Medium* media, __global const float* energy,
                  __global const Layers* layers, __global const float* layer_rows, __global const float4* wis, __global float* out, float4 wo4, float4 base, float4 tint, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const Scene scene = {.materials = materials, .media = media, .lobe_energy = energy, .layers = layers, .layer_rows = layer_rows};
  const REAL3 wo = real3(wo4.x, wo4.y, wo4.z), given = real3(wis[i].x, wis[i].y, wis[i].z);
  const Bsdfs bsdf = surface(materials, wo4.z < 0.0f, base, tint);
  const LobeSets lobes = make_lobes(&scene, &bsdf, wo, ALL_LANES);
  // Roberts's sequence in three dimensions: even, and without a pattern of its own. In integers, as few floats lie
  // between large ones: numbers that are 0 too often draw lobes of small shares too often.
  const uint3 turns = 0x80000000u + (i + 1u) * (uint3)(3518319155u, 2882110345u, 2360945575u);
  const float3 u = convert_float3(turns >> 8) * (1.0f / 16777216.0f);
  const BsdfSamples s = sample_lobes(&scene, &bsdf, &lobes, wo, u.x, u.y, u.z, ALL_LANES);
  const bool draws = dot3(given, given) == 0.0f;
  REAL density = s.pdf;
  const REAL3 value = draws ? s.weight : bsdf_scatter(&scene, &bsdf, &lobes, wo, given, &density, ALL_LANES);
  const REAL3 wi = draws ? s.wi : given;
  __global float* to = out + 9u * i;
  to[0] = wi.x; to[1] = wi.y; to[2] = wi.z; to[3] = density;
  to[4] = value.x; to[5] = value.y; to[6] = value.z; to[7] = draws && s.specular ? 1.0f : 0.0f;
  to[8] = scattered_albedo(&scene, &bsdf, &lobes, wo, ALL_LANES).x PERFECT_LOBES(SHARE_OF_LOBE);
}
)";

inline const std::vector<float>& lobe_energy() {
  static const std::vector<float> energy = make_lobe_energy({.gains = true, .glass = true});
  return energy;
}

struct Lobe {
  dvec3 wi, value;
  double density;
  bool specular;
  double albedo;  // of all lobes, where the light that they return is white
};

class Tester {
 public:
  /// `layered`: materials have layers; `mapped`: whose metalness and roughness, coat's weight or
  /// reflected colour textures give.
  explicit Tester(const DeviceInfo& info, bool layered = false, bool mapped = false)
      : device_(info),
        kernel_(build_text(device_, lobe_kernel,
                           {{"TILE_W", "1"},
                            {"TILE_H", "1"},
                            {"LANES", "1"},
                            {"WIDE_VECTORS", "0"},
                            {"HAS_ROUGH_GLASS", "1"},
                            {"HAS_THIN_WALLS", "1"},
                            {"HAS_LAYERS", layered ? "1" : "0"},
                            {"HAS_LAYER_MAPS", mapped ? "1" : "0"},
                            {"HAS_COAT_MAPS", mapped ? "1" : "0"},
                            {"HAS_FUZZ_MAPS", "0"},
                            {"HAS_SPECULAR_MAPS", mapped ? "1" : "0"}})
                    .kernel<Buffer<Material>, Buffer<Medium>, Buffer<float>, Buffer<Layers>, Buffer<float>,
                            Buffer<float4>, Buffer<float>, float4, float4, float4, u32>("run")),
        mapped_(mapped),
        energy_(device_.upload<float>(lobe_energy())),
        layers_(device_.upload<Layers>(std::vector{Layers{}})),
        layer_rows_(device_.upload<float>(std::vector{0.f})) {}

  /// From now on materials have these layers; where they are mapped, with textures of one value, which give
  /// metalness and roughness unless others are named.
  Layers set_layers(const OpenPbr& values) {
    MaterialTextures textures;
    if (mapped_) textures.metalness = textures.roughness = 0;
    return set_layers(values, textures);
  }
  Layers set_layers(const OpenPbr& values, const MaterialTextures& textures) {
    rows_.values.clear(), rows_.grids.clear();  // its gains serve again
    const Layers layers = make_layers(values, textures, rows_);
    layers_ = device_.upload<Layers>(std::vector{layers});
    layer_rows_ = device_.upload<float>(rows_.values);
    set_base(values.base_metalness, values.specular_roughness, values.transmission_weight);
    return layers;
  }
  /// Sets the textures' values at the place; `coat` is a factor on the coat's weight.
  void set_base(double metalness, double roughness, double glass = 0, double coat = 1) {
    base_ = {float(metalness), float(roughness), float(glass), float(coat)};
    tint_ = {1, 1, 1, 0};
  }
  /// A factor on what the base's dielectric reflects, until the next set_base().
  void set_tint(const dvec3& tint) { tint_ = {float(tint.x), float(tint.y), float(tint.z), 0}; }

  /// For each direction the lobe there; for directions of no length a sample.
  std::vector<Lobe> look(const Material& material, double index, const dvec3& wo,
                         const std::vector<dvec3>& wis) {
    std::vector<Medium> media(2);
    media[0].absorption.w = 1;
    media[1].absorption.w = static_cast<float>(index);
    std::vector<float4> given;
    for (const dvec3& wi : wis) given.push_back({float(wi.x), float(wi.y), float(wi.z), 0});
    const auto size = static_cast<u32>(wis.size());
    const auto out = device_.make<float>(9 * wis.size());
    device_.run(kernel_, {.x = wis.size()}, device_.upload<Material>(std::vector{material}),
                device_.upload<Medium>(media), energy_, layers_, layer_rows_, device_.upload<float4>(given),
                out, float4{float(wo.x), float(wo.y), float(wo.z), 0}, base_, tint_, size);
    std::vector<float> values(9 * wis.size());
    device_.read(out, std::span<float>(values));
    device_.save_programs();  // for the next process: this one keeps its testers to the end
    std::vector<Lobe> lobes;
    for (std::size_t i = 0; i < wis.size(); ++i) {
      const float* v = values.data() + 9 * i;
      lobes.push_back({{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, v[3], v[7] != 0, v[8]});
    }
    return lobes;
  }

  std::vector<Lobe> draw(const Material& material, double index, const dvec3& wo, u32 draws = count) {
    return look(material, index, wo, std::vector<dvec3>(draws, dvec3(0)));
  }

 private:
  Device device_;
  Kernel<Buffer<Material>, Buffer<Medium>, Buffer<float>, Buffer<Layers>, Buffer<float>, Buffer<float4>,
         Buffer<float>, float4, float4, float4, u32>
      kernel_;
  bool mapped_;
  LayerRows rows_;
  float4 base_{}, tint_{};
  Buffer<float> energy_;
  Buffer<Layers> layers_;
  Buffer<float> layer_rows_;
};

/// The tester of a device, made once in a process: some drivers compile its kernel for seconds, and its
/// tables take as long. It stays until the end: drivers are gone when statics are destroyed.
inline Tester& tester_on(const DeviceInfo& info, bool layered = false, bool mapped = false) {
  static auto& made = *new std::map<std::tuple<std::string, bool, bool>, Tester>;
  Tester& tester = made.try_emplace({info.label(), layered, mapped}, info, layered, mapped).first->second;
  tester.set_base(0, 0);
  return tester;
}

inline Material rough_metal(double roughness, float color = 1) {
  Material metal{};
  metal.flags = MATERIAL_REFLECTS;
  metal.reflection = {color, color, color, float(roughness * roughness)};
  return metal;
}

inline Material rough_glass(double roughness) {
  Material glass{};
  glass.kind = MATERIAL_DIELECTRIC;
  glass.flags = MATERIAL_REFLECTS | MATERIAL_TRANSMITS;
  glass.reflection = {1, 1, 1, float(roughness * roughness)};
  glass.transmission = {1, 1, 1, 0};
  return glass;
}

inline dvec3 at_cosine(double cosine) { return {-std::sqrt(1 - cosine * cosine), 0, cosine}; }

inline double mean_weight(const std::vector<Lobe>& drawn) {
  double sum = 0;
  for (const Lobe& one : drawn) sum += one.value.x;
  return sum / double(drawn.size());
}

inline dvec3 on_sphere(double z, double turn) {
  const double side = std::sqrt(std::max(1 - z * z, 0.0));
  return {side * std::cos(2 * pi * turn), side * std::sin(2 * pi * turn), z};
}

inline constexpr int rows = 12, columns = 8, fine = 8;  // cells of directions; places in each along an axis

/// Directions in the middles of equal cells of the sphere, cell by cell.
inline std::vector<dvec3> all_directions() {
  std::vector<dvec3> directions;
  for (int cell = 0; cell < rows * columns; ++cell)
    for (int k = 0; k < fine * fine; ++k) {
      const int row = cell / columns, column = cell % columns;
      directions.push_back(on_sphere(-1 + 2 * (row + (k / fine + 0.5) / fine) / rows,
                                     (column + (k % fine + 0.5) / fine) / columns));
    }
  return directions;
}

inline std::size_t cell_of(const dvec3& d) {
  const int row = std::clamp(int((d.z + 1) / 2 * rows), 0, rows - 1);
  const double turn = std::atan2(d.y, d.x) / (2 * pi);
  const int column = std::clamp(int((turn - std::floor(turn)) * columns), 0, columns - 1);
  return static_cast<std::size_t>(row * columns + column);
}

/// Chi-squared over its degrees of freedom, of samples against their density: about 1 where they agree.
inline double chi_squared(Tester& tester, const Material& material, double index, const dvec3& wo) {
  const std::vector<Lobe> field = tester.look(material, index, wo, all_directions());
  std::vector<double> expected(rows * columns), found(rows * columns);
  for (std::size_t i = 0; i < field.size(); ++i)
    expected[i / (fine * fine)] += field[i].density * 4 * pi * count / double(field.size());
  for (const Lobe& one : tester.draw(material, index, wo))
    if (one.density > 0) found[cell_of(one.wi)] += 1;
  double sum = 0, few_expected = 0, few_found = 0;
  int cells = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (expected[i] < 10) {
      few_expected += expected[i];
      few_found += found[i];
      continue;
    }
    sum += (found[i] - expected[i]) * (found[i] - expected[i]) / expected[i];
    ++cells;
  }
  CHECK(std::abs(few_found - few_expected) < 5 * std::sqrt(few_expected + 4) + 0.02 * few_expected);
  REQUIRE(cells > 5);
  return sum / cells;
}

}  // namespace sundog::lobes
