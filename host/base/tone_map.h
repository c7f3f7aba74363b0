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
/// aces: the output transform of ACES 1.3 for standard range (aces.h).
/// agx: Sobotka's AgX, with the matrices that Wrensch published in 2023: 16.5 stops, whose bright colours go
/// to white.
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

/// Makes of a picture what a file for screens holds: colours by `map`, if wanted dithered to 8 bits; beside
/// alpha they become straight, not those of a pixel that is covered in part.
void prepare_for_screen(Image& image, const ToneMap& map, bool dither);

}  // namespace sundog
