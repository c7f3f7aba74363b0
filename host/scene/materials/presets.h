// Materials and textures by name: ice, red_wine, gold, smudges. In: a scene's document. Out: its media,
// textures and materials, with the presets that it uses.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/json/value.h"

namespace sundog {

/// Metres per scene unit if the scene has no key "unit".
inline constexpr double default_unit = 0.1;

/// The sections "media", "textures" and "materials" of `document` that its presets change, with the presets
/// expanded. An object's material that the scene does not define is a preset; a material {"preset": name,
/// ...} is that preset, with the other keys replacing its own; likewise for textures that materials name.
/// Media get the material's name, unless the scene has a medium of that name. Throws SceneError for an
/// unknown preset.
nlohmann::json preset_sections(const nlohmann::json& document, const JsonContext& context);

/// Preset names in alphabetical order.
std::vector<std::string> preset_names();
std::vector<std::string> texture_preset_names();

}  // namespace sundog
