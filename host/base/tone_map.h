// Tone mapping for files for screens: bloom, white balance, exposure, vignette, a curve that compresses
// highlights, and contrast. Other files keep the rendered values.
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
  bool automatic = false;    // the exposure is automatic_exposure()
  double contrast = 1;       // after the curve, 0.25..4: the slope at middle grey; 1: off
  double vignette = 0;       // the share of light that corners lose, 0..1
  double bloom = 0;          // the share of light that spreads over its surroundings, 0..1

  bool operator==(const ToneMap&) const = default;
};

inline constexpr double least_white = 1667, greatest_white = 25000;

/// The exposure at which the mean logarithm of the luminance is that of middle grey (0.18), of the pixels
/// between the tenth and the ninetieth percentile of those that are not black. 0 for a black picture.
double automatic_exposure(const Image& image);

/// Applies `map` to the first three channels; alpha and non-finite values are unchanged.
void apply(const ToneMap& map, Image& image);

/// Makes of a picture what a file for screens holds: colours by `map`, if wanted dithered to 8 bits; beside
/// alpha they become straight, not those of a pixel that is covered in part.
void prepare_for_screen(Image& image, const ToneMap& map, bool dither);

}  // namespace sundog
