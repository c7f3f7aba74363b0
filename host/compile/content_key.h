// Content keys of parts of a description: equal keys compile to equal bytes.
#pragma once
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "scene/description.h"

namespace sundog {

/// A non-cryptographic 128-bit hash, long enough to avoid accidental collisions. The default value matches no
/// content.
struct ContentKey {
  std::uint64_t a = 0, b = 0;
  friend bool operator==(const ContentKey&, const ContentKey&) = default;
};

/// An earlier step's result as a later step's input; `key`, of the inputs that made it, is hashed in its
/// place.
template <class T>
struct Known {
  const T* value = nullptr;
  ContentKey key{};
  const T& operator*() const { return *value; }
  const T* operator->() const { return value; }
};

/// An input that is left out of the key: it appears only in messages, or another input's key covers it.
template <class T>
struct Unkeyed {
  T value{};
  const T& operator*() const { return value; }
  const T* operator->() const { return &value; }
};

template <class T>
concept NumberOrEnum = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Hashes values in order. Numbers are hashed by their bits: 0 and -0 differ.
class KeyMaker {
 public:
  KeyMaker& bytes(const void* data, std::size_t count);

  template <NumberOrEnum T>
  KeyMaker& add(const T& value) {
    return bytes(&value, sizeof value);
  }
  KeyMaker& add(std::string_view text);
  KeyMaker& add(const ContentKey& key) { return add(key.a).add(key.b); }
  template <class T>
  KeyMaker& add(const Known<T>& result) {
    return add(result.key);
  }
  template <class T>
  KeyMaker& add(const Unkeyed<T>&) {
    return *this;
  }
  template <glm::length_t N, class T>
  KeyMaker& add(const glm::vec<N, T>& v) {
    return bytes(&v, sizeof v);
  }
  template <glm::length_t C, glm::length_t R, class T>
  KeyMaker& add(const glm::mat<C, R, T>& m) {
    return bytes(&m, sizeof m);
  }

  // Each hashes all members that compile() reads, without names and places, which appear only in messages.
  KeyMaker& add(const Camera& camera);
  KeyMaker& add(const ToneMap& map);
  KeyMaker& add(const LightDescription& light);
  KeyMaker& add(const EnvironmentDescription& environment);
  /// The inputs of a halo map.
  KeyMaker& add_halo(const EnvironmentDescription& environment);
  KeyMaker& add(const MediumDescription& medium);
  KeyMaker& add(const ImageDescription& image);
  KeyMaker& add(const TextureDescription& texture);
  KeyMaker& add(const MaterialDescription& material);
  KeyMaker& add(const Mesh& mesh);
  KeyMaker& add(const Shape& shape);
  KeyMaker& add(const SdfDescription& field);
  KeyMaker& add(const SdfNode& node);
  KeyMaker& add(const Object& object);

  ContentKey key() const;

 private:
  std::uint64_t a_ = 0x9E3779B97F4A7C15u, b_ = 0xC2B2AE3D27D4EB4Fu, count_ = 0;
};

}  // namespace sundog
