// 64-bit hashes of bytes and of a compiled scene, by which a checkpoint's scene is recognised. Not
// cryptographic.
#pragma once
#include <cstdint>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

/// Mixes eight bytes at a time by multiplication and rotation; `seed` chains calls.
std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed = 0);

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) {
  return hash_bytes(values.data(), values.size() * sizeof(T));
}

/// Hashes everything that the image depends on.
std::uint64_t hash_scene(const CompiledScene& scene);

}  // namespace sundog
