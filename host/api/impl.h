// Internals of the public handles, and conversions from public to host values.
#pragma once
#include "api/core.h"
// Public headers must follow the host's.
#include <sundog/error.h>
#include <sundog/render.h>
#include <sundog/scene.h>

#include <cfenv>
#include <mutex>

/// Hides a class nested in a public class from programs.
#define SUNDOG_LOCAL __attribute__((visibility("hidden")))

namespace sundog {
inline namespace v0 {

/// The version, "0.2.0".
const char* version_text() noexcept;

/// The file name in messages about scenes without a file.
inline constexpr const char* no_file = "(scene)";

/// Rethrows the current exception as an Error; exceptions of callbacks stay as they are.
[[noreturn]] void throw_public();

/// Sets default rounding and no floating-point traps during its lifetime; threads started meanwhile inherit
/// them. The calling program may use other settings, which are restored.
class UsualArithmetic {
 public:
  UsualArithmetic() noexcept {
    std::fegetenv(&programs_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~UsualArithmetic() { std::fesetenv(&programs_); }
  UsualArithmetic(const UsualArithmetic&) = delete;
  UsualArithmetic& operator=(const UsualArithmetic&) = delete;

 private:
  std::fenv_t programs_;
};

/// Calls f() and turns the host's exceptions into Errors.
template <class F>
auto translated(const F& f) -> decltype(f()) {
  const UsualArithmetic arithmetic;
  try {
    return f();
  } catch (...) {
    throw_public();
  }
}

struct SUNDOG_LOCAL Image::Impl {
  std::shared_ptr<const core::Image> image;  // never null
};

struct SUNDOG_LOCAL Device::Handle {
  DeviceInfo info;
};

/// Call before using threads of the library or of a driver. Throws UsageError in a child of fork() if its
/// parent used such threads: the child lacks them and would wait forever for their locks.
void enter_threads();
/// Makes exit() wait first for the threads still in drivers: a driver's compiler creates static objects as it
/// runs, and exit() would destroy these before it waits for threads_of_process().
void wait_for_threads_at_exit() noexcept;
/// Whether this process is a child of fork() as above. Call only after threads have been used.
bool is_forked() noexcept;

struct SUNDOG_LOCAL Film::Impl {
  RenderResult result;  // the image and AOVs are moved to the members below
  core::ToneMap tone_map;
  bool transparent = false;  // a PNG keeps alpha
  Image image;
  std::map<std::string, Image> aovs;
  sundog::ImageTexts texts;  // for an EXR's header
  sundog::Shot shot;
  Figures figures;
  std::vector<std::string> warnings;
};

/// The document, and its description once it is read.
struct SUNDOG_LOCAL Scene::Impl {
  nlohmann::json document;
  std::filesystem::path file;
  core::LoadOptions options;
  NamedMeshes meshes;

  Impl();
  Impl(const Impl& other);
  Impl& operator=(const Impl&) = delete;
  ~Impl() = default;

  /// Reads the document on first use. Thread-safe while nobody changes the scene. Throws SceneError.
  std::shared_ptr<const SceneDescription> describe() const;
  void forget_description();

 private:
  mutable std::mutex mutex_;
  mutable nlohmann::json described_document_;
  mutable std::shared_ptr<const SceneDescription> described_;
};

Image share(core::Image image);
Image share(std::shared_ptr<const core::Image> image);

/// The given devices, or the default one; the process owns the threads left in their drivers. Throws
/// DeviceError, UsageError.
std::vector<DeviceInfo> devices_of(const std::vector<Device>& devices);

core::WorkGroup group_of(const WorkGroup& group);

/// Throws UsageError for negative values.
int tile_of(int tile);

/// Throws UsageError with the option's name for negative values and NaN.
double seconds_of(const char* name, double seconds);

}  // namespace v0
}  // namespace sundog
