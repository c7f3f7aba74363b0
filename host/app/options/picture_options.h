// Options common to the commands that write a picture.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

/// An option that sets a key of a scene's /image/tone_map.
struct ToneOption {
  const char *key, *option, *unit, *help;
};
inline constexpr ToneOption tone_options[] = {
    {"curve", "--tone-map", "CURVE",
     "how .png and .jpg show colours brighter than white: none, reinhard, aces, agx"},
    {"exposure", "--exposure", "STOPS",
     "brighten .png and .jpg by so many stops; auto: as bright as a picture of its light should be"},
    {"white_balance", "--white-balance", "KELVIN",
     "the temperature of the light that is white in .png and .jpg"},
    {"contrast", "--contrast", "C", "of .png and .jpg after the tone map: 1 leaves it"},
    {"vignette", "--vignette", "V", "the share of light that corners of .png and .jpg lose"},
    {"bloom", "--bloom", "B", "the share of light that spreads over its surroundings in .png and .jpg"}};

/// Declares all of them.
void add_tone_options(Arguments* app, PictureOptions& picture);

/// Declares --out, --format, --tone-map and so on.
void add_picture(Arguments* app, PictureOptions& picture);

/// Throws UsageError for a --format that is unknown or given without `-o -`; sets its default.
void check_format(PictureOptions& picture);

}  // namespace sundog
