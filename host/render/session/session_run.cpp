// Start and end of a session, and frames that it renders to their end.
#include "render/session/final_frame.h"
#include "render/session/session_state.h"

namespace sundog {
namespace {

// Time for a driver to return from a launch when the session ends.
constexpr std::chrono::seconds ending_grace{10};

}  // namespace

void RenderSession::State::begin(const TileServers& servers) {
  for (const auto& server : servers) add_worker(server);
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
  std::vector<std::shared_ptr<Worker>> all = workers;
  all.insert(all.end(), leaving.begin(), leaving.end());
  for (const auto& worker : all) {
    std::unique_lock lock(mutex);
    const auto gone = [&] { return worker->gone || worker->abandoned; };
    changed.wait_for(lock, worker->opening && worker->server->compiles() ? look_again : ending_grace, gone);
    const bool joins = worker->gone;
    lock.unlock();
    if (joins)
      worker->thread.thread.join();
    else
      leave_thread(worker->server->info().threads, std::move(worker->thread));
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
  TileServers servers;
  for (const Frame::Server& server : frame->servers) servers.push_back(server.server);
  session->begin(servers);
  const auto mine = std::make_shared<SessionFrame>();
  mine->frame = frame;
  mine->final = mine->closes = true;
  session->run(mine, wait);
  {
    const std::lock_guard lock(session->mutex);
    for (std::size_t i = 0; i < frame->servers.size(); ++i)
      session->workers[i]->abandoned = frame->servers[i].report.abandoned;
  }
  session->end();
}

}  // namespace sundog
