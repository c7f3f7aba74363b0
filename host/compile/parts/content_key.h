// Keys of parts of a description: what has the same key compiles to the same bytes.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "scene/description.h"

namespace sundog {

/// 128 bits of a hash that is not cryptographic: edits do not meet by chance. The default one is no
/// content's.
struct ContentKey {
  std::uint64_t a = 0, b = 0;
  friend bool operator==(const ContentKey&, const ContentKey&) = default;
};

template <class T>
concept NumberOrEnum = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Mixes values into a key, in order. Numbers count by their bits: 0 and -0 differ.
class KeyMaker {
 public:
  KeyMaker& bytes(const void* data, std::size_t count);

  template <NumberOrEnum T>
  KeyMaker& add(const T& value) {
    return bytes(&value, sizeof value);
  }
  KeyMaker& add(std::string_view text);
  KeyMaker& add(const ContentKey& key) { return add(key.a).add(key.b); }
  template <glm::length_t N, class T>
  KeyMaker& add(const glm::vec<N, T>& v) {
    return bytes(&v, sizeof v);
  }
  template <glm::length_t C, glm::length_t R, class T>
  KeyMaker& add(const glm::mat<C, R, T>& m) {
    return bytes(&m, sizeof m);
  }

  // Of a description all that compile() reads; names and places, which only messages have, are left out.
  KeyMaker& add(const Camera& camera);
  KeyMaker& add(const LightDescription& light);
  KeyMaker& add(const EnvironmentDescription& environment);
  /// What a map of a halo is made of.
  KeyMaker& add_halo(const EnvironmentDescription& environment);
  KeyMaker& add(const MediumDescription& medium);
  KeyMaker& add(const ImageDescription& image);
  KeyMaker& add(const TextureDescription& texture);
  KeyMaker& add(const MaterialDescription& material);
  KeyMaker& add(const Mesh& mesh);
  KeyMaker& add(const Shape& shape);
  KeyMaker& add(const SdfDescription& field);
  KeyMaker& add(const SdfNode& node);

  template <class T>
  KeyMaker& add_all(const T& list) {
    add(std::size(list));
    for (const auto& item : list) add(item);
    return *this;
  }
  /// All arguments in turn.
  template <class... T>
  KeyMaker& add_each(const T&... values) {
    (add(values), ...);
    return *this;
  }

  ContentKey key() const;

 private:
  std::uint64_t a_ = 0x9E3779B97F4A7C15u, b_ = 0xC2B2AE3D27D4EB4Fu, count_ = 0;
};

}  // namespace sundog
