// Object and material ids as mattes for compositing programs, by the Cryptomatte specification 1.2 (Friedman
// and Jones 2015, "Fully automatic ID mattes with support for motion blur and transparency").
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/image_io.h"

namespace sundog {

/// MurmurHash3, 32 bits (Austin Appleby), with seed 0.
std::uint32_t hash_name(std::string_view name);

/// The bits of the float that stands for a name: its hash, with the exponent clamped so that it is no NaN,
/// infinity or denormal.
std::uint32_t id_bits(std::string_view name);

/// Names by index.
struct MatteNames {
  std::vector<std::string> objects, materials;
};

/// Replaces each of the AOVs crypto_object and crypto_material (Film::develop_aov(): pairs of an index and
/// the share of the pixel that it covers) by layers of two pairs, crypto_object00, crypto_object01 and so on,
/// whose ids are hashes of the names. Returns their entries for an EXR's header: hash, conversion, and a
/// manifest of all names. Unnamed entries are called "object 3" or "material 3" by their index.
ImageTexts name_cryptomattes(AovImages& aovs, const MatteNames& names);

}  // namespace sundog
