// The public Session over the host's RenderSession.
#include "api/impl.h"

#include <sundog/session.h>

namespace sundog {
inline namespace v0 {

struct SUNDOG_LOCAL Session::Impl {
  mutable std::mutex mutex;
  std::unique_ptr<RenderSession> session;
  std::shared_ptr<const SceneDescription> newest;  // guarded by the mutex

  explicit Impl(const std::vector<DeviceInfo>& devices) : session(std::make_unique<RenderSession>(devices)) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    // A forked child lacks the session's threads, so waiting would hang: the session leaks.
    if (is_forked()) [[maybe_unused]]
      const auto* const left = session.release();
    session.reset();
    wait_for_threads_at_exit();
  }
  RenderSession& entered() const {
    enter_threads();
    return *session;
  }
};

namespace {

std::string name_of(const auto& list, int index) {
  return index >= 0 && index < std::ssize(list) ? list[static_cast<std::size_t>(index)].name : std::string();
}

Vec3 values_of(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

}  // namespace

Session::Session(const std::vector<Device>& devices)
    : impl_(translated([&] { return std::make_unique<Impl>(devices_of(devices)); })) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

std::uint64_t Session::start(const Scene& scene, const SessionOptions& options) {
  return translated([&] {
    auto description = scene.impl().describe();
    sundog::check_frame_memory(description->image.width, description->image.height,
                               {.file = {}, .aovs = {}, .passes = true});
    SessionSettings settings;
    settings.coarse = options.coarse;
    settings.patience = seconds_of("patience", options.patience);
    settings.work_group = group_of(options.work_group);
    settings.tile = tile_of(options.tile);
    std::shared_ptr<const SceneDescription>
        before;  // destroyed outside the lock: owners of its meshes may run any code
    const std::lock_guard lock(impl_->mutex);
    before = std::exchange(impl_->newest, description);
    return impl_->entered().start(std::move(description), settings);
  });
}

void Session::cancel() {
  translated([&] { impl_->entered().cancel(); });
}

void Session::use_devices(const std::vector<Device>& devices) {
  translated([&] { impl_->entered().use_devices(devices_of(devices)); });
}

Snapshot Session::snapshot(bool with_picture) const {
  return translated([&] {
    core::Snapshot now = impl_->entered().snapshot(with_picture);
    Snapshot result;
    result.generation = now.generation;
    result.shown = now.shown;
    result.revision = now.revision;
    result.state = static_cast<SessionState>(now.state);
    result.error = std::move(now.error);
    result.fraction = now.fraction;
    result.samples = now.samples;
    result.block = now.block;
    result.seconds = now.seconds;
    result.picture = share(std::move(now.picture));
    return result;
  });
}

void Session::wait() const {
  translated([&] { impl_->entered().wait(); });
}
bool Session::wait_for(double seconds) const {
  return translated([&] { return impl_->entered().wait_for(seconds); });
}
bool Session::wait_for_change(std::uint64_t revision, double seconds) const {
  return translated([&] { return impl_->entered().wait_for_change(revision, seconds); });
}

Image Session::finish() const {
  wait();
  Snapshot now = snapshot();
  if (now.state == SessionState::failed) throw Error(ErrorKind::device, now.error);
  return now.picture;
}

std::optional<Pick> Session::pick(int x, int y) {
  return translated([&]() -> std::optional<Pick> {
    std::shared_ptr<const SceneDescription> scene;
    {
      const std::lock_guard lock(impl_->mutex);
      scene = impl_->newest;
    }
    const auto picked = impl_->entered().pick(x, y);
    if (!picked) return std::nullopt;
    return Pick{name_of(scene->objects, picked->object), name_of(scene->materials, picked->material),
                values_of(picked->position), values_of(picked->normal), picked->depth};
  });
}

}  // namespace v0
}  // namespace sundog
