// Makes the texts that `render --metadata` writes into a file: program, scene, settings, devices, time.
#pragma once
#include <ctime>

#include "app/options/options.h"
#include "base/image_io.h"
#include "render/frame/result.h"
#include "scene/description.h"

namespace sundog {

/// The time that --metadata writes: SOURCE_DATE_EPOCH (seconds since 1970) if set, else now. Throws
/// UsageError for a malformed value.
std::time_t time_of_picture();

/// Program, scene, settings, devices and time, under the names usual in the command's format. Uses
/// time_of_picture(), so that files can be reproduced to the bit.
ImageTexts metadata(const RenderCommand& command, const SceneDescription& scene, const RenderResult& result);

}  // namespace sundog
