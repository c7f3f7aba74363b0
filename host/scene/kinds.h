// Names and properties of shapes, lights, samplers and filters, from the lists in kernels/shared.
#pragma once
#include <array>
#include <string_view>

#include "base/named_values.h"
#include "scene/description.h"

namespace sundog {

/// Names in scene files and figures, by Shape index.
inline constexpr std::array<std::string_view, SHAPE_COUNT> shape_names = {"mesh",
#define SUNDOG_SHAPE_NAME(constant, type, name, effect) #name,
                                                                          SOLIDS(SUNDOG_SHAPE_NAME)
#undef SUNDOG_SHAPE_NAME
                                                                              "field"};
static_assert(shape_names[SHAPE_SDF] == "field");

#define SUNDOG_NAMED_CONSTANT(constant, name) NamedValue<u32>{#name, constant},
/// SAMPLER_*, HALO_* and STRATEGY_* constants by name.
inline constexpr std::array samplers = {SAMPLERS(SUNDOG_NAMED_CONSTANT)};
inline constexpr std::array halo_shapes = {HALO_SHAPES(SUNDOG_NAMED_CONSTANT)};
inline constexpr std::array light_strategies = {LIGHT_STRATEGIES(SUNDOG_NAMED_CONSTANT)};
#undef SUNDOG_NAMED_CONSTANT

struct FilterFacts {
  std::string_view name;
  Filter value;
  double radius;  // default, in pixels
};

inline constexpr std::array filters = {FilterFacts{"box", Filter::box, 0.5},
                                       FilterFacts{"tent", Filter::tent, 1},
                                       FilterFacts{"gaussian", Filter::gaussian, 1.5},
                                       FilterFacts{"blackman_harris", Filter::blackman_harris, 1.5},
                                       FilterFacts{"mitchell", Filter::mitchell, 2}};
inline constexpr auto filter_names = names_of(filters);

/// Spatial extent of a light.
enum class LightExtent {
  none,     // a point or direction
  sampled,  // an area that is sampled but invisible to rays
  met       // sampled and visible to rays, unless the scene says `"hidden": true`
};

struct LightTypeFacts {
  std::string_view name;  // in scene files and figures
  LightType value;
  bool placed = false;  // it has a position
  bool aimed = false;   // it has a direction
  LightExtent extent = LightExtent::none;

  constexpr bool has_extent() const { return extent != LightExtent::none; }
  constexpr bool can_be_met() const { return extent == LightExtent::met; }
};

/// Indexed by LightType.
inline constexpr std::array light_types = {LightTypeFacts{.name = "ambient", .value = LightType::ambient},
#define SUNDOG_LIGHT_FACTS(constant, name, placed, aimed, extent) \
  LightTypeFacts{#name, LightType::name, placed, aimed, LightExtent::extent},
                                           LIGHTS(SUNDOG_LIGHT_FACTS)
#undef SUNDOG_LIGHT_FACTS
};

constexpr const LightTypeFacts& facts_of(LightType type) {
  return light_types.at(static_cast<std::size_t>(type));
}

/// The row of a LIGHT_* constant.
constexpr const LightTypeFacts& facts_of_kind(u32 kind) { return light_types.at(kind + 1); }

}  // namespace sundog
