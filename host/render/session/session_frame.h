// A session's frame: makes it from a compiled scene, and reads its progress, picture and workers' activity.
// Internal to the session.
#pragma once
#include <memory>

#include "compile/scene_compiler.h"
#include "render/frame/frame_loop.h"
#include "render/session/render_session.h"

namespace sundog {

/// One generation of a session. Scene and frame do not change; the session's mutex guards the rest.
struct SessionFrame : FrameTask {
  Generation generation = 0;
  std::shared_ptr<const SceneDescription> scene;
  Stopwatch clock;  // since start()
  Stopwatch begun;  // since its compilation began
  SessionSettings settings;
  SessionTimes times;
  CompileWork compiled;  // for this generation
};

/// The inputs of a session's frame.
struct FrameOrder {
  std::shared_ptr<const CompiledScene> scene;
  SessionSettings settings;
  std::vector<std::shared_ptr<SceneWorker>> workers;
  double pixel_seconds = 0;            // seconds per pixel and sample in the previous generation; 0: unknown
  std::vector<std::string> aovs = {};  // AOVs of light groups in the film
};

/// Plans a frame with a worker that stays open.
WorkerPlan plan_kept(const std::shared_ptr<DeviceWorker>& worker);

/// Makes a frame in passes: coarse passes, then the scene's own, or else passes that double the samples.
/// Opens no device.
std::shared_ptr<Frame> make_session_frame(const FrameOrder& order,
                                          std::function<void(const RenderProgress&)> on_progress);

/// A frame's progress. The caller holds its mutex.
struct FrameProgress {
  unsigned pass = 0, block = 1;
  bool whole = false;  // a picture of the whole frame exists
  bool full = false;   // each pixel has its own sample or is interpolated
  bool settled = false;
};
FrameProgress progress_of(const Frame& frame);

/// The minimum samples per pixel, and the share of all wanted samples that are taken.
struct FrameSamples {
  unsigned least = 0;
  double fraction = 0;
};
FrameSamples samples_of(const Frame& frame, unsigned wanted);

/// The picture so far; once settled, equal to the film's bit for bit. The caller holds the frame's mutex.
/// `balance`: factors of the light groups, if the film has them (Film::balanced_mean()).
Image picture_of(const Frame& frame, std::span<const glm::vec3> balance);

/// The activity of the frame's workers. The caller holds its mutex.
std::vector<DeviceActivity> activity_of(const Frame& frame, bool over);

}  // namespace sundog
