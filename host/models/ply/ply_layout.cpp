// Maps property names to slots, and colours to linear values.
#include "models/ply/ply_layout.h"

#include <algorithm>
#include <cmath>

#include "models/readers.h"

namespace sundog::models::ply {

Slot slot_of(std::string_view name) {
  struct Known {
    std::string_view name;
    Slot slot;
  };
  static constexpr std::array<Known, 25> known{{{"x", px},
                                                {"y", py},
                                                {"z", pz},
                                                {"nx", nx},
                                                {"ny", ny},
                                                {"nz", nz},
                                                {"u", tu},
                                                {"v", tv},
                                                {"s", tu},
                                                {"t", tv},
                                                {"texture_u", tu},
                                                {"texture_v", tv},
                                                {"red", red},
                                                {"green", green},
                                                {"blue", blue},
                                                {"r", red},
                                                {"g", green},
                                                {"b", blue},
                                                {"diffuse_red", red},
                                                {"diffuse_green", green},
                                                {"diffuse_blue", blue},
                                                {"alpha", alpha},
                                                {"a", alpha},
                                                {"diffuse_alpha", alpha},
                                                {"texnumber", image}}};
  for (const Known& k : known)
    if (k.name == name) return k.slot;
  return no_slot;
}

double slot_value(Slot slot, PlyType type, double value) {
  if (slot < red || slot > alpha || is_real(type)) return value;
  const double most = type == PlyType::uint16 ? 65535.0 : 255.0, part = std::clamp(value / most, 0.0, 1.0);
  return slot == alpha ? part : static_cast<double>(linear_from_srgb(part));
}

glm::vec3 color_of(const Values& values) {
  const dvec3 color(values[red], values[green], values[blue]);
  return is_finite(color) ? glm::max(glm::vec3(color), glm::vec3(0)) : glm::vec3(1);
}

}  // namespace sundog::models::ply
