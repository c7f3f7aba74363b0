// See render_frames.h.
#include "app/render/render_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>
#include <utility>

#include "app/job/remote_devices.h"
#include "app/options/output_files.h"
#include "app/process/exit_status.h"
#include "app/process/warnings.h"
#include "app/render/frame_log.h"
#include "base/error.h"
#include "base/file.h"
#include "compile/placing/next_shot.h"
#include "render/film/film.h"
#include "render/film/hash.h"
#include "scene/load.h"

namespace sundog {
namespace {

constexpr auto look_again = std::chrono::milliseconds(200);

/// The numbers of the next frame's shot.
std::string next_text(const NextShot& next) {
  std::string text;
  const auto add = [&](const glm::dmat4& matrix) {
    for (int i = 0; i < 16; ++i) text += fmt::format(" {}", matrix[i / 4][i % 4]);
  };
  add(next.world_to_ndc);
  for (const auto& [object, matrix] : next.moves) {
    text += fmt::format(" {}:", object);
    add(matrix);
  }
  for (const auto& [object, faces] : next.faces)
    text += fmt::format(" {}:{:x}", object, hash_bytes(faces.data(), faces.size() * sizeof(MovingFace)));
  return text;
}

/// All that shapes the frame's file.
std::string frame_key(const RenderCommand& command, const LoadedScene& scene) {
  const ToneMap& tone = scene.description->image.tone_map;
  std::string text = fmt::format(
      "{} {} {} {} {} {} {} {} {} {} {} {} {}", SUNDOG_VERSION, hash_scene(*scene.flat),
      static_cast<int>(tone.curve), tone.exposure, tone.white_balance, command.no_dither, command.full_floats,
      command.denoise, command.metadata, command.noise, command.dpi, command.color_space, command.bits);
  if (scene.times > 1)
    text += fmt::format(" {} {}", scene.times, hash_scene(*scene.at_time(scene.times - 1).flat));
  text += std::filesystem::path(command.out).extension().string();
  if (!drops_alpha(command.out))  // an EXR states both
    text += fmt::format(" {} {}", scene.description->frames_per_second, scene.description->unit);
  if (tone != ToneMap())
    text += fmt::format(" {} {} {} {}", tone.automatic, tone.contrast, tone.vignette, tone.bloom);
  if (command.icc) text += " icc";
  text += command.far;
  if (command.part) text += fmt::format(" {}/{}", command.part->index, command.part->count);
  if (const auto& at = command.region)
    text += fmt::format(" {},{},{}x{}", at->x, at->y, at->width, at->height);
  for (const std::string& name : command.aovs) text += " " + name;
  if (scene.next) text += next_text(*scene.next);
  for (const Object& object : scene.description->objects) text += "\n" + object.name;  // of Cryptomatte
  for (const MaterialDescription& material : scene.description->materials) text += "\n" + material.name;
  return fmt::format("{:016x}", hash_bytes(text.data(), text.size()));
}

/// Opens the scene and reads each frame of the run: one that is no scene is refused before the first is
/// rendered, and so is a file that would be written over.
std::unique_ptr<SceneFrames> open_frames(const RenderCommand& command) {
  std::vector<std::string> outputs = {frame_list(command)};
  for (const int frame : command.frames)
    for (std::string& file : output_files(frame_command(command, frame))) outputs.push_back(std::move(file));
  auto frames = std::make_unique<SceneFrames>(command.scene, command.overrides, load_options(command));
  print_warnings(load_beside(outputs, [&] { return frames->check(command.frames); })->warnings);
  return frames;
}

enum class Outcome { rendered, kept, unfinished, elsewhere };

class FrameRun {
 public:
  FrameRun(const RenderCommand& command, Setup& setup)
      : command_(command), setup_(setup), frames_(open_frames(command)), log_(frame_list(command)) {}

  int render();

 private:
  Outcome take(int frame);
  LoadedScene load(const RenderCommand& one, int frame, TimeLedger& times);
  LoadedScene load_at(const RenderCommand& one, int frame, int time, TimeLedger& times);
  NextShot next_of(const LoadedScene& scene, int frame);
  void tell_waiting(const std::vector<int>& frames) const;
  void tell_end() const;

