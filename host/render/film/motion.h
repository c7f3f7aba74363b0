// The AOV "motion": where each pixel's visible point is in the next frame.
#pragma once
#include "base/image_io.h"
#include "base/pixels/shot.h"
#include "render/film/film.h"

namespace sundog {

/// Replaces the AOV motion of Film::develop_aov(), if present, by each pixel's movement to the frame
/// `shot.next`, in pixels: x to the right, y up. The sky is infinitely far away. 0 where the point gets
/// behind the camera. With `region`, the AOVs show that part of the picture. Throws UsageError without
/// `shot.next`.
void find_motion(AovImages& aovs, const Shot& shot, const std::optional<Region>& region = {});

}  // namespace sundog
