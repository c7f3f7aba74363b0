// See content_key.h. Structured bindings name all members of a struct, so that a new member fails to compile
// until it is added here or left out on purpose.
#include "compile/parts/content_key.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <boost/pfr.hpp>
#include <cstring>

namespace sundog {
namespace {

constexpr std::uint64_t odd_a = 0x9E3779B97F4A7C15u, odd_b = 0xC2B2AE3D27D4EB4Fu;

/// Adds trivially copyable rows as one block of memory.
template <class Rows>
void add_rows(KeyMaker& key, const Rows& rows) {
  static_assert(std::is_trivially_copyable_v<typename Rows::value_type>);
  key.add(rows.size()).bytes(rows.data(), rows.size() * sizeof(typename Rows::value_type));
}

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

template <class T>
void add_optional(KeyMaker& key, const std::optional<T>& value) {
  key.add(value.has_value());
  if (value) key.add(*value);
}

void add(KeyMaker& key, const FormulaParameter& parameter) {
  const auto& [name, value, minimum, maximum, whole, meaning, old_name] = parameter;
  key.add(name).add_each(value.size(), whole);  // limits are checked when a scene is read
  (void)minimum, (void)maximum, (void)meaning, (void)old_name;
}

void add(KeyMaker& key, const FormulaDefinition& formula) {
  const auto& [name, title, source, kind, quaternion, start, map, distance, estimate, derivative, normalize,
               parameters, iterations, bailout, inside_radius, inside_safety, safety, exceptions, bounds,
               old_name, smooth] = formula;
  key.add(name).add(source).add_each(kind, quaternion).add(start).add(map).add(distance);
  key.add_each(estimate, derivative, normalize, parameters.size());
  for (const FormulaParameter& parameter : parameters) {
    add(key, parameter);
    add_rows(key, parameter.value);
  }
  key.add_each(iterations, bailout, inside_radius, inside_safety, safety, exceptions, smooth);
  (void)title, (void)bounds, (void)old_name;
}

void add(KeyMaker& key, const FormulaField& field) {
  const auto& [steps, iterations, bailout, safety] = field;
  key.add(steps.size());
  for (const FormulaStep& step : steps) {
    const auto& [definition, values, times] = step;
    add(key, definition);
    add_rows(key, values);
    key.add(times);
  }
  key.add_each(iterations, bailout, safety);
}

void add(KeyMaker& key, const StoredImage& image) {
  const auto& [width, height, channels, sample, exponent, data] = image;
  key.add_each(width, height, channels, sample);
  add_optional(key, exponent);
  add_many_bytes(key, data);
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
  // The shutter is for the frames of a film: it changes no scene.
  const auto& [position, target, up, fov, near, far, lens, moves_to, shutter] = camera;
  add_each(position, target, up, fov, near, far);
  const auto& [radius, focus, blades, rotate] = lens;
  add_each(radius, blades, rotate);
  add_optional(*this, focus);
  add(moves_to.has_value());
  if (moves_to) add_each(moves_to->position, moves_to->target);
  return *this;
}

KeyMaker& KeyMaker::add(const LightDescription& light) {
#define SUNDOG_KEY_MEMBER(type, name, ...) add(light.name);
  add(light.type);
  LIGHT_KEYS(SUNDOG_KEY_MEMBER)
#undef SUNDOG_KEY_MEMBER
  return *this;
}

KeyMaker& KeyMaker::add(const EnvironmentDescription& environment) {
  const auto& [type, color, intensity, up, rotate, samples, visible, hidden, picture, bottom, top,
               sun_altitude, sun_azimuth, sun_size, turbidity, ground, halo, halo_map] = environment;
  add_each(type, color, intensity, up, rotate, samples, visible, hidden, bottom, top, sun_altitude,
           sun_azimuth, sun_size, turbidity, ground, picture.width, picture.height, picture.channels,
           halo.optical_depth);
  add_rows(*this, picture.data);
  (void)halo_map;  // follows from the rest
  return add_halo(environment);
}

KeyMaker& KeyMaker::add_halo(const EnvironmentDescription& environment) {
  const auto& [crystals, optical_depth, index, rays, size] = environment.halo;
  (void)optical_depth;
  add_each(environment.sun_altitude, environment.sun_size, index, rays, size, crystals.size());
  for (const HaloCrystals& kind : crystals) {
    const auto& [shape, ratio, tilt, roll, share] = kind;
    add_each(shape, ratio, tilt, roll, share);
  }
  return *this;
}

KeyMaker& KeyMaker::add(const MediumDescription& medium) {
  const auto& [name, ior, absorption, priority, dispersion, scattering, anisotropy] = medium;
  (void)name;
  for (const double coefficient : dispersion.coefficients) add(coefficient);
  return add_each(ior, dispersion.kind, absorption, scattering, anisotropy, priority);
}

KeyMaker& KeyMaker::add(const ImageDescription& image) {
  const auto& [name, file, place, encoded, file_width, file_height, content, pixels, srgb, plain, of_model] =
      image;
  (void)name, (void)file, (void)place, (void)encoded, (void)file_width, (void)file_height, (void)plain,
      (void)of_model;
  sundog::add(*this, pixels);
  return add(srgb).add(content);
}

KeyMaker& KeyMaker::add(const TextureDescription& texture) {
  const auto& [name, kind, of, image, wrap, filter, channel, mapping, uv_set, uv, placement, parameter, stops,
               formula, factor, offset] = texture;
  (void)name;
  add_each(kind, of[0], of[1], image, wrap[0], wrap[1], filter, channel, mapping, uv_set, uv, placement,
           factor, offset);
  bytes(parameter, sizeof parameter);
  add(stops.size());
  for (const auto& [at, color] : stops) add_each(at, color);
  add(formula.text);
  for (const FormulaParameter& p : formula.parameters) {
    add(p.name);
    add_rows(*this, p.value);
  }
  return *this;
}

KeyMaker& KeyMaker::add(const MaterialDescription& material) {
  const auto& [name, type, ambient, diffuse, specular, exponent, blinn, emission, reflection, transmission,
               roughness, multiple_scattering, medium, wall_ior, shadow_opaque, shadow_filter, checker,
               off_camera, checker_ambient, checker_diffuse, checker_size, vertex_color, opacity, cutoff,
               one_sided, textures, metal_rough, normal_scale, bump, bump_uv, parallax, displaced_by,
               displacement, displacement_middle, displacement_edge, occlusion, coat, layers, by_paths] =
      material;
  (void)name;
  // Already applied to the meshes.
  (void)displaced_by, (void)displacement, (void)displacement_middle, (void)displacement_edge;
  add_each(type, ambient, diffuse, specular, exponent, blinn, emission, reflection, transmission, roughness,
           multiple_scattering, medium, wall_ior, shadow_opaque, off_camera, shadow_filter, checker,
           checker_ambient, checker_diffuse, checker_size, vertex_color, opacity, cutoff, one_sided,
           normal_scale, bump, bump_uv, parallax, occlusion, coat, metal_rough.has_value(),
           layers.has_value(), by_paths != nullptr);
  if (by_paths) add(*by_paths);
  if (layers) boost::pfr::for_each_field(*layers, [&](const auto& value) { add(value); });
  static_assert(sizeof textures % sizeof(int) == 0);
  bytes(&textures, sizeof textures);
  if (!metal_rough) return *this;
  const auto& [base, metalness, rough, reflectance] = *metal_rough;
  return add_each(base, metalness, rough, reflectance);
}

KeyMaker& KeyMaker::add(const Mesh& mesh) {
  const auto& [name, positions, normals, uvs, further_uvs, tangents, colors, alphas, triangles, materials,
               source_vertex_count] = mesh;
  (void)name, (void)source_vertex_count;
  add_rows(*this, positions);
  add_rows(*this, normals);
  add_rows(*this, uvs);
  add(further_uvs.size());
  for (const auto& set : further_uvs) add_rows(*this, set);
  add_rows(*this, tangents);
  add_rows(*this, colors);
  add_rows(*this, alphas);
  add_rows(*this, triangles);
  add_rows(*this, materials);
  return *this;
}

KeyMaker& KeyMaker::add(const Shape& shape) {
  add(shape.index());
  std::visit(
      [this](const auto& solid) {
        boost::pfr::for_each_field(solid, [this](const auto& member) { this->add(member); });
      },
      shape);
  return *this;
}

KeyMaker& KeyMaker::add(const SdfNode& node) {
  const auto& [kind, formula, smooth, offset, rotation, scale, period, count, amount, code, children] = node;
  sundog::add(*this, formula);
  add_each(kind, smooth, offset, rotation, scale, period, count, amount).add(code);
  return add_all(children);
}

KeyMaker& KeyMaker::add(const SdfDescription& field) {
  const auto& [name, root, lower, upper, sphere, detail, least, greatest, step_limit, coloring, occlusion,
               soft_shadow, glow, glow_width] = field;
  (void)name;
  add(root).add_each(lower, upper, least, greatest, step_limit, occlusion, soft_shadow, glow, glow_width);
  add_optional(*this, sphere);
  add_optional(*this, detail);
  const auto& [by, palette, scale, color_offset] = coloring;
  add_rows(*this, palette);
  return add_each(by, scale, color_offset);
}

}  // namespace sundog
