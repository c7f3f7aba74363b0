// The light of a clear sky while the sun is below the horizon, or just above it.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace sundog {

/// Sunlight scattered by the air, haze and ozone around a round Earth. Single scattering is integrated along
/// each direction (Nishita and others 1993, "Display of the Earth Taking into Account Atmospheric
/// Scattering"); three further orders come from a table by height and the sun's angle, which assumes that
/// light is equal in all directions (after Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere
/// Rendering Technique"). Ozone gives the blue hour its colour (Hulburt 1953, "Explanation of the Brightness
/// and Color of the Sky, Particularly the Twilight Sky"). Refraction is neglected. Units as in sky.h. The
/// light never falls below that of the night sky.
class Twilight {
 public:
  /// `turbidity` as in sky.h; `sun_height` in radians above the horizon, [-pi / 10, pi / 10].
  Twilight(double turbidity, double sun_height);

  /// Radiance from a direction above the horizon, `zenith` radians from the zenith, [0, pi / 2], and
  /// `azimuth` radians from the sun's.
  glm::dvec3 radiance(double zenith, double azimuth) const;

 private:
  std::vector<glm::dvec3> light_;  // rows by zenith, columns by azimuth from 0 to pi
};

}  // namespace sundog
