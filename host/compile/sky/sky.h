// The light of a clear daytime sky and its sun.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// The luminance of 1 in a sky's light, in cd/m^2.
constexpr double sky_unit = 20000;

/// Linear sRGB of CIE XYZ (IEC 61966-2-1). May be negative.
glm::dvec3 linear_srgb(double x, double y, double z);

/// The sky of Preetham, Shirley and Smits 1999 ("A Practical Analytic Model for Daylight"): Perez's formula
/// for luminance and chromaticity, fitted to turbidity (2: very clear, 10: hazy) and solar altitude. Linear
/// sRGB; 1 is 20 kcd/m^2, so that a white surface in the sun is about 1.
class Sky {
 public:
  /// `sun_height` in radians above the horizon, [0, pi / 2].
  Sky(double turbidity, double sun_height);

  /// Radiance from a direction above the horizon, `zenith` radians from the zenith and `sun` radians from the
  /// sun. Not negative.
  glm::dvec3 radiance(double zenith, double sun) const;

  /// Irradiance from the sun alone on a surface that faces it, over pi: sunlight above the atmosphere, minus
  /// absorption by air, haze and ozone (Preetham and others, appendix A.1) at three wavelengths.
  glm::dvec3 sun_irradiance() const;

 private:
  double turbidity_, sun_zenith_;
  glm::dvec3 zenith_;    // Y in kcd/m^2, x, y
  glm::dvec3 perez_[5];  // coefficients A..E of Y, x, y
  glm::dvec3 perez_at_zenith_;
};

}  // namespace sundog
