// Implements the public Session with the host's RenderSession.
#include "api/impl.h"

#include <sundog/session.h>

#include <atomic>
#include <cstdlib>
#include <set>

namespace sundog {
inline namespace v0 {

namespace {

/// The open sessions. Never destroyed, because a thread may close a session during exit().
struct OpenSessions {
  std::mutex mutex;
  std::atomic<bool> at_exit = false;
  std::set<RenderSession*> all;
};
OpenSessions& open_sessions() {
  static auto* const sessions = new OpenSessions;
  return *sessions;
}

/// Closes all sessions, so that their threads end before the static objects that they use are destroyed.
void close_sessions() {
  if (is_forked()) return;
  {
    const std::lock_guard lock(open_sessions().mutex);
    open_sessions().at_exit = true;
    for (RenderSession* session : open_sessions().all) session->close();
  }
  wait_for_threads();
}

/// Call with a picture: the driver's compiler has made its static objects by then, and the exit destroys them
/// after what is registered now.
void close_before_the_compiler() {
  [[maybe_unused]] static const int registered = std::atexit(close_sessions);
}

}  // namespace

struct SUNDOG_LOCAL Session::Impl {
  std::unique_ptr<RenderSession> session;

  explicit Impl(const std::vector<DeviceInfo>& devices) : session(std::make_unique<RenderSession>(devices)) {
    // The drivers are loaded by now, so exit() runs their handlers after this one.
    [[maybe_unused]] static const int registered = std::atexit(close_sessions);
    const std::lock_guard lock(open_sessions().mutex);
    open_sessions().all.insert(session.get());
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    // It leaks in a forked child, which lacks the session's threads, so waiting would hang; and where a
    // static object owns it, for the drivers may be gone by then.
    if (is_forked() || open_sessions().at_exit) {
      [[maybe_unused]] const auto* const left = session.release();
      return;
    }
    session->close();
    {
      const std::lock_guard lock(open_sessions().mutex);
      open_sessions().all.erase(session.get());
    }
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
    if (now.shown > 0) close_before_the_compiler();
    return result;
  });
}

void Session::wait() const {
  translated([&] { impl_->entered().wait(); });
  close_before_the_compiler();
}
bool Session::wait_for(double seconds) const {
  return translated([&] { return impl_->entered().wait_for(seconds); });
}
bool Session::wait_for_change(std::uint64_t revision, double seconds) const {
  return translated([&] { return impl_->entered().wait_for_change(revision, seconds); });
}

Image Session::finish() const {
  return translated([&] {
    impl_->entered().wait();
    close_before_the_compiler();
    core::Snapshot now = impl_->entered().snapshot();
    if (now.state == core::SessionState::failed) std::rethrow_exception(now.cause);
    return share(std::move(now.picture));
  });
}

std::optional<Pick> Session::pick(int x, int y) {
  return translated([&]() -> std::optional<Pick> {
    const auto picked = impl_->entered().pick(x, y);
    if (!picked) return std::nullopt;
    return Pick{name_of(picked->scene->objects, picked->object),
                name_of(picked->scene->materials, picked->material), values_of(picked->position),
                values_of(picked->normal), picked->depth};
  });
}

}  // namespace v0
}  // namespace sundog
