// See tone_map.h.
#include "base/tone_map.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace sundog {
namespace {

using glm::dmat3;
using glm::dvec3;

/// glm builds matrices from columns.
dmat3 rows(dvec3 a, dvec3 b, dvec3 c) { return glm::transpose(dmat3(a, b, c)); }

/// The chromaticity of a black body (Kim and others 2002, US patent 7024034: cubic splines).
dvec3 xyz_of_temperature(double kelvin) {
  const double t = 1000 / kelvin;
  const double x = kelvin < 4000 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910
                                 : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
  const double y = kelvin < 2222   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                   : kelvin < 4000 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                                   : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  return {x / y, 1, (1 - x - y) / y};
}

const dmat3 xyz_from_rgb = rows({0.4123908, 0.3575843, 0.1804808}, {0.2126390, 0.7151687, 0.0721923},
                                {0.0193308, 0.1191948, 0.9505322});

/// Linear colours under light of this temperature as they would be under white: Bradford's adaptation (Lam
/// 1985).
dmat3 adaptation(double kelvin) {
  const dmat3 cones_from_xyz =
      rows({0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296});
  const dvec3 from = cones_from_xyz * xyz_of_temperature(kelvin),
              to = cones_from_xyz * (xyz_from_rgb * dvec3(1));
  const dvec3 gain = to / from;
  const dmat3 scale = rows({gain.x, 0, 0}, {0, gain.y, 0}, {0, 0, gain.z});
  return glm::inverse(xyz_from_rgb) * glm::inverse(cones_from_xyz) * scale * cones_from_xyz * xyz_from_rgb;
}

double luminance(const dvec3& c) { return 0.2126390 * c.x + 0.7151687 * c.y + 0.0721923 * c.z; }

dvec3 reinhard(const dvec3& c) { return c / (1 + luminance(c)); }

dvec3 aces(const dvec3& c) { return (c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14); }

/// The curve of AgX's default contrast over its range of 16.5 stops, both 0 to 1.
double agx_curve(double x) {
  return (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
}

dvec3 agx(const dvec3& c) {
  const dmat3 inset = rows({0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                           {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                           {0.0423756549057051, 0.0784336, 0.879142973793104});
  constexpr double lowest = -12.47393, highest = 4.026069;  // stops
  dvec3 shown = inset * c;
  for (int i = 0; i < 3; ++i) {
    const double stops = std::clamp(std::log2(std::max(shown[i], 1e-10)), lowest, highest);
    shown[i] = agx_curve((stops - lowest) / (highest - lowest));
  }
  shown = glm::max(glm::inverse(inset) * shown, dvec3(0));
  return glm::pow(shown, dvec3(2.2));  // the curve's values are those of a screen
}

dvec3 curved(ToneCurve curve, const dvec3& c) {
  switch (curve) {
    case ToneCurve::none:
      return c;
    case ToneCurve::reinhard:
      return reinhard(c);
    case ToneCurve::aces:
      return aces(c);
    case ToneCurve::agx:
      return agx(c);
  }
  return c;
}

bool finite(const dvec3& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

}  // namespace

void apply(const ToneMap& map, Image& image) {
  if (map.curve == ToneCurve::none && map.exposure == 0 && map.white_balance == 0) return;
  dmat3 linear(std::exp2(map.exposure));
  if (map.white_balance > 0) linear = adaptation(map.white_balance) * linear;
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i + 2 < image.data.size(); i += channels) {
    const dvec3 rendered(image.data[i], image.data[i + 1], image.data[i + 2]);
    if (!finite(rendered)) continue;
    const dvec3 shown = curved(map.curve, glm::max(linear * rendered, dvec3(0)));
    for (std::size_t k = 0; k < 3; ++k) image.data[i + k] = static_cast<float>(shown[static_cast<int>(k)]);
  }
}

}  // namespace sundog
