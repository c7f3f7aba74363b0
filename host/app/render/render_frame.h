// One frame of `sundog render`: compiled, rendered, saved.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/options/options.h"
#include "app/process/interrupt.h"
#include "app/process/progress.h"
#include "app/render/stats.h"
#include "compile/compiled_scene.h"
#include "render/session/render_session.h"
#include "scene/load.h"

namespace sundog {

/// What the frames of one run share.
struct Setup {
  const StopOnSignal& stop;
  Mailbox* job = nullptr;  // the other processes that mpirun has started
  std::vector<DeviceInfo> devices;
  std::unique_ptr<RenderSession> session;  // of frames on this process's devices, which stay open
  RunProgress run;
};

/// A scene as it is read, and flattened.
struct LoadedScene {
  SceneDescription description;
  std::shared_ptr<const CompiledScene> flat;
};

std::vector<DeviceInfo> choose_devices(const RenderCommand& command, Mailbox* job);

/// The files that one frame may write.
std::vector<std::string> output_files(const RenderCommand& command);

/// Until the frame begins there is nothing to save. (In a job the other ranks want to be told.)
void stop_loses_nothing(const RenderCommand& command, const Setup& setup);

/// What `load` returns. An error at a place that an option changed is the command line's.
SceneDescription load_for(const RenderCommand& command, const std::vector<std::string>& outputs,
                          const std::function<SceneDescription()>& load);

/// How the scene file is read.
LoadOptions load_options(const RenderCommand& command);

/// Reads the scene by `load` and compiles it.
LoadedScene load_and_compile(const RenderCommand& command, const std::vector<std::string>& outputs,
                             const std::function<SceneDescription()>& load, Setup& setup, TimeLedger& times);

/// How a frame ended: the exit status, and whether it has all its samples.
struct FrameEnd {
  int status = 0;
  bool complete = true;
};

/// `clock` began with the frame.
FrameEnd render_one(const RenderCommand& command, const LoadedScene& scene, const Setup& setup,
                    const Stopwatch& clock, TimeLedger& times);

}  // namespace sundog
