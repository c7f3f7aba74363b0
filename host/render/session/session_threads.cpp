// A session's threads: one that compiles scenes and watches the current frame, and one per device.
#include <algorithm>

#include "base/error.h"
#include "render/session/session_state.h"

namespace sundog {
namespace {

CompileWork difference(const CompileWork& now, const CompileWork& before) {
  return {now.meshes - before.meshes,     now.bvhs - before.bvhs,     now.lights - before.lights,
          now.surfaces - before.surfaces, now.fields - before.fields, now.instances - before.instances,
          now.touching - before.touching};
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

/// Casts one ray through a pixel's centre.
Picked pick_on(SceneWorker& worker, int x, int y) {
  TileRequest request;
  request.tile = {x, y, 1, 1};
  request.surfaces = true;
  worker.prepare_surfaces();
  return picked_from(worker.render(request, {}));
}

/// Ends a draft frame as soon as its own kernels are ready.
void leave_draft(Frame& frame, std::size_t index) {
  const auto* worker = dynamic_cast<const SceneWorker*>(frame.workers[index].device.get());
  if (!worker || !worker->may_end_draft()) return;
  frame.stop = true;
  frame.queue.close();
}

}  // namespace

void RenderSession::State::add_thread(std::shared_ptr<DeviceWorker> worker) {
  auto thread = std::make_shared<DeviceThread>();
  thread->of_scenes = std::dynamic_pointer_cast<SceneWorker>(worker);
  thread->worker = std::move(worker);
  threads.push_back(thread);
  thread->driver = start_thread([self = shared_from_this(), thread]() mutable {
    self->run_thread(*thread);
    thread.reset();
    self.reset();
  });
}

/// Abandons the current frame. The caller holds the mutex.
void RenderSession::State::drop_frame() {
  if (!current) return;
  current->frame->stop = true;
  current->frame->queue.close();
  for (const auto* list : {&threads, &leaving})
    for (const auto& thread : *list)
      if (thread->of_scenes) thread->of_scenes->hurry();
}

void RenderSession::State::drop_picks() {
  for (Pick& pick : picks) pick.answer.set_value(std::nullopt);
  picks.clear();
}

std::optional<std::size_t> RenderSession::State::index_of(const DeviceThread& thread) const {
  if (!current) return std::nullopt;
  const auto& workers = current->frame->workers;
  for (std::size_t i = 0; i < workers.size(); ++i)
    if (workers[i].worker == thread.worker) return i;
  return std::nullopt;
}

// The control thread: compiles the newest scene and watches the current frame.

void RenderSession::State::run_control() {
  std::unique_lock lock(mutex);
  while (!closing) {
    const auto has_order = [&] { return pending && !is_awaited() && !is_held(); };
    const auto wanted = [&] { return closing || !retired.empty() || has_order(); };
    if (current && !is_held() && (pending || !is_at_rest(state)))
      changed.wait_for(lock, look_again, wanted);
    else
      changed.wait(lock, wanted);
    free_retired(lock);
    if (closing) return;
    if (has_order())
      take_order(lock);
    else if (!pending && current && !is_held())  // a frame rendered to its end meanwhile is gone
      look_at(lock);
  }
}

void RenderSession::State::free_retired(std::unique_lock<std::mutex>& lock) {
  while (!retired.empty()) {
    std::vector<std::shared_ptr<const void>> old = std::exchange(retired, {});
    lock.unlock();
    old.clear();
    lock.lock();
  }
}

void RenderSession::State::take_order(std::unique_lock<std::mutex>& lock) {
  Order order = std::move(*pending);
  pending.reset();
  drop_frame();
  Workers workers;
  for (const auto& thread : threads) workers.push_back(thread->of_scenes);
  const double speed = pixel_seconds;
  const bool draft = order.draft != nullptr;
  std::shared_ptr<const CompiledScene> before = current ? current->flat : nullptr;
  lock.unlock();
  std::shared_ptr<SessionFrame> made;
  std::string failure;
  try {
    made = prepare(order, std::move(workers), before, speed);
  } catch (const std::exception& thrown) {
    failure = thrown.what();
  }
  lock.lock();
  retire(std::move(order.scene));
  retire(std::move(order.draft));
  retire(std::move(before));
  if (order.generation != newest || is_at_rest(state) || is_held())  // replaced, or cancelled
    return retire(std::move(made));
  if (!made) {
    error = failure;
    drop_picks();
    set_state(SessionState::failed);
    return;
  }
  retire(std::exchange(current, std::move(made)));
  if (draft) return note();
  current->times.compiled = order.clock.seconds();
  set_state(SessionState::preparing);
}

std::shared_ptr<SessionFrame> RenderSession::State::prepare(
    const Order& order, Workers workers, const std::shared_ptr<const CompiledScene>& before, double speed) {
  auto made = std::make_shared<SessionFrame>();
  made->generation = order.generation;
  made->scene = order.scene;
  made->clock = order.clock;
  made->settings = order.settings;
  const CompileWork work = compiler.work();
  made->flat = std::make_shared<const CompiledScene>(compiler.compile(*order.scene));
  made->compiled = difference(compiler.work(), work);
  SessionSettings settings = order.settings;
  if (order.draft) {
    made->compiled = order.draft->compiled;
    made->times = order.draft->times;
    settings.coarse = settings.coarse && made->times.full < 0;
  }
  const std::weak_ptr<State> session = weak_from_this();
  const std::weak_ptr<SessionFrame> frame = made;
  // Other kernels may be far slower.
  const bool known =
      before && before->features == made->flat->features && before->field_source == made->flat->field_source;
  made->frame = make_session_frame({made->flat, settings, std::move(workers), known ? speed : 0},
                                   [session, frame](const RenderProgress&) {
                                     const auto self = session.lock();
                                     const auto mine = frame.lock();
                                     if (self && mine) self->note_progress(mine);
                                   });
  made->frame->between_tiles = [session, frame](std::size_t i) {
    const auto self = session.lock();
    const auto mine = frame.lock();
    if (!self || !mine) return;
    self->answer_picks(mine->frame->workers[i].device);
    leave_draft(*mine->frame, i);
  };
  return made;
}

/// Workers call this between two tiles.
void RenderSession::State::answer_picks(const std::shared_ptr<DeviceWorker>& worker) {
  std::unique_lock lock(mutex);
  if (picks.empty()) return;
  const auto found =
      std::ranges::find_if(threads, [&](const auto& thread) { return thread->worker == worker; });
  if (found == threads.end()) return;
  // A copy: serve_pick unlocks, and then the list of threads may change.
  const std::shared_ptr<DeviceThread> thread = *found;  // NOLINT(performance-unnecessary-copy-initialization)
  if (may_pick(*thread)) serve_pick(lock, *thread);
}

/// Ends the generation if nobody is left to draw it.
void RenderSession::State::look_at(std::unique_lock<std::mutex>& lock) {
  const std::shared_ptr<SessionFrame> mine = current;
  lock.unlock();
  Frame& frame = *mine->frame;
  for (std::size_t i = 0; i < frame.workers.size(); ++i)
    if (const double seconds = frame.workers[i].device->overdue(); seconds > 0) {
      const std::string why = frame.workers[i].device->info().label() +
                              ": a launch has not come back for too long: the driver hangs";
      retire_worker(frame, i, why, std::make_exception_ptr(DeviceError(why)));
    }
  std::string failure;
  {
    const std::lock_guard frame_lock(frame.mutex);
    if (!frame.workers.empty() && std::ranges::all_of(frame.workers, &Frame::Worker::failed))
      for (const Frame::Worker& worker : frame.workers)
        failure += (failure.empty() ? "" : "; ") + worker.report.messages.back();
  }
  lock.lock();
  if (failure.empty() || mine != current || mine->generation != newest || is_at_rest(state)) return;
  error = failure;
  drop_picks();
  set_state(SessionState::failed);
}

// The threads' threads.

void RenderSession::State::run_thread(DeviceThread& thread) {
  std::unique_lock lock(mutex);
  while (true) {
    const auto wanted = [&] {
      return closing || thread.leave || (current && current != thread.seen && index_of(thread)) ||
             may_pick(thread);
    };
    changed.wait(lock, wanted);
    if (closing || thread.leave) break;
    const std::optional<std::size_t> index = index_of(thread);
    if (current != thread.seen && index)
      serve(lock, thread, *index);
    else
      serve_pick(lock, thread);
  }
  thread.opening = false;
  lock.unlock();
  try {
    if (!thread.closed) thread.worker->close();
  } catch (const std::exception&) {
    // Released as well as possible.
  }
  lock.lock();
  thread.gone = true;
  changed.notify_all();
}

void RenderSession::State::serve(std::unique_lock<std::mutex>& lock, DeviceThread& thread,
                                 std::size_t index) {
  const std::shared_ptr<SessionFrame> mine = current;
  std::shared_ptr<SessionFrame> before = std::exchange(thread.seen, mine);
  thread.opening = true;
  lock.unlock();
  Frame& frame = *mine->frame;
  if (mine->flat && thread.of_scenes) thread.of_scenes->show(mine->flat, frame.options);
  before.reset();  // outside the lock
  work_on_frame(frame, index);
  if (mine->final) leave_frame(frame, index, mine->closes);
  double speed = 0;
  const bool draft = !mine->final && thread.of_scenes->draws_draft();
  if (!mine->final) {
    const std::lock_guard frame_lock(frame.mutex);
    if (!draft) speed = frame.coarse.pixel_seconds;
    if (progress_of(frame).settled) note_progress(mine);
  }
  lock.lock();
  thread.opening = false;
  thread.closed = mine->closes;
  if (speed > 0) pixel_seconds = speed;
  note();
  if (draft) return end_draft(lock, thread, mine);
  if (mine != current || mine->final || state != SessionState::settled || !thread.of_scenes->is_open())
    return;
  lock.unlock();
  thread.of_scenes->rest();
  lock.lock();
  rested = mine->generation;
  note();
}

/// Whether a worker has drawn part of the frame as a draft. The caller holds the mutex.
bool RenderSession::State::is_draft(const std::shared_ptr<SessionFrame>& frame) const {
  return std::ranges::any_of(threads, [&](const auto& thread) {
    return thread->seen == frame && thread->of_scenes && thread->of_scenes->draws_draft();
  });
}

/// Waits for the frame's final kernels and restarts it, unless interrupted.
void RenderSession::State::end_draft(std::unique_lock<std::mutex>& lock, const DeviceThread& thread,
                                     const std::shared_ptr<SessionFrame>& mine) {
  const auto over = [&] {
    return closing || thread.leave || pending || mine != current || is_at_rest(state);
  };
  while (!over() && !thread.of_scenes->may_end_draft()) changed.wait_for(lock, look_for_kernels, over);
  if (over()) return;
  pending = Order{mine->generation, mine->scene, mine->settings, mine->clock, mine};
  note();
}

void RenderSession::State::serve_pick(std::unique_lock<std::mutex>& lock, DeviceThread& thread) {
  Pick pick = std::move(picks.front());
  picks.pop_front();
  lock.unlock();
  try {
    pick.answer.set_value(pick_on(*thread.of_scenes, pick.x, pick.y));
  } catch (const std::exception&) {
    pick.answer.set_exception(std::current_exception());
  }
  lock.lock();
}

/// Called by a thread that has added a tile to the frame, whose mutex it holds.
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
  const bool settled = progress.settled && !is_draft(mine);
  reached(settled, times.settled);
  if (progress.whole && shown != mine) retire(std::exchange(shown, mine));
  if (mine->generation != newest) return note();
  set_state(settled ? SessionState::settled : SessionState::drawing);
}

/// Developed once for all callers, who hold the frame's mutex.
std::shared_ptr<const Image> RenderSession::State::picture_so_far(const Frame& frame) const {
  const std::lock_guard lock(picture_mutex);
  const std::uint64_t count = frame.coarse.count + std::uint64_t{frame.film.stage};
  const bool same = picture && picture_frame.lock().get() == &frame && picture_passes == count &&
                    picture_pixels == frame.pixels_done;
  if (same) return picture;
  picture = std::make_shared<const Image>(picture_of(frame));
  picture_frame = frame.weak_from_this();
  picture_passes = count;
  picture_pixels = frame.pixels_done;
  return picture;
}

}  // namespace sundog
