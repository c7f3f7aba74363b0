// One frame of `sundog render`: compiled, rendered, saved.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/job/job.h"
#include "app/options/options.h"
#include "app/process/interrupt.h"
#include "app/process/progress.h"
#include "app/render/stats.h"
#include "base/pixels/shot.h"
#include "compile/content_key.h"
#include "compile/scene_compiler.h"
#include "render/remote/kept_channels.h"
#include "render/session/render_session.h"
#include "scene/load.h"

namespace sundog {

/// The map of the last halo that was traced, and what it was made of.
struct KeptHalo {
  ContentKey key;
  std::shared_ptr<const HaloMap> map;
};

/// State that the frames of one run share.
struct Setup {
  const StopOnSignal& stop;
  Mailbox* job = nullptr;  // the other processes that mpirun has started
  std::vector<DeviceInfo> devices;
  std::unique_ptr<RenderSession> session;  // of frames on this process's devices, which stay open
  RunProgress run = {};
  SceneCompiler compiler = {};  // keeps what frames have in common
  KeptHalo halo = {};
  KeptChannels workers{};  // of --isolate
};

/// A scene as it is read, and flattened.
struct LoadedScene {
  std::shared_ptr<const SceneDescription> description;
  std::shared_ptr<const CompiledScene> flat;
  std::optional<NextShot> next{};  // for the AOV motion
  int times = 1;  // at which the scene is seen while the shutter is open, `flat` at the first
  std::optional<Moment> moment{};             // the first
  std::function<LoadedScene(int)> at_time{};  // the others
};

std::vector<DeviceInfo> choose_devices(const RenderCommand& command, Mailbox* job);

/// Width and height of the file that the command writes. Throws UsageError for a region outside the scene's
/// picture.
std::pair<int, int> picture_size(const RenderCommand& command, const CompiledScene& scene);

/// The files that one frame may write.
std::vector<std::string> output_files(const RenderCommand& command);

/// Lets a signal end the process at once, because nothing is to be saved before the frame begins. Not in a
/// job, where other ranks must hear of it.
void stop_loses_nothing(const RenderCommand& command, const Setup& setup);

/// How the scene file is read.
LoadOptions load_options(const RenderCommand& command);

using LoadScene = std::function<std::shared_ptr<const SceneDescription>()>;

/// Reads the scene by `load` and compiles it.
LoadedScene load_and_compile(const RenderCommand& command, const LoadScene& load, Setup& setup,
                             TimeLedger& times);

/// A frame that the devices have rendered.
struct DrawnFrame {
  RenderCommand command;
  LoadedScene scene;  // until the frame is saved
  RenderResult result;
  std::string checkpoint;
  bool told = false;                  // that it was interrupted
  std::vector<std::string> warnings;  // once it is saved, as are its image and samples
  ImageSettings image;
  u32 samples = 0;
};

DrawnFrame draw_frame(const RenderCommand& asked, LoadedScene loaded, const Setup& setup, TimeLedger& times);

/// Writes the frame's files. `clock` began with the frame. The scene is let go before the frame's time ends:
/// freeing a large one takes its time, too.
void save_frame(DrawnFrame& drawn, const Stopwatch& clock, TimeLedger& times);

/// Reports a saved frame. Returns the exit status.
int end_frame(const DrawnFrame& drawn, const TimeLedger& times);

/// All three. Returns the exit status.
int render_one(const RenderCommand& command, LoadedScene scene, const Setup& setup, const Stopwatch& clock,
               TimeLedger& times);

}  // namespace sundog
