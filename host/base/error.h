// sundog's exceptions. Library code throws them; main() catches them once and turns them into an exit status.
// Each message is one line: the place, what was expected, what was found, the remedy.
#pragma once
#include <stdexcept>
#include <string>
#include <utility>

namespace sundog {

/// How to avoid the error; programs add it to the message in the words of their options.
enum class Remedy {
  none,
  outside_files,
  native_code,
  part,
  // For checkpoints; each can also be removed.
  start_anew,
  same_version,
  same_settings,
  in_passes,
  not_in_passes
};

/// The command line is wrong (exit 2).
struct UsageError : std::runtime_error {
  explicit UsageError(const std::string& what, Remedy remedy_ = Remedy::none)
      : std::runtime_error(what), remedy(remedy_) {}
  Remedy remedy;
};

/// The scene or a file it names is bad (exit 3). `place` is a JSON pointer, "line 12", or "byte 80".
struct SceneError : std::runtime_error {
  SceneError(std::string file_, std::string place_, std::string what_, Remedy remedy_ = Remedy::none)
      : std::runtime_error(file_ + (place_.empty() ? "" : ": " + place_) + ": " + what_),
        file(std::move(file_)),
        place(std::move(place_)),
        reason(std::move(what_)),
        remedy(remedy_) {}
  std::string file, place, reason;
  Remedy remedy;
};

/// No such device, or the device failed (exit 4). `status` is the OpenCL error code; 0: none.
struct DeviceError : std::runtime_error {
  explicit DeviceError(const std::string& what, int status_ = 0)
      : std::runtime_error(what), status(status_) {}
  int status;
};

/// A kernel did not build (exit 5). `log` is the compiler's output, with file and line.
struct BuildError : std::runtime_error {
  BuildError(const std::string& what, std::string log_) : std::runtime_error(what), log(std::move(log_)) {}
  std::string log;
};

/// A file could not be read or written (exit 1).
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
  IoError(std::string file_, std::string what_)
      : std::runtime_error(file_ + ": " + what_), file(std::move(file_)), reason(std::move(what_)) {}
  std::string file, reason;
};

}  // namespace sundog
