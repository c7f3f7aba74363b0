// Hashes a struct's members in order, except those that its add() lists.
#include "compile/content_key.h"

#include "compile/steps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/pfr.hpp>
#include <cstring>

namespace sundog {
namespace {

constexpr std::uint64_t odd_a = 0x9E3779B97F4A7C15u, odd_b = 0xC2B2AE3D27D4EB4Fu;

/// Large blocks are hashed in pieces by several threads.
void add_many_bytes(KeyMaker& key, const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t piece = std::size_t{1} << 19;
  std::vector<ContentKey> keys((bytes.size() + piece - 1) / piece);
  tbb::parallel_for(std::size_t{0}, keys.size(), [&](std::size_t i) {
    const std::size_t first = i * piece;
    keys[i] = KeyMaker().bytes(bytes.data() + first, std::min(piece, bytes.size() - first)).key();
  });
  key.add(bytes.size());
  for (const ContentKey& of_piece : keys) key.add(of_piece);
}

template <class T, class... Skipped>
void add_members(KeyMaker& key, const T& value, const Skipped&... skipped);

template <class T>
concept Pointer = requires(const T& value) {
  *value;
  static_cast<bool>(value);
};
template <class T>
concept Rows = requires(const T& value) { value.data(), value.size(); };
template <class T>
concept Plain = NumberOrEnum<T> || requires { T::length(); };  // has no padding, so its bytes can be hashed

void add_member(KeyMaker& key, const Image& image) {
  key.add(image.width).add(image.height).add(image.channels).add(image.data.size());
  key.bytes(image.data.data(), image.data.size() * sizeof image.data[0]);
}

template <class T>
void add_member(KeyMaker& key, const T& value) {
  if constexpr (requires { key.add(value); }) {
    key.add(value);
  } else if constexpr (Pointer<T>) {
    key.add(static_cast<bool>(value));
    if (value) add_member(key, *value);
  } else if constexpr (std::is_same_v<T, std::vector<std::uint8_t>>) {
    add_many_bytes(key, value);
  } else if constexpr (Rows<T>) {
    using Row = std::remove_cvref_t<decltype(*value.data())>;
    key.add(value.size());
    if constexpr (Plain<Row>)
      key.bytes(value.data(), value.size() * sizeof(Row));
    else
      for (const Row& row : value) add_member(key, row);
  } else {
    add_members(key, value);
  }
}

template <class T, class... Skipped>
void add_members(KeyMaker& key, const T& value, const Skipped&... skipped) {
  const std::array<const void*, sizeof...(skipped)> left_out{&skipped...};
  boost::pfr::for_each_field(value, [&](const auto& member) {
    if (std::ranges::find(left_out, &member) == left_out.end()) add_member(key, member);
  });
}

}  // namespace

KeyMaker& KeyMaker::bytes(const void* data, std::size_t count) {
  const char* at = static_cast<const char*>(data);
  count_ += count;
  for (std::size_t left = count; left > 0;) {
    std::uint64_t word = 0;
    const std::size_t taken = left < sizeof word ? left : sizeof word;
    std::memcpy(&word, at, taken);
    a_ = std::rotl(a_ ^ (word * odd_b), 29) * odd_a;
    b_ = std::rotl(b_ + word, 31) * odd_b ^ a_ >> 32;
    at += taken;
    left -= taken;
  }
  return *this;
}

KeyMaker& KeyMaker::add(std::string_view text) { return add(text.size()).bytes(text.data(), text.size()); }

ContentKey KeyMaker::key() const {
  const auto finish = [](std::uint64_t state) {
    state = (state ^ state >> 32) * odd_b;
    return state ^ state >> 29;
  };
  return {finish(a_ ^ count_), finish(b_ + count_)};
}

KeyMaker& KeyMaker::add(const Camera& camera) {
  add_members(*this, camera, camera.shutter);  // affects only how an animation samples its frames
  return *this;
}

KeyMaker& KeyMaker::add(const ToneMap& map) {
  add_members(*this, map);
  return *this;
}

KeyMaker& KeyMaker::add(const LightDescription& light) {
  add_members(*this, light);
  return *this;
}

KeyMaker& KeyMaker::add(const EnvironmentDescription& environment) {
  add_members(*this, environment, environment.halo_map);  // derived from the other members
  return *this;
}

KeyMaker& KeyMaker::add_halo(const EnvironmentDescription& environment) {
  add_members(*this, environment.halo, environment.halo.optical_depth);
  return add(environment.sun_altitude).add(environment.sun_size);
}

KeyMaker& KeyMaker::add(const MediumDescription& medium) {
  add_members(*this, medium, medium.name);
  return *this;
}

KeyMaker& KeyMaker::add(const ImageDescription& image) {
  add_members(*this, image, image.name, image.file, image.place, image.encoded, image.file_width,
              image.file_height, image.plain, image.of_model);
  return *this;
}

KeyMaker& KeyMaker::add(const TextureDescription& texture) {
  add_members(*this, texture, texture.name);
  return *this;
}

KeyMaker& KeyMaker::add(const MaterialDescription& material) {
  // Displacement is already applied to the meshes.
  add_members(*this, material, material.name, material.displaced_by, material.displacement,
              material.displacement_middle, material.displacement_edge);
  return *this;
}

KeyMaker& KeyMaker::add(const Mesh& mesh) {
  add_members(*this, mesh, mesh.name, mesh.source_vertex_count);
  return *this;
}

KeyMaker& KeyMaker::add(const Shape& shape) {
  add(shape.index());
  std::visit([this](const auto& solid) { add_members(*this, solid); }, shape);
  return *this;
}

KeyMaker& KeyMaker::add(const SdfNode& node) {
  add_members(*this, node);
  return *this;
}

KeyMaker& KeyMaker::add(const SdfDescription& field) {
  add_members(*this, field, field.name);
  return *this;
}

KeyMaker& KeyMaker::add(const Object& object) {
  add_members(*this, object, object.name, object.place, object.light);  // lights are given rows later
  return *this;
}

ContentKey key_of(const HaloInputs& inputs) {
  KeyMaker key;
  key.add(inputs.environment->type);
  if (inputs.environment->type == EnvironmentType::halo) key.add_halo(*inputs.environment);
  return key.key();
}

#define SUNDOG_KEY_OF(Inputs)               \
  ContentKey key_of(const Inputs& inputs) { \
    KeyMaker key;                           \
    add_members(key, inputs);               \
    return key.key();                       \
  }
SUNDOG_KEY_OF(LightInputs)
SUNDOG_KEY_OF(SurfaceInputs)
SUNDOG_KEY_OF(MeshInputs)
SUNDOG_KEY_OF(MappingInputs)
SUNDOG_KEY_OF(InstanceInputs)
SUNDOG_KEY_OF(TouchingInputs)
SUNDOG_KEY_OF(FieldInputs)
#undef SUNDOG_KEY_OF

}  // namespace sundog
