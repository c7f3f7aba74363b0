// The kinds of shapes, lights, samplers and filters by name, from the lists of kernels/shared.
#pragma once
#include <array>
#include <string_view>

#include "scene/description.h"

namespace sundog {

/// By the index of Shape: the names in scene files and figures.
inline constexpr std::array<std::string_view, SHAPE_COUNT> shape_names = {"mesh",
#define SUNDOG_SHAPE_NAME(constant, type, name) #name,
                                                                          SOLIDS(SUNDOG_SHAPE_NAME)
#undef SUNDOG_SHAPE_NAME
                                                                              "field"};
static_assert(shape_names[SHAPE_SDF] == "field");

/// By SAMPLER_* constant.
inline constexpr std::array<std::string_view, SAMPLER_INDEPENDENT + 1> sampler_names = {SAMPLERS};

struct FilterFacts {
  std::string_view name;
  double radius;  // in pixels, unless the scene says another
};

/// By Filter.
inline constexpr std::array filters = {FilterFacts{"box", 0.5}, FilterFacts{"tent", 1},
                                       FilterFacts{"gaussian", 1.5}, FilterFacts{"blackman_harris", 1.5},
                                       FilterFacts{"mitchell", 2}};

/// The names, in the table's order.
inline constexpr auto filter_names = [] {
  std::array<std::string_view, filters.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = filters[i].name;
  return names;
}();

struct LightTypeFacts {
  std::string_view name;  // in scene files and figures
  LightType type;
  bool placed = false;  // it has a position
  bool aimed = false;   // it has a direction
  bool extent = false;  // it has an extent, and no falloff
};

/// By LightType.
inline constexpr std::array light_types = {LightTypeFacts{.name = "ambient", .type = LightType::ambient},
#define SUNDOG_LIGHT_FACTS(constant, name, placed, aimed, extent) \
  LightTypeFacts{#name, LightType::name, placed, aimed, extent},
                                           LIGHTS(SUNDOG_LIGHT_FACTS)
#undef SUNDOG_LIGHT_FACTS
};

/// By EnvironmentType, from image on.
inline constexpr std::array<std::string_view, 4> environment_types = {"image", "gradient", "sky", "halo"};

/// By HALO_* constant.
inline constexpr std::array<std::string_view, HALO_RANDOM + 1> halo_shapes = {HALO_SHAPES};

constexpr const LightTypeFacts& facts_of(LightType type) {
  return light_types.at(static_cast<std::size_t>(type));
}

/// Of a LIGHT_* constant of the list.
constexpr const LightTypeFacts& facts_of_kind(u32 kind) { return light_types.at(kind + 1); }

}  // namespace sundog
