// `render --metadata`: what a picture is of, and what made it, as words in its file.
#pragma once
#include <ctime>

#include "app/options/options.h"
#include "base/image_io.h"
#include "render/frame/result.h"
#include "scene/description.h"

namespace sundog {

/// The time that --metadata writes: now, or SOURCE_DATE_EPOCH. Throws UsageError where that is no time.
std::time_t time_of_picture();

/// Program, scene, settings, devices and time, by the names that are usual in the command's format. The time
/// is that of SOURCE_DATE_EPOCH (seconds since 1970), where it is set, so that files can be made again to the
/// bit.
ImageTexts metadata(const RenderCommand& command, const SceneDescription& scene, const RenderResult& result);

}  // namespace sundog
