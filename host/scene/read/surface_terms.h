// Reading functions that the material readers share.
#pragma once
#include "scene/read/parts.h"

namespace sundog {

/// A surface's colour: plain, a checkerboard of two colours, or a texture (a factor on both).
struct Pattern {
  dvec3 even{1}, odd{1};
  int texture = -1;
};

/// Reads a colour, or the name of a texture.
Pattern read_plain_color(const JsonValue& value, TextureLibrary& textures);
/// Reads a number, or the name of a texture, which sets the number to 1 times the texture.
void read_number(JsonObject& object, std::string_view key, double& to, int& texture,
                 TextureLibrary& textures);
/// Reads a surface's relief, sides, treatment of shadow rays and use of vertex colours.
void read_surface(JsonObject& object, MaterialDescription& material, TextureLibrary& textures);

/// Reads a material of the type "openpbr".
MaterialDescription read_openpbr(const JsonValue& value, std::string name,
                                 std::vector<MediumDescription>& media, TextureLibrary& textures);

}  // namespace sundog
