// What the readers of materials share.
#pragma once
#include "scene/read/parts.h"

namespace sundog {

/// What colours a surface: one colour, two in a checkerboard, or a texture (a factor on both).
struct Pattern {
  dvec3 even{1}, odd{1};
  int texture = -1;
};

inline constexpr Range ior_range{.low = 0.01, .high = 100};

/// A colour, or the name of a texture.
Pattern read_plain_color(const JsonValue& value, TextureLibrary& textures, const Range& range = color_range);
/// A number, or the name of a texture that is a factor on 1.
double read_number(const JsonValue& value, TextureLibrary& textures, const Range& range, int* texture);
/// The keys of a surface's relief, its sides, what it does to rays of light and whether vertices colour it.
void read_surface(JsonObject& object, MaterialDescription& material, TextureLibrary& textures);

/// A material of the type "openpbr".
MaterialDescription read_openpbr(const JsonValue& value, std::string name,
                                 std::vector<MediumDescription>& media, TextureLibrary& textures);

}  // namespace sundog
