// Tone maps images for screens: bloom, white balance, exposure, vignette, a curve that compresses highlights,
// and contrast. Files of other formats keep the rendered values.
#pragma once
#include "base/image.h"

namespace sundog {

/// none: leaves colours unchanged; 8-bit files clip them at 1.
/// reinhard: L / (1 + L) on the luminance (Reinhard and others 2002, "Photographic Tone Reproduction for
/// Digital Images", equation 3). Never reaches white.
/// aces: the output transform of ACES 1.3 for standard range (aces.h).
/// agx: Sobotka's AgX with Wrensch's matrices (2023): a range of 16.5 stops; bright colours fade to white.
enum class ToneCurve { none, reinhard, aces, agx };

struct ToneMap {
  ToneCurve curve = ToneCurve::none;
  double exposure = 0;       // in stops: multiplies colours by 2^exposure before the curve
  double white_balance = 0;  // kelvin: light of this temperature turns white; 0: off
  bool automatic = false;    // the exposure is automatic_exposure()
  double contrast = 1;       // slope at middle grey, applied after the curve; 1: off
  double vignette = 0;       // share of light that corners lose
  double bloom = 0;          // share of light that spreads to its surroundings

  bool operator==(const ToneMap&) const = default;
};

inline constexpr double least_white = 1667, greatest_white = 25000;

/// The exposure that moves the geometric mean of luminance to middle grey (0.18), over the pixels that are
/// not black and lie between the 10th and the 90th percentile. 0 for a black picture.
double automatic_exposure(const Image& image);

/// Applies `map` to the first three channels; alpha and non-finite values are unchanged.
void apply(const ToneMap& map, Image& image);

/// Prepares a picture for a screen's file: divides colours by alpha, if there is alpha, applies `map`, and
/// optionally dithers to 8 bits.
void prepare_for_screen(Image& image, const ToneMap& map, bool dither);

}  // namespace sundog
