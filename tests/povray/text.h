// Numbers, vectors and matrices in POV-Ray's notation.
#pragma once
#include <fmt/format.h>

#include <glm/glm.hpp>
#include <string>

namespace sundog::povray {

inline std::string text(double value) { return fmt::format("{:.17g}", value); }

template <class Vector>
std::string text(const Vector& v) {
  return fmt::format("<{:.9g},{:.9g},{:.9g}>", v.x, v.y, v.z);
}

inline std::string rgb(const glm::dvec3& c) { return "rgb " + text(c); }

/// `matrix <...>`: POV-Ray multiplies row vectors, and has no fourth column.
inline std::string matrix(const glm::dmat4& m) {
  std::string out = "matrix <";
  for (int column = 0; column < 4; column++)
    for (int row = 0; row < 3; row++)
      out += fmt::format("{}{:.17g}", column + row ? "," : "", m[column][row]);
  return out + ">";
}

}  // namespace sundog::povray
