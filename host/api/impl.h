// What the public handles hold.
#pragma once
#include "api/core.h"
// The public names come after the host's.
#include <sundog/error.h>
#include <sundog/render.h>
#include <sundog/scene.h>

#include <mutex>

/// No program sees it, though its class is public.
#define SUNDOG_LOCAL __attribute__((visibility("hidden")))

namespace sundog {
inline namespace v0 {

/// "0.1.0".
const char* version_text() noexcept;

/// Throws the exception in hand as an Error; those of a program's own callbacks as they are.
[[noreturn]] void throw_public();

/// f(), with the host's exceptions turned into Errors.
template <class F>
auto translated(const F& f) -> decltype(f()) {
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
  core::DeviceInfo info;
  std::shared_ptr<core::DriverThreads> threads;  // of all devices that were listed with it
};

/// Rows with those who own their threads.
struct SUNDOG_LOCAL HostDevices {
  std::vector<std::shared_ptr<core::DriverThreads>> threads;
  std::vector<core::DeviceInfo> infos;
};

/// Called before threads are used, the library's or a driver's. Throws UsageError in a process that was
/// forked from one that had some: it has none of them, and would wait for ever for what they hold.
void enter_threads();
/// A driver's compiler makes objects of its own while it works, which the end of the process takes away
/// before threads_of_process(): where a thread is left in a driver, it is waited for before them.
void wait_for_threads_at_exit() noexcept;
/// Whether this process is such a one. Not to be asked before any threads are used.
bool is_forked() noexcept;

struct SUNDOG_LOCAL Film::Impl {
  core::RenderResult result;  // without the image and the AOVs below
  core::ToneMap tone_map;
  bool transparent = false;  // a PNG keeps alpha
  Image image;
  std::map<std::string, Image> aovs;
  sundog::ImageTexts texts;  // of an EXR's header
  Figures figures;
  std::vector<std::string> warnings;
};

/// The document, and its description as far as it has been read.
struct SUNDOG_LOCAL Scene::Impl {
  nlohmann::json document;
  std::filesystem::path file;
  core::LoadOptions options;
  core::NamedMeshes meshes;

  Impl();
  Impl(const Impl& other);
  Impl& operator=(const Impl&) = delete;
  ~Impl() = default;

  /// Any thread, while nobody changes the scene. Throws SceneError.
  std::shared_ptr<const core::SceneDescription> describe() const;
  void forget_description();

 private:
  mutable std::mutex mutex_;
  mutable nlohmann::json described_document_;
  mutable std::shared_ptr<const core::SceneDescription> described_;
};

Image share(core::Image image);
Image share(std::shared_ptr<const core::Image> image);

/// Of the handles, or the default device, whose threads the process owns. Throws DeviceError, UsageError.
HostDevices devices_of(const std::vector<Device>& devices);

core::WorkGroup group_of(const WorkGroup& group);

/// Throws UsageError for less than 0.
int tile_of(int tile);

/// Throws UsageError, which names them, for less than 0 and for what is no number.
double seconds_of(const char* name, double seconds);

}  // namespace v0
}  // namespace sundog
