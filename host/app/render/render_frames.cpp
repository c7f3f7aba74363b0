// Draws one frame while the next is loaded and the previous one is saved.
#include "app/render/render_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "app/job/remote_devices.h"
#include "app/process/exit_status.h"
#include "app/process/warnings.h"
#include "app/render/frame_log.h"
#include "app/render/output_files.h"
#include "app/render/render_result.h"
#include "base/error.h"
#include "base/file.h"
#include "compile/content_key.h"
#include "compile/placing/next_shot.h"
#include "render/film/film.h"
#include "render/film/hash.h"
#include "scene/load.h"

namespace sundog {
namespace {

constexpr auto look_again = std::chrono::milliseconds(200);
constexpr std::uint64_t most_ahead = std::uint64_t{1} << 30;  // bytes of a frame that is loaded ahead
constexpr double long_frame = 10;  // drawing time per saving time beyond which nothing is saved meanwhile

/// The next frame's shot as text, for frame_key().
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

/// A hash of all that affects the frame's file.
std::string frame_key(const RenderCommand& command, const LoadedScene& scene) {
  std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {}", SUNDOG_VERSION, hash_scene(*scene.flat),
                                 KeyMaker().add(scene.description->image.tone_map).key().a, command.no_dither,
                                 command.full_floats, command.denoise, command.metadata, command.noise,
                                 command.dpi, command.color_space, command.bits);
  if (scene.times > 1)
    text += fmt::format(" {} {}", scene.times, hash_scene(*scene.at_time(scene.times - 1).flat));
  text += std::filesystem::path(command.out).extension().string();
  if (!drops_alpha(command.out))  // an EXR states both
    text += fmt::format(" {} {}", scene.description->frames_per_second, scene.description->unit);
  if (command.icc) text += " icc";
  text += command.far;
  if (command.part) text += fmt::format(" {}/{}", command.part->index, command.part->count);
  if (const auto& at = command.region)
    text += fmt::format(" {},{},{}x{}", at->x, at->y, at->width, at->height);
  for (const std::string& name : command.aovs) text += " " + name;
  if (scene.next) text += next_text(*scene.next);
  for (const Object& object : scene.description->objects) text += "\n" + object.name;  // for Cryptomatte
  for (const MaterialDescription& material : scene.description->materials) text += "\n" + material.name;
  return fmt::format("{:016x}", hash_bytes(text.data(), text.size()));
}

/// Opens the scene and reads each frame of the run, so that an invalid frame, or an output that would
/// overwrite an input, is refused before the first frame is rendered.
std::unique_ptr<SceneFrames> open_frames(const RenderCommand& command) {
  std::vector<std::string> outputs = {frame_list(command)};
  for (const int frame : command.frames)
    for (std::string& file : output_files(frame_command(command, frame))) outputs.push_back(std::move(file));
  return read_apart_from(outputs, [&] {
    auto frames = std::make_unique<SceneFrames>(command.scene, command.overrides, load_options(command));
    print_warnings(frames->check(command.frames)->warnings);
    return frames;
  });
}

enum class Outcome { rendered, kept, elsewhere };

/// A frame being loaded, drawn or saved.
struct Frame {
  explicit Frame(RenderCommand of_frame) : one(std::move(of_frame)) {}
  RenderCommand one;
  Stopwatch clock;
  TimeLedger times;
  LoadedScene scene;
  FramePicture picture;
  FrameLock lock;
  DrawnFrame drawn;
  RunProgress run;      // progress when it was drawn
  Stopwatch from_step;  // time since its last step
};
using FramePointer = std::unique_ptr<Frame>;

/// Processes up to three frames at once, so that devices do not wait for the host: while one frame is drawn,
/// the next is loaded and the previous one is saved.
class FrameRun {
 public:
  FrameRun(const RenderCommand& command, Setup& setup)
      : command_(command), setup_(setup), frames_(open_frames(command)), log_(frame_list(command)) {}

  int render() {
    print_warnings(log_.warnings());
    setup_.run.total = command_.frames.size();
    try {
      render_all();
    } catch (...) {
      settle();  // saves the frame that was drawn
      throw;
    }
    if (status_ == exit_done) tell_end();
    return status_;
  }

