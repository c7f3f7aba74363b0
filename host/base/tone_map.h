// Tone mapping for 8-bit files: white balance, exposure, and a curve that compresses highlights. Other files
// keep the rendered values.
#pragma once
#include <array>

#include "base/image.h"
#include "base/named_values.h"

namespace sundog {

/// none: clips colours above 1.
/// reinhard: L / (1 + L) on the luminance (Reinhard and others 2002, "Photographic Tone Reproduction for
/// Digital Images", equation 3). Never reaches white.
/// aces: the fit of Narkowicz 2016 to the ACES output transform, each channel by itself; saturates.
/// agx: a fit of Sobotka's AgX (the polynomial and matrices that Wrensch published in 2023): 16.5 stops,
/// whose bright colours go to white.
enum class ToneCurve { none, reinhard, aces, agx };

inline constexpr std::array tone_curves = {
    NamedValue<ToneCurve>{"none", ToneCurve::none}, NamedValue<ToneCurve>{"reinhard", ToneCurve::reinhard},
    NamedValue<ToneCurve>{"aces", ToneCurve::aces}, NamedValue<ToneCurve>{"agx", ToneCurve::agx}};
inline constexpr auto tone_curve_names = names_of(tone_curves);

struct ToneMap {
  ToneCurve curve = ToneCurve::none;
  double exposure = 0;       // in stops: multiplies colours by 2^exposure before the curve
  double white_balance = 0;  // kelvin, 1667..25000: light of this temperature turns white; 0: off
};

inline constexpr double least_white = 1667, greatest_white = 25000;

/// Applies `map` to the first three channels; alpha and non-finite values are unchanged.
void apply(const ToneMap& map, Image& image);

}  // namespace sundog
