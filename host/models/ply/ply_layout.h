// Maps the properties of PLY elements to the values that are read.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "models/ply/ply_header.h"

namespace sundog::models::ply {

enum Slot {
  px,
  py,
  pz,
  nx,
  ny,
  nz,
  tu,
  tv,
  red,
  green,
  blue,
  alpha,
  image,
  slot_count,
  no_slot = slot_count
};

Slot slot_of(std::string_view name);

// The slot of each property of an element, and the slots present.
struct Layout {
  std::vector<Slot> slots;
  std::array<bool, slot_count + 1> has{};

  explicit Layout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      const Slot slot = property.count_type ? no_slot : slot_of(property.name);
      slots.push_back(slot);
      has[slot] = true;
    }
  }
  bool normals() const { return has[nx] && has[ny] && has[nz]; }
  bool uvs() const { return has[tu] && has[tv]; }
  bool colors() const { return has[red] && has[green] && has[blue]; }
};

using Values = std::array<double, slot_count + 1>;

/// Converts a property's value: colours to linear, alpha to 0..1.
double slot_value(Slot slot, PlyType type, double value);

/// The colour of an element; white if NaN.
glm::vec3 color_of(const Values& values);

}  // namespace sundog::models::ply