 private:
  void render_all() {
    bool waits = false;
    for (std::vector<int> to_do = command_.frames; !to_do.empty();) {
      std::vector<int> elsewhere;
      for (std::size_t i = 0; i < to_do.size(); ++i) {
        const Outcome outcome =
            take(to_do[i], i + 1 < to_do.size() ? std::optional(to_do[i + 1]) : std::nullopt);
        if (status_ != exit_done) return;
        if (outcome == Outcome::elsewhere) elsewhere.push_back(to_do[i]);
        if (outcome != Outcome::kept) continue;
        ++kept_, ++setup_.run.over;
        settled_ = clock_.seconds();
      }
      settle();
      if (status_ != exit_done) return;
      if (elsewhere.size() == to_do.size()) {
        if (setup_.stop.flag().load()) status_ = exit_interrupted;
        if (status_ != exit_done) return;
        if (!std::exchange(waits, true)) tell_waiting(elsewhere);
        std::this_thread::sleep_for(look_again);
      }
      to_do = std::move(elsewhere);
    }
  }

  Outcome take(int number, std::optional<int> next) {
    FrameLock lock = log_.lock(number);
    if (!lock) return Outcome::elsewhere;
    const RenderCommand one = frame_command(command_, number);
    if (!saving_.valid()) stop_loses_nothing(one, setup_);
    if (is_kept(one)) return Outcome::kept;
    FramePointer frame = loaded(number);
    frame->lock = std::move(lock);
    if (next && fits_twice(*frame) && !is_kept(frame_command(command_, *next))) {
      ahead_number_ = *next;
      ahead_ = std::async(std::launch::async, [this, next] { return load_frame(*next); });
    }
    if (log_.done(frame->picture)) return Outcome::kept;
    log_.begin(number, frame->picture);
    frame->times.waited += frame->from_step.seconds();
    const Stopwatch drawing;
    frame->drawn = draw_frame(frame->one, frame->scene, setup_, frame->times);
    const bool overlaps = next && fits_twice(*frame) && frame->drawn.result.complete &&
                          drawing.seconds() < long_frame * saving_time_;
    frame->run = setup_.run;
    ++setup_.run.over;
    frame->scene = {};
    frame->from_step = {};
    settle();
    frame->times.waited += frame->from_step.seconds();
    saving_ = std::async(overlaps ? std::launch::async : std::launch::deferred,
                         [drawn = std::move(frame)]() mutable {
                           save_frame(drawn->drawn, drawn->clock, drawn->times);
                           return std::move(drawn);
                         });
    if (!overlaps) settle();
    return Outcome::rendered;
  }

  FramePointer loaded(int number) {
    if (ahead_.valid() && ahead_number_ == number) return ahead_.get();
    ahead_ = {};  // drops a frame that another process renders
    return load_frame(number);
  }

  FramePointer load_frame(int number) {
    auto frame = std::make_unique<Frame>(frame_command(command_, number));
    const RenderCommand& one = frame->one;
    frame->scene = load(one, number, frame->times);
    if (std::ranges::count(one.aovs, motion_aov) > 0) frame->scene.next = next_of(frame->scene, number);
    const auto [width, height] = picture_size(one, *frame->scene.flat);
    frame->picture = {one.out, log_.keeps() ? frame_key(one, frame->scene) : "", width, height};
    frame->from_step = {};
    return frame;
  }

  /// Waits for the frame that is being saved, and reports it.
  void settle() {
    if (!saving_.valid()) return;
    const FramePointer frame = saving_.get();
    saving_time_ = frame->times.write;
    status_ = end_frame(frame->drawn, frame->times);
    if (status_ != exit_done) return;
    const int number = static_cast<int>(*frame->one.frame);
    if (frame->drawn.result.complete)
      log_.add(number, frame->picture);
    else
      unfinished_.push_back(number);
    ++setup_.run.rendered;
    setup_.run.seconds += clock_.seconds() - std::exchange(settled_, clock_.seconds());
    if (!command_.quiet && frame->run.over + 1 < setup_.run.total)
      fmt::print("  frame {} of {}, about {} left\n", frame->run.over + 1, setup_.run.total,
                 duration_text(setup_.run.seconds_left(0, 0)));
  }

