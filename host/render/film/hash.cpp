// Mixes 8 bytes at a time; a scene's hash covers its settings, generated sources and tables.
#include "render/film/hash.h"

#include <bit>
#include <cstring>

namespace sundog {

std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed) {
  constexpr std::uint64_t odd_a = 0x9E3779B97F4A7C15u, odd_b = 0xC2B2AE3D27D4EB4Fu;
  const char* at = static_cast<const char*>(data);
  std::uint64_t state = seed ^ (bytes * odd_a);
  for (std::size_t left = bytes; left > 0;) {
    std::uint64_t word = 0;
    const std::size_t taken = left < sizeof word ? left : sizeof word;
    std::memcpy(&word, at, taken);
    state = std::rotl(state ^ (word * odd_b), 29) * odd_a;
    at += taken;
    left -= taken;
  }
  state ^= state >> 32;
  state *= odd_b;
  return state ^ (state >> 29);
}

std::uint64_t hash_scene(const CompiledScene& scene) {
  std::uint64_t state = hash_bytes(&scene.info, sizeof scene.info);
  const auto mix = [&](const auto& table) {
    state = hash_bytes(table.data(), table.size() * sizeof table[0], state);
  };
  state = hash_bytes(&scene.origin, sizeof scene.origin, state);
  state = hash_bytes(&scene.tracer, sizeof scene.tracer, state);
  state = hash_bytes(&scene.features.sampler, sizeof scene.features.sampler, state);
  const Sampling& sampling = scene.sampling;
  const double shared_out[] = {sampling.threshold,
                               static_cast<double>(sampling.first_samples),
                               sampling.surfaces ? 1.0 : 0.0,
                               sampling.contrast,
                               sampling.budget,
                               sampling.subsample ? 1.0 : 0.0,
                               sampling.subsample_contrast,
                               sampling.progressive ? 1.0 : 0.0};
  state = hash_bytes(shared_out, sizeof shared_out, state);
  const double photons[] = {static_cast<double>(scene.photons_by.count), scene.photons_by.radius};
  state = hash_bytes(photons, sizeof photons, state);
  mix(scene.integrator);
  mix(scene.field_source);
  mix(scene.pattern_source);
  for_each_table(scene, [&](const char*, const auto& table) { mix(table); });
  return state;
}

}  // namespace sundog
