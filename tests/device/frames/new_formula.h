// A scene whose kernel no run before has built.
#pragma once
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/document.h"

/// No run before had it: a kernel with it is in no cache.
inline long long new_number() {
  return std::chrono::system_clock::now().time_since_epoch().count() % 1000000007;
}

/// A scene of one formula that has such a number.
inline sundog::SceneDescription new_formula(const std::string& distance) {
  const nlohmann::json document = {{"image", {{"width", 37}, {"height", 26}}},
                                   {"lights", {{{"type", "ambient"}}}},
                                   {"materials", {{"grey", {{"color", {0.5, 0.5, 0.5}}}}}},
                                   {"objects",
                                    {{{"type", "formula"},
                                      {"material", "grey"},
                                      {"distance", fmt::format("{} + {}e-12", distance, new_number())}}}}};
  return sundog::load_scene_document(document, "new.json");
}
