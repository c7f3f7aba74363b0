// The rows of shared/lobes.h on the host.
#pragma once
#include <array>
#include <string_view>

#include "compile/compiled_scene.h"

namespace sundog {

struct LobeRow {
  std::string_view name;
  bool SceneFeatures::* feature;  // set in scenes that have the lobe; null: all do
  u32 flags;                      // a material with the lobe has one of these
};

namespace lobe_features {
#define SUNDOG_LOBE_FEATURE(type, constant, member, effect) \
  inline constexpr type SceneFeatures::* constant = &SceneFeatures::member;
LOBE_FEATURES(SUNDOG_LOBE_FEATURE)
#undef SUNDOG_LOBE_FEATURE
inline constexpr bool SceneFeatures::* HAS_SURFACES = nullptr;

#define SUNDOG_LOBE_ROW(feature, name, flags) LobeRow{#name, feature, flags},
inline constexpr std::array rows{PERFECT_LOBES(SUNDOG_LOBE_ROW) SCATTERING_LOBES(SUNDOG_LOBE_ROW)};
#undef SUNDOG_LOBE_ROW
}  // namespace lobe_features

inline constexpr auto& lobe_rows = lobe_features::rows;

}  // namespace sundog
