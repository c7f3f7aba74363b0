// One generation of a session: its scene, the frame that is being made of it, and what is known of it.
// Internal to the session.
#pragma once
#include <memory>

#include "compile/scene_compiler.h"
#include "render/frame/frame_loop.h"
#include "render/session/render_session.h"

namespace sundog {

/// The scene and the frame do not change who they are; the rest is for the session's mutex.
struct SessionFrame : FrameTask {
  Generation generation = 0;
  std::shared_ptr<const SceneDescription> scene;
  Stopwatch clock;  // since start()
  Stopwatch begun;  // since it can be drawn
  SessionSettings settings;
  SessionTimes times;
  CompileWork compiled;  // for this generation
};

/// The inputs of a session's frame.
struct FrameOrder {
  std::shared_ptr<const CompiledScene> scene;
  SessionSettings settings;
  std::vector<std::shared_ptr<SceneWorker>> workers;
  double pixel_seconds = 0;            // of a pixel's sample, by the generation before; 0: not known
  std::vector<std::string> aovs = {};  // the film's, of light groups
};

/// A frame in passes: coarse ones, then those of the scene, or over its samples. Opens nothing.
std::shared_ptr<Frame> make_session_frame(const FrameOrder& order,
                                          std::function<void(const RenderProgress&)> on_progress);

/// How far a frame is. The caller holds its mutex.
struct FrameProgress {
  unsigned pass = 0, block = 1;
  bool whole = false;  // there is a picture of all of it
  bool full = false;   // each pixel has a sample of its own, or is interpolated
  bool settled = false;
};
FrameProgress progress_of(const Frame& frame);

/// The samples that each pixel has at least, and the share of all that are wanted.
struct FrameSamples {
  unsigned least = 0;
  double fraction = 0;
};
FrameSamples samples_of(const Frame& frame, unsigned wanted);

/// The picture so far; to the bit that of the film when it is settled. The caller holds the frame's mutex.
/// `balance`: factors of the light groups, where its film has them (Film::balanced_mean()).
Image picture_of(const Frame& frame, std::span<const glm::vec3> balance);

/// The activity of the frame's workers. The caller holds its mutex.
std::vector<DeviceActivity> activity_of(const Frame& frame, bool over);

}  // namespace sundog
