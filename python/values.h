// Converts Python's values to the library's and back, and runs calls without the interpreter's lock.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <sundog/sundog.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace nb = nanobind;

using Pixels = nb::ndarray<nb::numpy, const float>;
using Floats3 = nb::ndarray<nb::numpy, const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Floats2 = nb::ndarray<nb::numpy, const float, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<nb::numpy, const std::uint32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using PixelsIn = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;

/// A mesh's arrays, which the scenes that read them share.
struct HeldArrays {
  Floats3 positions;
  Indices triangles;
  std::optional<Floats3> normals;
  std::optional<Floats2> uvs;
  std::optional<Floats3> colors;
  mutable const HeldArrays* next = nullptr;
};

/// Python's Scene, which counts its edits and keeps what a pickle of it needs.
struct OwnScene : sundog::Scene {
  OwnScene() = default;
  OwnScene(sundog::Scene scene, std::filesystem::path files = ".", sundog::LoadOptions reading = {})
      : Scene(std::move(scene)), folder(std::move(files)), options(reading) {}
  std::uint64_t edits = 0;
  std::filesystem::path folder = ".";  // of the files in the document
  sundog::LoadOptions options{};
  std::map<std::string, std::shared_ptr<const HeldArrays>> arrays{};
};

/// A Python str. Bytes of file names that are not UTF-8 become surrogate escapes, as in Python's own
/// functions.
nb::object text_of(const std::string& text);
/// Adds sundog.Error, as which the library's errors are raised.
void add_error(nb::module_& m);

/// The image's own memory, read-only: (height, width, channels), or (height, width) for one channel.
Pixels pixels_of(const sundog::Image& image);
sundog::Image image_of(const PixelsIn& pixels);
/// A copy of a Scene, or a scene from a file's path or a dict.
OwnScene scene_of(nb::handle value);
OwnScene load_scene(const std::filesystem::path& file, const sundog::LoadOptions& options);
/// The scene as a tuple to pickle, and the scene of such a tuple.
nb::tuple state_of(const OwnScene& scene);
OwnScene scene_of_state(const nb::tuple& state);
void add_mesh(OwnScene& scene, const std::string& name, const Floats3& positions, const Indices& triangles,
              const std::optional<Floats3>& normals, const std::optional<Floats2>& uvs,
              const std::optional<Floats3>& colors);

/// json.dumps(), which writes numpy's values as lists and numbers.
std::string json_of(nb::handle value);
nb::object value_of(const std::string& json);

/// A copy of a Scene, which other threads may change meanwhile, or a scene from a file's path or a dict.
class SceneInUse {
 public:
  explicit SceneInUse(nb::handle value);
  /// Moves data that the copy has read, such as models, to the Scene, unless the Scene has been edited.
  ~SceneInUse();
  SceneInUse(const SceneInUse&) = delete;
  SceneInUse& operator=(const SceneInUse&) = delete;
  const sundog::Scene& scene() const { return copy_; }

 private:
  sundog::Scene copy_;
  nb::object owner_;
  std::uint64_t edits_ = 0;
};
/// The devices of None (an empty list), a spec, a Device, or a list of these.
std::vector<sundog::Device> devices_of(nb::handle value);

/// The thread that ends the interpreter. All others then leave their calls as by sys.exit(), because later
/// the interpreter unwinds a thread that asks for its lock, which C++ does not survive.
inline std::atomic<std::thread::id> ending;
inline std::atomic<int> calls = 0;
struct Call {
  Call() { ++calls; }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  ~Call() { --calls; }
};

/// Whether this thread must leave its call; if so, sets Python's error.
inline bool is_interrupted() {
  const std::thread::id end = ending;
  if (end == std::thread::id() || end == std::this_thread::get_id()) return PyErr_CheckSignals() != 0;
  PyErr_SetNone(PyExc_SystemExit);
  return true;
}

/// Runs a function without the interpreter's lock.
class Unlocked {
 public:
  Unlocked() {
    if (is_interrupted()) throw nb::python_error();
    released_.emplace();
  }

 private:
  Call call_;
  std::optional<nb::gil_scoped_release> released_;  // destroyed before call_
};

/// Calls wait(slice) repeatedly, without the interpreter's lock, until it returns true or `seconds` have
/// passed; returns whether it returned true. Ctrl-C raises.
template <class Wait>
bool waited(const Wait& wait, double seconds) {
  constexpr double slice = 0.02;
  const auto begun = std::chrono::steady_clock::now();
  for (;;) {
    const double left =
        seconds - std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    {
      const Unlocked unlocked;
      if (wait(std::clamp(left, 0.0, slice))) return true;
    }
    if (!(left > 0)) return false;
  }
}

/// Runs f() in a thread of its own, without the interpreter's lock, and returns its result; Ctrl-C calls
/// stop() and raises.
template <class F, class Stop>
auto interruptible(const F& f, const Stop& stop) {
  bool interrupted = false;
  const Call call;
  auto running = std::async(std::launch::async, f);
  {
    nb::gil_scoped_release release;
    while (running.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      nb::gil_scoped_acquire acquire;
      if (!interrupted && is_interrupted()) {
        interrupted = true;
        stop();
      }
    }
  }
  // The signal may also have made f() fail: on Ctrl-C, LLVM removes a compiler's temporary files.
  if (interrupted || is_interrupted()) throw nb::python_error();
  return running.get();
}