  LoadedScene load(const RenderCommand& one, int frame, TimeLedger& times) {
    if (shutter_.open == 0) {
      const std::scoped_lock one_at_a_time(loading_);
      return load_and_compile(one, [&] { return read(one, frame); }, setup_, times);
    }
    std::int64_t seed = 0;
    LoadedScene scene = load_at(one, frame, 0, &seed, times);
    scene.times = shutter_.steps;
    scene.at_time = [this, one, frame, seed, &times](int time) mutable {
      return load_at(one, frame, time, &seed, times);
    };
    return scene;
  }

  std::shared_ptr<const SceneDescription> read(const RenderCommand& one, double frame) {
    return read_apart_from(output_files(one), [&] { return frames_->read(frame); });
  }

  /// The scene at one moment while the shutter is open, with its share of the samples and its own seed.
  /// `seed`: the frame's seed, stored at the first moment.
  LoadedScene load_at(const RenderCommand& one, int frame, int time, std::int64_t* seed, TimeLedger& times) {
    Moment moment;
    const auto read_moment = [&] {
      const auto& [open, steps] = shutter_;
      moment.frame = frame + open * (time + 0.5) / steps;
      const auto scene = read(one, moment.frame);
      if (time == 0) *seed = scene->render.seed;
      moment.seed = static_cast<int>((*seed * steps + time) & 0x7fffffff);
      moment.samples = (scene->render.samples + steps - 1) / steps;
      return at_moment(*scene, moment);
    };
    const std::scoped_lock one_at_a_time(loading_);
    LoadedScene scene = load_and_compile(one, read_moment, setup_, times);
    scene.moment = moment;
    return scene;
  }

  /// The shot one frame later. If that frame cannot be read, e.g. after the last file of a sequence, nothing
  /// moves.
  NextShot next_of(const LoadedScene& scene, int frame) {
    const std::scoped_lock one_at_a_time(loading_);
    try {
      const auto next = frames_->read((scene.moment ? scene.moment->frame : frame) + 1);
      return next_shot(*scene.description, next.get());
    } catch (const SceneError&) {
      return next_shot(*scene.description, scene.description.get());
    }
  }

  bool is_kept(const RenderCommand& one) const {
    return command_.skip_existing && holds_bytes(one.out) && !is_there(one.resume);
  }

  /// Whether the frame and its scene take less than 1 GiB, to hold two at once. Not in a job or to denoise.
  bool fits_twice(const Frame& frame) const {
    const auto pixels =
        static_cast<std::uint64_t>(frame.picture.width) * static_cast<unsigned>(frame.picture.height);
    const FrameOutput output = frame_output(frame.one, frame.scene.description->image, true);
    return !setup_.job && !command_.denoise &&
           pixels * bytes_a_pixel(output) + table_bytes(*frame.scene.flat) < most_ahead;
  }

  void tell_waiting(const std::vector<int>& frames) const {
    if (command_.quiet) return;
    fmt::print("waiting for another process with the same --resume, which renders {}\n", frames_text(frames));
    std::fflush(stdout);
  }

  void tell_end() const {
    if (command_.quiet || setup_.run.total < 2) return;
    fmt::print("{} frames in {}: {} rendered, {} were done\n", setup_.run.total,
               duration_text(clock_.seconds()), setup_.run.rendered, kept_);
    if (!unfinished_.empty())
      fmt::print("  unfinished, ended by the time limit: {}{}\n", frames_text(unfinished_),
                 command_.resume.empty() ? "" : "; the same command continues them");
  }

  const RenderCommand& command_;
  Setup& setup_;
  std::unique_ptr<SceneFrames> frames_;
  Shutter shutter_ = frames_->shutter();
  FrameLog log_;        // opened after all frames have been checked
  std::mutex loading_;  // one scene at a time
  int status_ = exit_done;
  std::size_t kept_ = 0;
  std::vector<int> unfinished_;
  Stopwatch clock_;
  double settled_ = 0;  // when the last frame was finished or skipped, by `clock_`
  double saving_time_ = 0;
  std::future<FramePointer> ahead_, saving_;  // their threads end before the members above
  int ahead_number_ = 0;
};

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
