// The AOV motion: where what a pixel shows is in the next frame.
#pragma once
#include "base/image_io.h"
#include "base/pixels/shot.h"
#include "render/film/film.h"

namespace sundog {

/// Replaces the AOV motion of Film::develop_aov() by the way of each pixel to the frame `shot.next`, in
/// pixels: x to the right, y up. The sky is infinitely far. 0 where something gets behind the camera. With
/// `region` the AOVs show that part of the picture.
void find_motion(AovImages& aovs, const Shot& shot, const std::optional<Region>& region = {});

}  // namespace sundog
