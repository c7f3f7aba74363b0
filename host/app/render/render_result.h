// The end of a frame: saves its picture or part, reports the outcome, and determines the exit status.
#pragma once
#include <string>

#include "app/options/options.h"
#include "app/render/stats.h"
#include "base/pixels/shot.h"
#include "compile/compiled_scene.h"
#include "render/film/frame_memory.h"
#include "render/render.h"

namespace sundog {

/// The file in which --verbose shows how samples were distributed: "out.png" -> "out.samples.png".
std::string samples_file(const RenderCommand& command);

/// The outputs that determine how much memory the command's frame needs.
FrameOutput frame_output(const RenderCommand& command, const ImageSettings& image, bool passes);

/// The frame's camera, with `next` for motion.
Shot frame_shot(const RenderCommand& command, const SceneDescription& scene,
                const std::optional<NextShot>& next);

/// Writes the image or part, then removes a complete frame's checkpoint. Moves image and AOVs from `result`.
void save_result(const RenderCommand& command, const SceneDescription& scene, const CompiledScene& flat,
                 const Shot& shot, RenderResult& result, const std::string& checkpoint);

/// Writes the picture so far. Ignores failures, which are reported when the finished picture is written.
void write_so_far(const RenderCommand& command, const ImageSettings& settings, const Film& film);

/// Reports that an interrupted frame is in its checkpoint. Call before the picture is written, for which
/// mpirun may leave no time.
void tell_kept(const RenderResult& result, const std::string& checkpoint);

/// Warnings about losses, a scene without light, failed devices and an unusable checkpoint.
std::vector<std::string> warnings_of(const SceneDescription& scene, const RenderResult& result);

/// Prints the frame's statistics to stdout. `samples`: samples per pixel that the scene requests.
void tell_result(const RenderCommand& command, const ImageSettings& image, u32 samples,
                 const RenderResult& result, const TimeLedger& times);

/// The exit status of a saved frame. Reports an interruption unless it was already `told`. Throws the failure
/// of a frame for which every device failed.
int conclude(const RenderCommand& command, const RenderResult& result, bool told);

}  // namespace sundog
