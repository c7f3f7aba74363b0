// The light of a clear sky by day and of its sun.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// A sky after Preetham, Shirley and Smits 1999 ("A Practical Analytic Model for Daylight"): Perez's formula
/// for luminance and chromaticity, fitted in the turbidity (2: very clear, 10: hazy) and the sun's height.
/// Linear sRGB; 1 stands for 20 kcd/m^2, so that a white surface in the sun is about 1.
class Sky {
 public:
  /// `sun_height` in radians above the horizon, [0, pi / 2].
  Sky(double turbidity, double sun_height);

  /// What a direction `zenith` radians from the zenith and `sun` radians from the sun sends, above the
  /// horizon. Not below 0.
  glm::dvec3 radiance(double zenith, double sun) const;

  /// What a white surface that faces the sun receives of it alone, over pi: the sun outside the atmosphere,
  /// less what air, haze and ozone take (Preetham and others, appendix A.1) at three wavelengths.
  glm::dvec3 sun_irradiance() const;

 private:
  double turbidity_, sun_zenith_;
  glm::dvec3 zenith_;    // Y in kcd/m^2, x, y
  glm::dvec3 perez_[5];  // the coefficients A..E of Y, x, y
  glm::dvec3 perez_at_zenith_;
};

}  // namespace sundog
