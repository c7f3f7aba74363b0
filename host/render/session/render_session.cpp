// See render_session.h. Locks: a frame's mutex may be held when the session's is taken, never the other way.
#include "render/session/render_session.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "render/device/device_server.h"
#include "render/session/session_frame.h"

namespace sundog {
namespace {

using Servers = std::vector<std::shared_ptr<SceneServer>>;

// How often a frame in hand is looked at for drivers that hang.
constexpr std::chrono::milliseconds look_again{50};
// What a driver gets to come back from a launch when the session ends.
constexpr std::chrono::seconds ending_grace{10};

Servers make_servers(const std::vector<DeviceInfo>& devices) {
  if (devices.empty()) throw DeviceError("no device to render on");
  Servers servers;
  for (const DeviceInfo& device : devices)
    servers.push_back(std::make_shared<DeviceServer>(device, nullptr, RenderOptions{}));
  return servers;
}

CompileWork difference(const CompileWork& now, const CompileWork& before) {
  return {now.meshes - before.meshes,     now.bvhs - before.bvhs,     now.lights - before.lights,
          now.surfaces - before.surfaces, now.fields - before.fields, now.instances - before.instances};
}

bool is_at_rest(SessionState state) {
  return state == SessionState::settled || state == SessionState::stopped || state == SessionState::failed;
}

Picked picked_from(const TileResult& made) {
  const float4 *a = made.aovs.data(), *b = a + 1, *c = a + 2;
  Picked picked;
  picked.object = static_cast<int>(b->w);
  picked.material = static_cast<int>(c->w);
  picked.position = {b->x, b->y, b->z};
  picked.normal = {a->x, a->y, a->z};
  picked.depth = a->w;
  return picked;
}

/// One ray through the middle of a pixel.
Picked pick_on(SceneServer& server, int x, int y) {
  TileRequest request;
  request.tile = {x, y, 1, 1};
  request.in_pass = request.surfaces = true;
  server.prepare_surfaces();
  return picked_from(server.render(request, {}));
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

struct RenderSession::State : std::enable_shared_from_this<RenderSession::State> {
  struct Order {
    Generation generation = 0;
    std::shared_ptr<const SceneDescription> scene;
    SessionSettings settings;
    Stopwatch clock;
  };
  struct Worker {
    std::shared_ptr<SceneServer> server;
    std::thread thread;
    std::shared_ptr<SessionFrame> seen;  // the last frame that it took part in
    bool opening = false;                // it may be in a driver's compiler
    bool leave = false, gone = false;
  };
  struct Pick {
    Generation generation = 0;
    int x = 0, y = 0;
    std::promise<std::optional<Picked>> answer;
  };

  mutable std::mutex mutex;
  mutable std::condition_variable changed;
  std::uint64_t revision = 0;
  Generation newest = 0;
  SessionState state = SessionState::idle;
  std::string error;
  std::optional<Order> pending;
  std::shared_ptr<SessionFrame> current, shown;
  std::vector<std::shared_ptr<Worker>> workers;
  std::vector<std::shared_ptr<Worker>> leaving;
  std::deque<Pick> picks;
  double pixel_seconds = 0;
  bool closing = false;
  std::thread control;
  SceneCompiler compiler;  // the control thread's

  mutable std::mutex picture_mutex;
  mutable std::shared_ptr<const Image> picture;
  mutable std::weak_ptr<const Frame> picture_frame;
  mutable std::uint64_t picture_passes = 0, picture_pixels = 0;

  void note() {
    ++revision;
    changed.notify_all();
  }
  void set_state(SessionState next) {
    state = next;
    note();
  }

  void add_worker(std::shared_ptr<SceneServer> server);
  void run_control();
  void take_order(std::unique_lock<std::mutex>& lock);
  std::shared_ptr<SessionFrame> prepare(const Order& order, Servers servers, double speed);
  void look_at(std::unique_lock<std::mutex>& lock);
  void run_worker(Worker& worker);
  void serve(std::unique_lock<std::mutex>& lock, Worker& worker, std::size_t index);
  void serve_pick(std::unique_lock<std::mutex>& lock, Worker& worker);
  bool may_pick(const Worker& worker) const {
    return !picks.empty() && worker.seen == current && worker.server->is_open();
  }
  std::optional<std::size_t> index_of(const Worker& worker) const;
  void note_progress(const std::shared_ptr<SessionFrame>& frame);
  /// The frame in hand may bring its first picture before a newer one takes its place.
  bool is_awaited() const {
    return current && !current->frame->stop && current->times.first < 0 && current->times.settled < 0 &&
           current->begun.seconds() < current->patience;
  }
  void answer_picks(const std::shared_ptr<TileServer>& server);
  void drop_frame();
  void drop_picks();
  std::shared_ptr<const Image> picture_so_far(const Frame& frame) const;
};

void RenderSession::State::add_worker(std::shared_ptr<SceneServer> server) {
  auto worker = std::make_shared<Worker>();
  worker->server = std::move(server);
  workers.push_back(worker);
  count_left_behind(1);
  worker->thread = std::thread([self = shared_from_this(), worker]() mutable {
    self->run_worker(*worker);
    worker.reset();
    self.reset();
    count_left_behind(-1);
  });
}

/// What is in hand is of no use any more. The caller holds the mutex.
void RenderSession::State::drop_frame() {
  if (!current) return;
  current->frame->stop = true;
  current->frame->queue.close();
}

void RenderSession::State::drop_picks() {
  for (Pick& pick : picks) pick.answer.set_value(std::nullopt);
  picks.clear();
}

std::optional<std::size_t> RenderSession::State::index_of(const Worker& worker) const {
  if (!current) return std::nullopt;
  const auto& servers = current->frame->servers;
  for (std::size_t i = 0; i < servers.size(); ++i)
    if (servers[i].server == worker.server) return i;
  return std::nullopt;
}

// The control thread: compiles the newest scene and watches the frame in hand.

void RenderSession::State::run_control() {
  std::unique_lock lock(mutex);
  while (!closing) {
    const auto wanted = [&] { return closing || (pending && !is_awaited()); };
    if (current && (pending || !is_at_rest(state)))
      changed.wait_for(lock, look_again, wanted);
    else
      changed.wait(lock, wanted);
    if (closing) return;
    if (wanted())
      take_order(lock);
    else if (!pending)
      look_at(lock);
  }
}

void RenderSession::State::take_order(std::unique_lock<std::mutex>& lock) {
  const Order order = std::move(*pending);
  pending.reset();
  drop_frame();
  Servers servers;
  for (const auto& worker : workers) servers.push_back(worker->server);
  const double speed = pixel_seconds;
  lock.unlock();
  std::shared_ptr<SessionFrame> made;
  std::string failure;
  try {
    made = prepare(order, std::move(servers), speed);
  } catch (const std::exception& thrown) {
    failure = thrown.what();
  }
  lock.lock();
  if (order.generation != newest || is_at_rest(state)) return;  // replaced, or cancelled
  if (!made) {
    error = failure;
    drop_picks();
    set_state(SessionState::failed);
    return;
  }
  current = std::move(made);
  current->times.compiled = order.clock.seconds();
  set_state(SessionState::preparing);
}

std::shared_ptr<SessionFrame> RenderSession::State::prepare(const Order& order, Servers servers,
                                                            double speed) {
  auto made = std::make_shared<SessionFrame>();
  made->generation = order.generation;
  made->scene = order.scene;
  made->clock = order.clock;
  made->patience = order.settings.patience;
  const CompileWork before = compiler.work();
  made->flat = std::make_shared<const CompiledScene>(compiler.compile(*order.scene));
  made->compiled = difference(compiler.work(), before);
  const std::weak_ptr<State> session = weak_from_this();
  const std::weak_ptr<SessionFrame> frame = made;
  made->frame = make_session_frame({made->flat, order.settings, std::move(servers), speed},
                                   [session, frame](const RenderProgress&) {
                                     const auto self = session.lock();
                                     const auto mine = frame.lock();
                                     if (self && mine) self->note_progress(mine);
                                   });
  made->frame->between_tiles = [session, frame](std::size_t i) {
    const auto self = session.lock();
    const auto mine = frame.lock();
    if (self && mine) self->answer_picks(mine->frame->servers[i].server);
  };
  return made;
}

/// Called by a worker between two tiles.
void RenderSession::State::answer_picks(const std::shared_ptr<TileServer>& server) {
  std::unique_lock lock(mutex);
  if (picks.empty()) return;
  const auto found =
      std::ranges::find_if(workers, [&](const auto& worker) { return worker->server == server; });
  if (found == workers.end()) return;
  const std::shared_ptr<Worker> worker = *found;
  if (may_pick(*worker)) serve_pick(lock, *worker);
}

/// Ends the generation when nobody is left who could draw it.
void RenderSession::State::look_at(std::unique_lock<std::mutex>& lock) {
  const std::shared_ptr<SessionFrame> mine = current;
  lock.unlock();
  Frame& frame = *mine->frame;
  for (std::size_t i = 0; i < frame.servers.size(); ++i)
    if (const double seconds = frame.servers[i].server->overdue(); seconds > 0) {
      const std::string why = frame.servers[i].server->info().label() +
                              ": a launch has not come back for too long: the driver hangs";
      retire_server(frame, i, why, std::make_exception_ptr(DeviceError(why)));
    }
  std::string failure;
  {
    const std::lock_guard frame_lock(frame.mutex);
    if (!frame.servers.empty() && std::ranges::all_of(frame.servers, &Frame::Server::failed))
      for (const Frame::Server& server : frame.servers)
        failure += (failure.empty() ? "" : "; ") + server.report.messages.back();
  }
  lock.lock();
  if (failure.empty() || mine != current || mine->generation != newest || is_at_rest(state)) return;
  error = failure;
  drop_picks();
  set_state(SessionState::failed);
}

// The workers' threads.

void RenderSession::State::run_worker(Worker& worker) {
  std::unique_lock lock(mutex);
  while (true) {
    const auto wanted = [&] {
      return closing || worker.leave || (current && current != worker.seen && index_of(worker)) ||
             may_pick(worker);
    };
    changed.wait(lock, wanted);
    if (closing || worker.leave) break;
    const std::optional<std::size_t> index = index_of(worker);
    if (current != worker.seen && index)
      serve(lock, worker, *index);
    else
      serve_pick(lock, worker);
  }
  worker.opening = false;
  lock.unlock();
  try {
    worker.server->close();
  } catch (const std::exception&) {
    // It is let go of as well as can be.
  }
  lock.lock();
  worker.gone = true;
  changed.notify_all();
}

void RenderSession::State::serve(std::unique_lock<std::mutex>& lock, Worker& worker, std::size_t index) {
  const std::shared_ptr<SessionFrame> mine = current;
  const std::shared_ptr<SessionFrame> before = std::exchange(worker.seen, mine);
  worker.opening = true;
  lock.unlock();
  Frame& frame = *mine->frame;
  worker.server->show(mine->flat, frame.options);
  serve_frame(frame, index);
  double speed = 0;
  {
    const std::lock_guard frame_lock(frame.mutex);
    speed = frame.passes->pixel_seconds;
  }
  lock.lock();
  worker.opening = false;
  if (speed > 0) pixel_seconds = speed;
  note();
}

void RenderSession::State::serve_pick(std::unique_lock<std::mutex>& lock, Worker& worker) {
  Pick pick = std::move(picks.front());
  picks.pop_front();
  lock.unlock();
  try {
    pick.answer.set_value(pick_on(*worker.server, pick.x, pick.y));
  } catch (const std::exception&) {
    pick.answer.set_exception(std::current_exception());
  }
  lock.lock();
}

/// Called by a worker that has put a tile into the frame, whose mutex it holds.
void RenderSession::State::note_progress(const std::shared_ptr<SessionFrame>& mine) {
  const FrameProgress progress = progress_of(*mine->frame);
  const std::lock_guard lock(mutex);
  if (mine != current || is_at_rest(state)) return;
  const double now = mine->clock.seconds();
  SessionTimes& times = mine->times;
  const auto reached = [&](bool there, double& time) {
    if (there && time < 0) time = now;
  };
  reached(true, times.ready);
  reached(progress.whole, times.first);
  reached(progress.full, times.full);
  reached(progress.settled, times.settled);
  if (progress.whole) shown = mine;
  if (mine->generation != newest) return note();
  set_state(progress.settled ? SessionState::settled : SessionState::drawing);
}

/// The caller holds the frame's mutex. Developed once, however many ask.
std::shared_ptr<const Image> RenderSession::State::picture_so_far(const Frame& frame) const {
  const std::lock_guard lock(picture_mutex);
  const FramePasses& passes = *frame.passes;
  const std::uint64_t count = passes.coarse_passes + std::uint64_t{passes.film.stage};
  const bool same = picture && picture_frame.lock().get() == &frame && picture_passes == count &&
                    picture_pixels == frame.pixels_done;
  if (same) return picture;
  picture = std::make_shared<const Image>(picture_of(frame));
  picture_frame = frame.weak_from_this();
  picture_passes = count;
  picture_pixels = frame.pixels_done;
  return picture;
}

// The public face.

RenderSession::RenderSession(const std::vector<DeviceInfo>& devices) : RenderSession(make_servers(devices)) {}

RenderSession::RenderSession(std::vector<std::shared_ptr<SceneServer>> servers)
    : state_(std::make_shared<State>()) {
  for (auto& server : servers) state_->add_worker(std::move(server));
  state_->control = std::thread([self = state_] { self->run_control(); });
}

RenderSession::~RenderSession() {
  State& s = *state_;
  {
    const std::lock_guard lock(s.mutex);
    s.closing = true;
    s.drop_frame();
    s.drop_picks();
    s.note();
  }
  s.control.join();
  std::vector<std::shared_ptr<State::Worker>> all = s.workers;
  all.insert(all.end(), s.leaving.begin(), s.leaving.end());
  for (const auto& worker : all) {
    std::unique_lock lock(s.mutex);
    const auto gone = [&] { return worker->gone; };
    s.changed.wait_for(lock, worker->opening && worker->server->compiles() ? look_again : ending_grace, gone);
    const bool joins = worker->gone;
    lock.unlock();
    if (joins)
      worker->thread.join();
    else
      worker->thread.detach();
  }
}

Generation RenderSession::start(std::shared_ptr<const SceneDescription> scene,
                                const SessionSettings& settings) {
  State& s = *state_;
  const std::lock_guard lock(s.mutex);
  s.pending = State::Order{++s.newest, std::move(scene), settings, Stopwatch()};
  if (is_at_rest(s.state) || !s.is_awaited()) s.drop_frame();
  s.drop_picks();
  s.error.clear();
  s.set_state(SessionState::compiling);
  return s.newest;
}

void RenderSession::cancel() {
  State& s = *state_;
  const std::lock_guard lock(s.mutex);
  s.pending.reset();
  if (s.state == SessionState::idle || is_at_rest(s.state)) return;
  s.drop_frame();
  s.drop_picks();
  s.set_state(SessionState::stopped);
}

void RenderSession::use_devices(const std::vector<DeviceInfo>& devices) {
  Servers servers = make_servers(devices);
  State& s = *state_;
  const std::lock_guard lock(s.mutex);
  std::vector<std::shared_ptr<State::Worker>> before = std::exchange(s.workers, {});
  for (std::shared_ptr<SceneServer>& server : servers) {
    const auto same = std::ranges::find_if(before, [&](const auto& worker) {
      return worker && worker->server->info().label() == server->info().label();
    });
    if (same == before.end())
      s.add_worker(std::move(server));
    else
      s.workers.push_back(std::exchange(*same, nullptr));
  }
  for (const auto& worker : before)
    if (worker) {
      worker->leave = true;
      s.leaving.push_back(worker);
    }
  s.note();
}

Snapshot RenderSession::snapshot(bool with_picture) const {
  const State& s = *state_;
  Snapshot snapshot;
  std::shared_ptr<SessionFrame> current, shown;
  {
    const std::lock_guard lock(s.mutex);
    snapshot.generation = s.newest;
    snapshot.revision = s.revision;
    snapshot.state = s.state;
    snapshot.error = s.error;
    current = s.current;
    shown = s.shown;
    const std::shared_ptr<SessionFrame>& times = current && current->generation == s.newest ? current : shown;
    if (times) snapshot.times = times->times;
  }
  if (current) {
    const Frame& frame = *current->frame;
    const std::lock_guard lock(current->frame->mutex);
    snapshot.devices = activity_of(frame, is_at_rest(snapshot.state));
    snapshot.work.compiled = current->compiled;
    for (const Frame::Server& server : frame.servers) {
      snapshot.work.tables_uploaded += server.report.tables_uploaded;
      snapshot.work.bytes_uploaded += server.report.bytes_uploaded;
      snapshot.work.kernels_built += server.report.kernels_built;
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
  snapshot.seconds = progress.settled ? snapshot.times.settled : shown->clock.seconds();
  if (with_picture) snapshot.picture = s.picture_so_far(frame);
  return snapshot;
}

void RenderSession::wait() const {
  std::unique_lock lock(state_->mutex);
  state_->changed.wait(lock, [&] { return state_->newest == 0 || is_at_rest(state_->state); });
}

bool RenderSession::wait_for(double seconds) const {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                  [&] { return state_->newest == 0 || is_at_rest(state_->state); });
}

bool RenderSession::wait_for_change(std::uint64_t revision, double seconds) const {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, std::chrono::duration<double>(seconds),
                                  [&] { return state_->revision != revision; });
}

std::optional<Picked> RenderSession::pick(int x, int y) {
  State& s = *state_;
  std::future<std::optional<Picked>> answer;
  {
    std::unique_lock lock(s.mutex);
    const Generation mine = s.newest;
    s.changed.wait(lock, [&] {
      return s.closing || s.newest != mine || is_at_rest(s.state) || s.state == SessionState::idle ||
             (s.current && s.current->generation == mine);
    });
    if (s.newest != mine || !s.current || s.current->generation != mine || s.state == SessionState::failed)
      return std::nullopt;
    const SceneInfo& info = s.current->flat->info;
    if (x < 0 || y < 0 || x >= static_cast<int>(info.width) || y >= static_cast<int>(info.height))
      return std::nullopt;
    s.picks.push_back({mine, x, y, {}});
    answer = s.picks.back().answer.get_future();
    s.note();
  }
  return answer.get();
}

}  // namespace sundog
