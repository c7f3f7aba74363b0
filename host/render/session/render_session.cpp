// The session's public functions, which pass orders to LiveSession and return the picture so far.
#include "render/session/render_session.h"

#include <algorithm>

#include "base/error.h"
#include "render/frame/frame.h"
#include "render/frame/local_worker.h"
#include "render/session/live_session.h"

namespace sundog {
namespace {

Workers make_workers(const std::vector<DeviceInfo>& devices) {
  if (devices.empty()) throw DeviceError("no device to render on");
  Workers workers;
  for (const DeviceInfo& device : devices)
    workers.push_back(std::make_shared<LocalWorker>(device, nullptr, RenderOptions{}));
  return workers;
}

}  // namespace

std::string state_text(SessionState state) {
  switch (state) {
    case SessionState::idle:
      return "waiting for a scene";
    case SessionState::compiling:
      return "compiling the scene";
    case SessionState::preparing:
      return "building a kernel";
    case SessionState::drawing:
      return "drawing";
    case SessionState::settled:
      return "complete";
    case SessionState::stopped:
      return "stopped";
    case SessionState::failed:
      return "failed";
  }
  return "";
}

std::string state_text(const Snapshot& now) {
  const bool waits = now.state == SessionState::drawing && now.draft && now.fraction >= 1;
  return state_text(waits ? SessionState::preparing : now.state);
}

RenderSession::RenderSession(const std::vector<DeviceInfo>& devices) : RenderSession(make_workers(devices)) {}

RenderSession::RenderSession(const std::vector<std::shared_ptr<SceneWorker>>& workers)
    : live_(std::make_shared<LiveSession>()) {
  live_->begin(workers);
}

RenderSession::~RenderSession() { close(); }

void RenderSession::close() { live_->end(); }

Generation RenderSession::start(std::shared_ptr<const SceneDescription> scene,
                                const SessionSettings& settings) {
  LiveSession& s = *live_;
  const std::lock_guard lock(s.mutex);
  ++s.newest;
  if (s.closing) {  // the process exits
    s.set_state(SessionState::stopped);
    return s.newest;
  }
  s.set_pending(LiveSession::Order{s.newest, std::move(scene), settings, Stopwatch()});
  if (is_at_rest(s.state) || !s.is_awaited()) s.drop_frame();
  s.drop_picks();
  s.error.clear();
  s.cause = nullptr;
  s.set_state(SessionState::compiling);
  return s.newest;
}

void RenderSession::set_balance(std::vector<glm::vec3> factors) {
  const std::lock_guard lock(live_->mutex);
  live_->balance = std::move(factors);
  live_->note();
}

void RenderSession::cancel() {
  LiveSession& s = *live_;
  const std::lock_guard lock(s.mutex);
  s.set_pending(std::nullopt);
  s.drop_picks();
  if (s.state == SessionState::idle || is_at_rest(s.state)) return;
  s.drop_frame();
  s.set_state(SessionState::stopped);
}

void RenderSession::use_devices(const std::vector<DeviceInfo>& devices) {
  Workers workers = make_workers(devices);
  LiveSession& s = *live_;
  const std::scoped_lock lock(s.rendering, s.mutex);
  std::vector<std::shared_ptr<DeviceThread>> before = std::exchange(s.threads, {});
  for (std::shared_ptr<SceneWorker>& worker : workers) {
    const auto same = std::ranges::find_if(before, [&](const auto& thread) {
      return thread && thread->worker->info().label() == worker->info().label();
    });
    if (same == before.end())
      s.add_thread(std::move(worker));
    else
      s.threads.push_back(std::exchange(*same, nullptr));
  }
  for (const auto& thread : before)
    if (thread) {
      thread->leave = true;
      s.leaving.push_back(thread);
    }
  s.drop_lost_picks();
  s.note();
}

Snapshot RenderSession::snapshot(bool with_picture) const {
  const LiveSession& s = *live_;
  Snapshot snapshot;
  std::shared_ptr<SessionFrame> current, shown;
  Workers workers;
  std::vector<glm::vec3> balance;
  double settled = -1;
  {
    const std::lock_guard lock(s.mutex);
    balance = s.balance;
    snapshot.generation = s.newest;
    snapshot.revision = s.revision;
    snapshot.state = s.state;
    snapshot.error = s.error;
    snapshot.cause = s.cause;
    snapshot.prepared = s.rested == s.newest && s.newest > 0;
    for (const auto& thread : s.threads) workers.push_back(thread->of_scenes);
    current = s.drawn();
    shown = s.shown;
    if (shown) settled = shown->times.settled;
    snapshot.draft = current && s.is_draft(current);
    const std::shared_ptr<SessionFrame>& times = current && current->generation == s.newest ? current : shown;
    if (times) snapshot.times = times->times;
  }
  for (const auto& worker : workers) snapshot.kernels_waiting += worker->kernels_waiting();
  snapshot.prepared = snapshot.prepared && snapshot.kernels_waiting == 0;
  if (current) {
    const Frame& frame = *current->frame;
    const std::lock_guard lock(current->frame->mutex);
    snapshot.devices = activity_of(frame, is_at_rest(snapshot.state));
    snapshot.work.compiled = current->compiled;
    for (const Frame::Worker& worker : frame.workers) {
      snapshot.work.tables_uploaded += worker.report.tables_uploaded;
      snapshot.work.bytes_uploaded += worker.report.bytes_uploaded;
      snapshot.work.kernels_built += worker.report.kernels_built;
    }
    if (current->generation == snapshot.generation)
      snapshot.fraction = samples_of(frame, current->flat->info.samples).fraction;
  }
  if (!shown) return snapshot;
  const Frame& frame = *shown->frame;
  const std::lock_guard lock(shown->frame->mutex);
  const FrameProgress progress = progress_of(frame);
  snapshot.shown = shown->generation;
  snapshot.pass = progress.pass;
  snapshot.samples = samples_of(frame, shown->flat->info.samples).least;
  snapshot.wanted_samples = shown->flat->info.samples;
  snapshot.block = progress.block;
  snapshot.counts = frame.counts;
  snapshot.seconds = settled >= 0 ? settled : shown->clock.seconds();
  if (with_picture) snapshot.picture = s.picture_so_far(frame, balance);
  return snapshot;
}

RenderResult RenderSession::render(const std::shared_ptr<const CompiledScene>& scene,
                                   const RenderOptions& options) {
  const std::lock_guard one_at_a_time(live_->rendering);
  std::vector<WorkerPlan> plans;
  std::vector<std::shared_ptr<DeviceThread>> threads;
  {
    const std::lock_guard lock(live_->mutex);
    threads = live_->threads;
  }
  // A single device makes no other wait, so an outdated speed does no harm.
  const bool comparable = threads.size() == 1 || live_->rated == scene.get();
  for (const auto& thread : threads) {
    plans.push_back(plan_kept(thread->worker));
    if (!comparable) continue;
    plans.back().pixels_a_second = thread->pixels_a_second;
    plans.back().measured_pixels = thread->measured_pixels;
  }
  const auto mine = std::make_shared<SessionFrame>();
  mine->flat = scene;
  mine->frame = begin_frame(*scene, plans, options);
  mine->final = true;
  live_->run_final(mine);
  RenderResult result = finish_frame(*mine->frame);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    const DeviceReport& report = result.devices[i];
    const bool measured = report.busy_seconds > 0;
    threads[i]->pixels_a_second = measured ? static_cast<double>(report.pixels) / report.busy_seconds : 0;
    threads[i]->measured_pixels = measured ? static_cast<double>(report.pixels) : 0;
  }
  live_->rated = scene.get();
  return result;
}