  const RenderCommand& command_;
  Setup& setup_;
  std::unique_ptr<SceneFrames> frames_;
  Shutter shutter_ = frames_->shutter();
  FrameLog log_;           // after all frames have been checked
  std::int64_t seed_ = 0;  // of the frame
  int status_ = exit_done;
  std::size_t kept_ = 0;
  std::vector<int> unfinished_;
  Stopwatch clock_;
};

int FrameRun::render() {
  print_warnings(log_.warnings());
  setup_.run.total = command_.frames.size();
  bool waits = false;
  for (std::vector<int> to_do = command_.frames; !to_do.empty();) {
    std::vector<int> elsewhere;
    for (const int frame : to_do) {
      const Outcome outcome = take(frame);
      if (status_ != exit_done) return status_;
      if (outcome == Outcome::elsewhere) {
        elsewhere.push_back(frame);
        continue;
      }
      ++setup_.run.over;
      kept_ += outcome == Outcome::kept;
      if (outcome == Outcome::unfinished) unfinished_.push_back(frame);
    }
    if (elsewhere.size() == to_do.size()) {
      if (setup_.stop.flag().load()) return exit_interrupted;
      if (!std::exchange(waits, true)) tell_waiting(elsewhere);
      std::this_thread::sleep_for(look_again);
    }
    to_do = std::move(elsewhere);
  }
  tell_end();
  return exit_done;
}

Outcome FrameRun::take(int frame) {
  const Stopwatch clock;
  TimeLedger times;
  const RenderCommand one = frame_command(command_, frame);
  stop_loses_nothing(one, setup_);
  const FrameLock lock = log_.lock(frame);
  if (!lock) return Outcome::elsewhere;
  if (command_.skip_existing && holds_bytes(one.out) && !is_there(one.resume)) return Outcome::kept;
  LoadedScene scene = load(one, frame, times);
  if (std::ranges::count(one.aovs, motion_aov) > 0) scene.next = next_of(scene, frame);
  const auto [width, height] = picture_size(one, *scene.flat);
  const FramePicture picture{one.out, log_.keeps() ? frame_key(one, scene) : "", width, height};
  if (log_.done(picture)) return Outcome::kept;
  log_.begin(frame, picture);
  const FrameEnd end = render_one(one, scene, setup_, clock, times);
  status_ = end.status;
  if (status_ != exit_done) return Outcome::unfinished;
  if (end.complete) log_.add(frame, picture);
  ++setup_.run.rendered;
  setup_.run.seconds += clock.seconds();
  if (!command_.quiet && setup_.run.over + 1 < setup_.run.total)
    fmt::print("  frame {} of {}, about {} left\n", setup_.run.over + 1, setup_.run.total,
               duration_text(setup_.run.seconds_left(0, 0)));
  return end.complete ? Outcome::rendered : Outcome::unfinished;
}

/// The scene at one of the times while the shutter is open, with its share of the samples and a seed of its
/// own.
LoadedScene FrameRun::load_at(const RenderCommand& one, int frame, int time, TimeLedger& times) {
  Moment moment;
  const auto read = [&] {
    const auto& [open, steps] = shutter_;
    moment.frame = frame + open * (time + 0.5) / steps;
    const auto scene = frames_->read(moment.frame);
    if (time == 0) seed_ = scene->render.seed;
    moment.seed = static_cast<int>((seed_ * steps + time) & 0x7fffffff);
    moment.samples = (scene->render.samples + steps - 1) / steps;
    return at_moment(*scene, moment);
  };
  LoadedScene scene = load_and_compile(one, read, setup_, times);
  scene.moment = moment;
  return scene;
}

LoadedScene FrameRun::load(const RenderCommand& one, int frame, TimeLedger& times) {
  if (shutter_.open == 0) return load_and_compile(one, [&] { return frames_->read(frame); }, setup_, times);
  LoadedScene scene = load_at(one, frame, 0, times);
  scene.times = shutter_.steps;
  scene.at_time = [this, one, frame, &times](int time) { return load_at(one, frame, time, times); };
  return scene;
}

/// The scene a frame later. Where it cannot be read, such as behind the last file of a sequence, nothing
/// moves.
NextShot FrameRun::next_of(const LoadedScene& scene, int frame) {
  try {
    const auto next = frames_->read((scene.moment ? scene.moment->frame : frame) + 1);
    return next_shot(*scene.description, next.get());
  } catch (const SceneError&) {
    return next_shot(*scene.description, scene.description.get());
  }
}

void FrameRun::tell_waiting(const std::vector<int>& frames) const {
  if (command_.quiet) return;
  fmt::print("waiting for another process with the same --resume, which renders {}\n", frames_text(frames));
  std::fflush(stdout);
}

void FrameRun::tell_end() const {
  if (command_.quiet || setup_.run.total < 2) return;
  fmt::print("{} frames in {}: {} rendered, {} were done\n", setup_.run.total,
             duration_text(clock_.seconds()), setup_.run.rendered, kept_);
  if (!unfinished_.empty())
    fmt::print("  unfinished, ended by the time limit: {}{}\n", frames_text(unfinished_),
               command_.resume.empty() ? "" : "; the same command continues them");
}

}  // namespace

RenderCommand frame_command(const RenderCommand& command, int frame) {
  RenderCommand one = command;
  one.frame = frame;
  one.out = frame_file(command.out, frame);
  for (std::string* file : {&one.stats, &one.resume})
    if (!file->empty()) *file = frame_file(*file, frame);
  return one;
}

std::string frame_list(const RenderCommand& command) {
  return command.frames.empty() || command.resume.empty() ? "" : command.resume + ".frames";
}

int render_frames(const RenderCommand& command, Setup& setup) {
  stop_loses_nothing(frame_command(command, command.frames.front()), setup);
  return FrameRun(command, setup).render();
}

}  // namespace sundog
