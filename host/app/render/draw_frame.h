// Compiles, renders and saves one frame of `sundog render`.
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

/// The map of the last halo that was traced, and the key of its settings.
struct KeptHalo {
  ContentKey key;
  std::shared_ptr<const HaloMap> map;
};

/// State that the frames of one run share.
struct Setup {
  const StopOnSignal& stop;
  Mailbox* job = nullptr;  // the other processes that mpirun started; null: none
  std::vector<DeviceInfo> devices;
  std::unique_ptr<RenderSession> session;  // renders frames on this process's devices; null: opened per frame
  RunProgress run = {};
  SceneCompiler compiler = {};  // keeps tables that frames share
  KeptHalo halo = {};
  KeptChannels workers{};  // worker processes of --isolate
};

/// A scene's description and its compiled tables.
struct LoadedScene {
  std::shared_ptr<const SceneDescription> description;
  std::shared_ptr<const CompiledScene> flat;
  std::optional<NextShot> next{};  // for the AOV motion
  int times = 1;                   // number of moments while the shutter is open; `flat` is the first
  std::optional<Moment> moment{};  // the first moment
  std::function<LoadedScene(int)> at_time{};  // loads the scene at another moment
};

std::vector<DeviceInfo> choose_devices(const RenderCommand& command, Mailbox* job);

/// Width and height of the image that the command writes. Throws UsageError for a region outside the scene's
/// picture.
std::pair<int, int> picture_size(const RenderCommand& command, const CompiledScene& scene);

/// The files that one frame may write.
std::vector<std::string> output_files(const RenderCommand& command);

/// Lets a signal end the process at once, because nothing needs saving before the frame begins. Does nothing
/// in a job, whose other ranks must be notified.
void stop_loses_nothing(const RenderCommand& command, const Setup& setup);

/// The options for reading the scene file.
LoadOptions load_options(const RenderCommand& command);

using LoadScene = std::function<std::shared_ptr<const SceneDescription>()>;

/// Reads the scene with `load` and compiles it.
LoadedScene load_and_compile(const RenderCommand& command, const LoadScene& load, Setup& setup,
                             TimeLedger& times);

/// A frame that the devices have rendered.
struct DrawnFrame {
  RenderCommand command;
  LoadedScene scene;  // freed when the frame is saved
  RenderResult result;
  std::string checkpoint;
  bool told = false;                  // its interruption has been reported
  std::vector<std::string> warnings;  // set by save_frame(), as are `image` and `samples`
  ImageSettings image;
  u32 samples = 0;
};

DrawnFrame draw_frame(const RenderCommand& asked, LoadedScene loaded, const Setup& setup, TimeLedger& times);

/// Writes the frame's files. `clock` started with the frame. Frees the scene before the time is taken,
/// because freeing a large scene takes time too.
void save_frame(DrawnFrame& drawn, const Stopwatch& clock, TimeLedger& times);

/// Reports a saved frame. Returns the exit status.
int end_frame(const DrawnFrame& drawn, const TimeLedger& times);

/// Draws, saves and reports the frame. Returns the exit status.
int render_one(const RenderCommand& command, LoadedScene scene, const Setup& setup, const Stopwatch& clock,
               TimeLedger& times);

}  // namespace sundog
