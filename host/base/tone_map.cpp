// Measures the exposure and adds bloom, then maps pixels in parallel: white balance, vignette, curve,
// contrast. Implements Reinhard's and AgX's curves; aces.h has the ACES curve.
#include "base/tone_map.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numeric>
#include <vector>

#include "base/colors/aces.h"
#include "base/colors/color_space.h"
#include "base/image_io.h"
#include "base/parallel.h"
#include "base/pixels/bloom.h"
#include "base/pixels/dither.h"

namespace sundog {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

/// glm builds matrices from columns.
dmat3 rows(dvec3 a, dvec3 b, dvec3 c) { return glm::transpose(dmat3(a, b, c)); }

/// The chromaticity of a black body below 4000 K, by cubic splines (Kim and others 2002, US patent 7024034).
dvec2 black_body(double kelvin) {
  const double t = 1000 / kelvin;
  const double x = ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910;
  const double y = kelvin < 2222 ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                                 : ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
  return {x, y};
}

/// The chromaticity of daylight at 4000 K or more (CIE 15:2004, 3.1).
dvec2 daylight(double kelvin) {
  const double t = 1000 / kelvin;
  const double x = kelvin < 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                 : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  return {x, (-3 * x + 2.870) * x - 0.275};
}

/// The chromaticity of white: a black body below 3500 K, daylight from 4000 K on, and a blend in between.
dvec2 white_of(double kelvin) {
  const double day = std::clamp((kelvin - 3500) / 500, 0.0, 1.0);
  return glm::mix(black_body(std::min(kelvin, 4000.0)), daylight(std::max(kelvin, 4000.0)), day);
}

/// The matrix that adapts linear colours from light of this temperature to white light.
dmat3 balance(double kelvin) {
  const dmat3 xyz = xyz_from(srgb_primaries);
  return glm::inverse(xyz) * adaptation(white_of(kelvin), srgb_primaries.white) * xyz;
}

double luminance(const dvec3& c) { return 0.2126390 * c.x + 0.7151687 * c.y + 0.0721923 * c.z; }

dvec3 reinhard(const dvec3& c) { return c / (1 + luminance(c)); }

/// AgX's sigmoid with default contrast: maps the range of 16.5 stops, as 0 to 1, to 0 to 1, with slope 2 at
/// middle grey and powers 3 (toe) and 3.25 (shoulder) (Sobotka, AgX-S2O3; Jed Smith's curve).
double agx_curve(double x) {
  constexpr double grey = 10 / 16.5, half = 0.5, slope = 2;
  const bool bright = x >= grey;
  const double power = bright ? 3.25 : 3, steep = slope * (bright ? 1 - grey : grey);
  const double scale = steep / std::pow(std::pow(steep / half, power) - 1, 1 / power);
  const double step = slope * (x - grey);
  return half + step * std::pow(1 + std::pow(std::abs(step) / scale, power), -1 / power);
}

dvec3 agx(const dvec3& c) {
  const dmat3 inset = rows({0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                           {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                           {0.0423756549057051, 0.0784336, 0.879142973793104});
  static const double lowest = std::log2(0.18) - 10, highest = std::log2(0.18) + 6.5;  // stops
  dvec3 shown = inset * c;
  for (int i = 0; i < 3; ++i) {
    const double stops = std::clamp(std::log2(std::max(shown[i], 1e-10)), lowest, highest);
    shown[i] = agx_curve((stops - lowest) / (highest - lowest));
  }
  shown = glm::max(glm::inverse(inset) * shown, dvec3(0));
  for (int i = 0; i < 3; ++i)
    shown[i] = linear_from_srgb(static_cast<float>(shown[i]));  // AgX yields encoded colours
  return shown;
}

dvec3 curved(ToneCurve curve, const dvec3& c) {
  switch (curve) {
    case ToneCurve::none:
      return c;
    case ToneCurve::reinhard:
      return reinhard(c);
    case ToneCurve::aces:
      return aces_output(c);
    case ToneCurve::agx:
      return agx(c);
  }
  return c;
}

/// Applies a curve with the slope `contrast` at 0.5 to the sRGB-encoded colours; 0 and 1 stay.
dvec3 contrasted(const dvec3& c, double contrast) {
  dvec3 shown;
  for (int i = 0; i < 3; ++i) {
    const double coded = double(srgb_from_linear(static_cast<float>(std::clamp(c[i], 0.0, 1.0))));
    const double from_end = std::pow(2 * std::min(coded, 1 - coded), contrast) / 2;
    shown[i] = double(linear_from_srgb(static_cast<float>(coded < 0.5 ? from_end : 1 - from_end)));
  }
  return shown;
}

/// The share of light that the vignette leaves; the loss is quadratic in the distance from the centre.
double vignetted(const ToneMap& map, const Image& image, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(image.width);
  const dvec2 size(image.width, image.height), place = dvec2(pixel % width, pixel / width) + 0.5 - size / 2.0;
  return 1 - map.vignette * glm::dot(place, place) / (glm::dot(size, size) / 4);
}

bool finite(const dvec3& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

}  // namespace

double automatic_exposure(const Image& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<double> stops;
  for (std::size_t i = 0; i + 2 < image.data.size(); i += channels) {
    const double light = luminance({image.data[i], image.data[i + 1], image.data[i + 2]});
    if (light > 0 && std::isfinite(light)) stops.push_back(std::log2(light));
  }
  if (stops.empty()) return 0;
  std::ranges::sort(stops);
  const auto tenth = static_cast<std::ptrdiff_t>(stops.size() / 10);
  const double sum = std::accumulate(stops.begin() + tenth, stops.end() - tenth, 0.0);
  return std::clamp(std::log2(0.18) - sum / static_cast<double>(std::ssize(stops) - 2 * tenth), -32.0, 32.0);
}

void apply(const ToneMap& map, Image& image) {
  if (map == ToneMap() || image.channels < 3) return;
  dmat3 linear(std::exp2(map.automatic ? automatic_exposure(image) : map.exposure));
  if (map.bloom > 0) add_bloom(image, map.bloom);
  if (map.white_balance > 0) linear = balance(map.white_balance) * linear;
  const auto channels = static_cast<std::size_t>(image.channels);
  in_parallel(image.data.size() / channels, [&](std::size_t pixel) {
    float* value = &image.data[pixel * channels];
    const dvec3 rendered(value[0], value[1], value[2]);
    if (!finite(rendered)) return;
    dvec3 shown = glm::max(linear * rendered, dvec3(0));
    if (map.vignette > 0) shown *= vignetted(map, image, pixel);
    shown = curved(map.curve, shown);
    if (map.contrast != 1) shown = contrasted(shown, map.contrast);
    for (int k = 0; k < 3; ++k) value[k] = static_cast<float>(shown[k]);
  });
}

void prepare_for_screen(Image& image, const ToneMap& map, bool dither) {
  if (image.channels == 4)
    for (std::size_t i = 0; i < image.data.size(); i += 4)
      for (std::size_t k = 0; k < 3; ++k)
        if (image.data[i + 3] > 0) image.data[i + k] /= image.data[i + 3];
  apply(map, image);
  if (dither) dither_to_8_bits(image);
}

}  // namespace sundog
