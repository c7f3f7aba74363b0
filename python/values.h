// Python's values as the library's, and back.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <sundog/sundog.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace nb = nanobind;

using Pixels = nb::ndarray<nb::numpy, const float>;
using Floats3 = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Floats2 = nb::ndarray<const float, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::uint32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using PixelsIn = nb::ndarray<const float, nb::c_contig, nb::device::cpu>;

/// Python's Scene, whose edits are counted.
struct OwnScene : sundog::Scene {
  OwnScene() = default;
  OwnScene(sundog::Scene scene) : Scene(std::move(scene)) {}
  std::uint64_t edits = 0;
};

/// The image's own memory, read-only: (height, width, channels), or (height, width) for one channel.
Pixels pixels_of(const sundog::Image& image);
sundog::Image image_of(const PixelsIn& pixels);
void add_mesh(OwnScene& scene, const std::string& name, const Floats3& positions, const Indices& triangles,
              const std::optional<Floats3>& normals, const std::optional<Floats2>& uvs,
              const std::optional<Floats3>& colors);

/// json.dumps(), where numpy's values count as lists and numbers.
std::string json_of(nb::handle value);
nb::object value_of(const std::string& json);

/// A copy of a Scene, which other threads may change meanwhile, of a file by its path, or of a dict.
class SceneInUse {
 public:
  explicit SceneInUse(nb::handle value);
  /// The Scene keeps what was read for its copy, such as models, unless it has changed.
  ~SceneInUse();
  SceneInUse(const SceneInUse&) = delete;
  SceneInUse& operator=(const SceneInUse&) = delete;
  const sundog::Scene& scene() const { return copy_; }

 private:
  sundog::Scene copy_;
  nb::object owner_;
  std::uint64_t edits_ = 0;
};
/// None, a spec, a Device, or a list of these.
std::vector<sundog::Device> devices_of(nb::handle value);

/// The thread that ends the interpreter. The others leave their calls then, as by sys.exit(): later, a thread
/// that asks for the interpreter's lock is unwound, and C++ cannot be.
inline std::atomic<std::thread::id> ending;
inline std::atomic<int> calls = 0;
struct Call {
  Call() { ++calls; }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  ~Call() { --calls; }
};

/// Whether this thread is to leave: Python's error is set.
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
  std::optional<nb::gil_scoped_release> released_;  // ends before the call does
};

/// wait(seconds), for short times and without the interpreter's lock, until it returns true, for at most
/// `seconds` in all: whether it did. Ctrl-C raises.
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

/// f() in a thread of its own without the interpreter's lock, until it returns; Ctrl-C calls stop() and
/// raises.
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
  // A signal may have ended f() with an error of its own: LLVM removes a compiler's temporary files on
  // Ctrl-C.
  if (interrupted || is_interrupted()) throw nb::python_error();
  return running.get();
}
