// Options common to the commands that write a picture.
#pragma once
#include "app/options/options.h"

namespace sundog {

class Arguments;

/// Declares --out, --format, --tone-map and so on.
void add_picture(Arguments* app, PictureOptions& picture);

/// Throws UsageError for a --format that is unknown or given without `-o -`; sets its default.
void check_format(PictureOptions& picture);

}  // namespace sundog
