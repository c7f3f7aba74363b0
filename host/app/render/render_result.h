// The end of a frame: its picture or part is saved, the outcome is reported, and it has an exit status.
#pragma once
#include <string>

#include "app/options/options.h"
#include "app/render/stats.h"
#include "base/pixels/shot.h"
#include "compile/compiled_scene.h"
#include "render/film/frame_memory.h"
#include "render/render.h"

namespace sundog {

/// Where --verbose shows how the samples were spread: "out.png" -> "out.samples.png".
std::string samples_file(const RenderCommand& command);

/// The outputs that decide how much memory the command's frame takes.
FrameOutput frame_output(const RenderCommand& command, const ImageSettings& image, bool passes);

/// The frame's camera, with `next` for motion.
Shot frame_shot(const RenderCommand& command, const SceneDescription& scene,
                const std::optional<NextShot>& next);

/// Writes the image, whole or in part, and takes the checkpoint of a whole one away: not before it is safe.
/// Image and AOVs of the result are gone afterwards.
void save_result(const RenderCommand& command, const SceneDescription& scene, const CompiledScene& flat,
                 const Shot& shot, RenderResult& result, const std::string& checkpoint);

/// Writes the picture as far as it is made; what fails is reported when the whole one is written.
void write_so_far(const RenderCommand& command, const ImageSettings& settings, const Film& film);

/// Tells of an interrupted frame that its checkpoint has it. Before the picture is written, for which mpirun
/// may leave no time.
void tell_kept(const RenderResult& result, const std::string& checkpoint);

/// Names what was lost and the devices that failed.
std::vector<std::string> warnings_of(const SceneDescription& scene, const RenderResult& result);

/// The frame's figures, on stdout; `samples`: a pixel's, as the scene asks for them.
void tell_result(const RenderCommand& command, const ImageSettings& image, u32 samples,
                 const RenderResult& result, const TimeLedger& times);

/// The exit status of a frame whose finished part has been saved. An interrupt is reported, if it was not
/// yet `told`. Throws the failure of a frame for which every device failed.
int conclude(const RenderCommand& command, const RenderResult& result, bool told);

}  // namespace sundog
