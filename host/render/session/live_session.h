// The state of a RenderSession: its control thread compiles ordered scenes, drafts are redrawn once their
// kernels are built, picks are answered between tiles. Internal to the session.
#pragma once
#include <deque>
#include <future>
#include <thread>

#include "render/frame/frame_loop.h"
#include "render/session/session_frame.h"

namespace sundog {

using Workers = std::vector<std::shared_ptr<SceneWorker>>;

// How often a draft is checked for whether it can end.
inline constexpr std::chrono::milliseconds look_for_kernels{10};

inline bool is_at_rest(SessionState state) {
  return state == SessionState::settled || state == SessionState::stopped || state == SessionState::failed;
}

struct LiveSession : FrameLoop {
  struct Order {
    Generation generation = 0;
    std::shared_ptr<const SceneDescription> scene;
    SessionSettings settings;
    Stopwatch clock;
    std::shared_ptr<const SessionFrame> draft{};  // the draft that this order redraws
  };
  struct Pick {
    int x = 0, y = 0;
    bool taken = false;  // by a device's thread
    std::promise<std::optional<Picked>> answer;
  };

  Generation newest = 0;
  SessionState state = SessionState::idle;
  std::string error;
  std::exception_ptr cause;  // of the error
  std::optional<Order> pending;
  std::shared_ptr<SessionFrame> shown;
  std::deque<std::shared_ptr<Pick>> picks;  // those not answered
  std::vector<glm::vec3> balance;           // per light group
  std::vector<std::shared_ptr<const void>> retired;
  double pixel_seconds = 0;
  Generation rested = 0;  // the last generation after which a worker prepared for later work
  std::thread control;
  std::once_flag ended;
  SceneCompiler compiler;       // the control thread's
  std::mutex rendering;         // locked before `mutex`: one frame at a time is rendered to its end
  const void* rated = nullptr;  // the last such frame's scene, by which the threads' speeds are known

  mutable std::mutex picture_mutex;
  mutable std::shared_ptr<const Image> picture;
  mutable std::weak_ptr<const Frame> picture_frame;
  mutable std::uint64_t picture_passes = 0, picture_pixels = 0;
  mutable std::vector<glm::vec3> picture_balance;

  /// The current frame; all frames of a session are SessionFrames.
  std::shared_ptr<SessionFrame> drawn() const { return std::static_pointer_cast<SessionFrame>(current); }
  void set_state(SessionState next) {
    state = next;
    note();
  }

  /// Releases a frame or a scene. The owners of its meshes may do anything in their destructors and lock
  /// anything, so the control thread frees it later, without the mutex. The caller holds the mutex.
  void retire(std::shared_ptr<const void> old) {
    if (!old) return;
    retired.push_back(std::move(old));
    changed.notify_all();
  }
  /// Replaces the waiting order. The caller holds the mutex.
  void set_pending(std::optional<Order> next) {
    if (pending) {
      retire(std::move(pending->scene));
      retire(std::move(pending->draft));
    }
    pending = std::move(next);
  }

  void begin(const Workers& workers);
  /// Ends the threads, once; other calls wait for that.
  void end();
  /// Renders a frame to its end, replacing the current one.
  void run_final(const std::shared_ptr<SessionFrame>& mine);
  void run_control();
  void free_retired(std::unique_lock<std::mutex>& lock);
  void take_order(std::unique_lock<std::mutex>& lock);
  std::shared_ptr<SessionFrame> prepare(const Order& order, Workers workers,
                                        const std::shared_ptr<const CompiledScene>& before, double speed);
  void look_at(std::unique_lock<std::mutex>& lock);
  bool has_errand(const DeviceThread& thread) const override {
    return next_pick() && thread.of_scenes && thread.seen == current && thread.of_scenes->is_open();
  }
  void run_errand(std::unique_lock<std::mutex>& lock, DeviceThread& thread) override;
  void after_frame(std::unique_lock<std::mutex>& lock, DeviceThread& thread,
                   const std::shared_ptr<FrameTask>& task) override;
  void note_progress(const std::shared_ptr<SessionFrame>& mine);
  bool is_draft(const std::shared_ptr<SessionFrame>& frame) const;
  void end_draft(std::unique_lock<std::mutex>& lock, const DeviceThread& thread,
                 const std::shared_ptr<SessionFrame>& mine);
  /// Whether the current frame may still show its first picture before a newer frame replaces it.
  bool is_awaited() const {
    const std::shared_ptr<const SessionFrame> mine = drawn();
    return mine && !mine->final && !mine->frame->stop && mine->times.first < 0 && mine->times.settled < 0 &&
           mine->begun.seconds() < mine->settings.patience;
  }
  /// Whether the current frame is rendered to its end; then its caller releases it.
  bool is_held() const { return current && current->final; }
  void answer_picks(const std::shared_ptr<DeviceWorker>& worker);
  std::shared_ptr<Pick> next_pick() const;
  void drop_picks();
  /// Drops the picks if no thread has opened the current scene, or will. The caller holds the mutex.
  void drop_lost_picks();
  std::shared_ptr<const Image> picture_so_far(const Frame& frame, const std::vector<glm::vec3>& with) const;
};

}  // namespace sundog
