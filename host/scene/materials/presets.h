// Materials and textures by name: ice, red_wine, gold, smudges. In: a scene's document. Out: its media,
// textures and materials with those of the presets that it uses.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/json/value.h"

namespace sundog {

/// Metres in a scene unit, without the scene's key "unit".
inline constexpr double default_unit = 0.1;

/// The sections "media", "textures" and "materials" of `document` that its presets change, with these written
/// out. An object's material that the scene does not name is a preset, and a material {"preset": name, ...}
/// is that preset with the other keys in the place of its own; so are textures that materials name. Media get
/// the material's name, unless the scene has a medium of that name. Throws SceneError for a preset that does
/// not exist.
nlohmann::json preset_sections(const nlohmann::json& document, const JsonContext& context);

/// In alphabetical order.
std::vector<std::string> preset_names();
std::vector<std::string> texture_preset_names();

}  // namespace sundog