void RenderSession::wait() const {
  std::unique_lock lock(live_->mutex);
  live_->changed.wait(lock, [&] { return live_->newest == 0 || is_at_rest(live_->state); });
}

bool RenderSession::wait_for(double seconds) const {
  std::unique_lock lock(live_->mutex);
  return live_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                 [&] { return live_->newest == 0 || is_at_rest(live_->state); });
}

bool RenderSession::wait_for_change(std::uint64_t revision, double seconds) const {
  std::unique_lock lock(live_->mutex);
  return live_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                 [&] { return live_->revision != revision; });
}

std::optional<Picked> RenderSession::pick(int x, int y) {
  LiveSession& s = *live_;
  std::shared_ptr<const SceneDescription> scene;  // destroyed outside the lock
  std::future<std::optional<Picked>> answer;
  {
    std::unique_lock lock(s.mutex);
    const Generation mine = s.newest;
    s.changed.wait(lock, [&] {
      return s.closing || s.newest != mine || is_at_rest(s.state) || s.state == SessionState::idle ||
             (s.current && s.drawn()->generation == mine);
    });
    if (s.closing || s.newest != mine || !s.current || s.drawn()->generation != mine ||
        s.state == SessionState::failed)
      return std::nullopt;
    const SceneInfo& info = s.current->flat->info;
    if (x < 0 || y < 0 || x >= static_cast<int>(info.width) || y >= static_cast<int>(info.height))
      return std::nullopt;
    s.picks.push_back(std::make_shared<LiveSession::Pick>());
    s.picks.back()->x = x, s.picks.back()->y = y;
    answer = s.picks.back()->answer.get_future();
    scene = s.drawn()->scene;
    s.drop_lost_picks();
    s.note();
  }
  std::optional<Picked> picked = answer.get();
  if (picked) picked->scene = std::move(scene);
  return picked;
}

}  // namespace sundog
