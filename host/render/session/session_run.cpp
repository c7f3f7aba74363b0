// Start and end of a session, and frames that it renders to their end.
#include "render/session/final_frame.h"
#include "render/session/session_state.h"

namespace sundog {
namespace {

// Time for a driver to return from a launch when the session ends.
constexpr std::chrono::seconds ending_grace{10};

}  // namespace

void RenderSession::State::begin(const DeviceWorkers& workers) {
  for (const auto& worker : workers) add_thread(worker);
  control = std::thread([self = shared_from_this()] { self->run_control(); });
}

void RenderSession::State::end() {
  {
    const std::lock_guard lock(mutex);
    closing = true;
    drop_frame();
    drop_picks();
    note();
  }
  control.join();
  std::vector<std::shared_ptr<DeviceThread>> all = threads;
  all.insert(all.end(), leaving.begin(), leaving.end());
  for (const auto& thread : all) {
    std::unique_lock lock(mutex);
    const auto gone = [&] { return thread->gone || thread->abandoned; };
    changed.wait_for(lock, thread->opening && thread->worker->compiles() ? look_again : ending_grace, gone);
    const bool joins = thread->gone;
    lock.unlock();
    if (joins)
      thread->driver.thread.join();
    else
      leave_thread(thread->worker->info().threads, std::move(thread->driver));
  }
}

void RenderSession::State::run(const std::shared_ptr<SessionFrame>& mine, bool wait) {
  look_for_stop(*mine->frame);
  {
    const std::lock_guard lock(mutex);
    drop_frame();
    drop_picks();
    set_pending(std::nullopt);
    error.clear();
    mine->generation = ++newest;
    retire(std::exchange(current, mine));
    set_state(SessionState::drawing);
  }
  watch_frame(*mine->frame, wait);
  const bool complete = mine->frame->queue.complete();
  const std::lock_guard lock(mutex);
  drop_picks();
  current.reset();
  if (mine->generation == newest && state == SessionState::drawing)
    set_state(complete ? SessionState::settled : SessionState::stopped);
  note();  // a start() may have come meanwhile
}

void run_frame(const std::shared_ptr<Frame>& frame, bool wait) {
  const auto session = std::make_shared<RenderSession::State>();
  DeviceWorkers workers;
  for (const Frame::Worker& worker : frame->workers) workers.push_back(worker.device);
  session->begin(workers);
  const auto mine = std::make_shared<SessionFrame>();
  mine->frame = frame;
  mine->final = mine->closes = true;
  session->run(mine, wait);
  {
    const std::lock_guard lock(session->mutex);
    for (std::size_t i = 0; i < frame->workers.size(); ++i)
      session->threads[i]->abandoned = frame->workers[i].report.abandoned;
  }
  session->end();
}

}  // namespace sundog
