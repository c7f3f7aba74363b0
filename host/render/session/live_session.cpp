// The control thread, which compiles scenes and frees replaced frames outside the lock; then the tasks of the
// device threads.
#include <algorithm>

#include "render/film/group_names.h"
#include "render/session/live_session.h"
#include "scene/integrators.h"

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

/// Whether the scene's light can be separated by light group.
bool keeps_groups(const CompiledScene& scene) {
  return integrator_of(scene.integrator).light_parts && !scene.features.caustics;
}

/// Ends a draft frame as soon as the final kernels are ready.
void leave_draft(Frame& frame, std::size_t index) {
  const auto* worker = dynamic_cast<const SceneWorker*>(frame.workers[index].device.get());
  if (!worker || !worker->may_end_draft()) return;
  frame.stop = true;
  frame.queue.close();
}

}  // namespace

void LiveSession::begin(const Workers& workers) {
  const std::lock_guard lock(mutex);
  for (const auto& worker : workers) add_thread(worker);
  control = std::thread([this, self = shared_from_this()] { run_control(); });
}

void LiveSession::end() {
  std::call_once(ended, [&] {
    {
      const std::lock_guard lock(mutex);
      closing = true;
      set_pending(std::nullopt);
      drop_frame();
      drop_picks();
      if (state != SessionState::idle && !is_at_rest(state)) set_state(SessionState::stopped);
      note();
    }
    control.join();
    FrameLoop::end();
  });
}

void LiveSession::run_final(const std::shared_ptr<SessionFrame>& mine) {
  stop_if_asked(*mine->frame);
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
  watch_frame(*mine->frame, false);
  const bool complete = mine->frame->queue.complete();
  const std::lock_guard lock(mutex);
  drop_picks();
  current.reset();
  if (mine->generation == newest && state == SessionState::drawing)
    set_state(complete ? SessionState::settled : SessionState::stopped);
  note();  // start() may have been called meanwhile
}

std::shared_ptr<LiveSession::Pick> LiveSession::next_pick() const {
  const auto next = std::ranges::find_if(picks, [](const auto& pick) { return !pick->taken; });
  return next == picks.end() ? nullptr : *next;
}

void LiveSession::drop_picks() {
  for (const auto& pick : picks) pick->answer.set_value(std::nullopt);
  picks.clear();
}

void LiveSession::drop_lost_picks() {
  const auto may_answer = [&](const auto& thread) {
    return index_of(*thread) && (thread->seen != current || thread->opening || thread->opened);
  };
  if (std::ranges::none_of(threads, may_answer)) drop_picks();
}

// The control thread: compiles the newest scene and watches the current frame.

void LiveSession::run_control() {
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
    else if (!pending && current && !is_held())  // a frame rendered to its end may have left meanwhile
      look_at(lock);
  }
}

void LiveSession::free_retired(std::unique_lock<std::mutex>& lock) {
  while (!retired.empty()) {
    std::vector<std::shared_ptr<const void>> old = std::exchange(retired, {});
    lock.unlock();
    old.clear();
    lock.lock();
  }
}

void LiveSession::take_order(std::unique_lock<std::mutex>& lock) {
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
  std::exception_ptr thrown;
  try {
    made = prepare(order, std::move(workers), before, speed);
  } catch (const std::exception& what) {
    failure = what.what();
    thrown = std::current_exception();
  }
  lock.lock();
  retire(std::move(order.scene));
  retire(std::move(order.draft));
  retire(std::move(before));
  if (order.generation != newest || is_at_rest(state) || is_held())  // replaced or cancelled
    return retire(std::move(made));
  if (!made) {
    error = failure, cause = thrown;
    drop_picks();
    set_state(SessionState::failed);
    return;
  }
  retire(std::exchange(current, std::move(made)));
  if (draft) return note();
  drawn()->times.compiled = order.clock.seconds();
  set_state(SessionState::preparing);
}

std::shared_ptr<SessionFrame> LiveSession::prepare(const Order& order, Workers workers,
                                                   const std::shared_ptr<const CompiledScene>& before,
                                                   double speed) {
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
  const std::weak_ptr<LiveSession> session = std::static_pointer_cast<LiveSession>(shared_from_this());
  const std::weak_ptr<SessionFrame> frame = made;
  // The old speed says nothing about other kernels, which may be far slower.
  const bool known =
      before && before->features == made->flat->features && before->field_source == made->flat->field_source;
  FrameOrder frame_order{made->flat, settings, std::move(workers), known ? speed : 0};
  if (settings.light_groups && keeps_groups(*made->flat))
    frame_order.aovs = with_group_numbers({light_groups_aov}, made->flat->light_groups);
  made->frame = make_session_frame(frame_order, [session, frame](const RenderProgress&) {
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

/// Called by workers between two tiles.
void LiveSession::answer_picks(const std::shared_ptr<DeviceWorker>& worker) {
  std::unique_lock lock(mutex);
  if (!next_pick()) return;
  const auto found =
      std::ranges::find_if(threads, [&](const auto& thread) { return thread->worker == worker; });
  if (found == threads.end()) return;
  // A copy: run_errand() unlocks, and the list of threads may change meanwhile.
  const std::shared_ptr<DeviceThread> thread = *found;  // NOLINT(performance-unnecessary-copy-initialization)
  if (has_errand(*thread)) run_errand(lock, *thread);
}

/// Reports failure if no worker is left to draw the generation.
void LiveSession::look_at(std::unique_lock<std::mutex>& lock) {
  const std::shared_ptr<SessionFrame> mine = drawn();
  lock.unlock();
  Frame& frame = *mine->frame;
  retire_hanging(frame);
  std::string failure;
  std::exception_ptr thrown;
  {
    const std::lock_guard frame_lock(frame.mutex);
    thrown = frame.last_error;
    if (!frame.workers.empty() && std::ranges::all_of(frame.workers, &Frame::Worker::failed))
      for (const Frame::Worker& worker : frame.workers)
        failure += (failure.empty() ? "" : "; ") + worker.report.messages.back();
  }
  lock.lock();
  if (failure.empty() || mine != current || mine->generation != newest || is_at_rest(state)) return;
  error = failure, cause = thrown;
  drop_picks();
  set_state(SessionState::failed);
}

// The device threads.

void LiveSession::after_frame(std::unique_lock<std::mutex>& lock, DeviceThread& thread,
                              const std::shared_ptr<FrameTask>& task) {
  const auto mine = std::static_pointer_cast<SessionFrame>(task);
  drop_lost_picks();
  lock.unlock();
  Frame& frame = *mine->frame;
  const bool draft = thread.of_scenes->draws_draft();
  double speed = 0;
  {
    const std::lock_guard frame_lock(frame.mutex);
    if (!draft) speed = frame.coarse.pixel_seconds;
    if (progress_of(frame).settled) note_progress(mine);
  }
  lock.lock();
  if (speed > 0) pixel_seconds = speed;
  note();
  if (draft) return end_draft(lock, thread, mine);
  if (mine != current || state != SessionState::settled || !thread.of_scenes->is_open()) return;
  lock.unlock();
  thread.of_scenes->rest();
  lock.lock();
  rested = mine->generation;
  note();
}

/// Whether a worker has drawn part of the frame as a draft. The caller holds the mutex.
bool LiveSession::is_draft(const std::shared_ptr<SessionFrame>& frame) const {
  return std::ranges::any_of(threads, [&](const auto& thread) {
    return thread->seen == frame && thread->of_scenes && thread->of_scenes->draws_draft();
  });
}

/// Waits for the frame's final kernels and orders a redraw, unless interrupted.
void LiveSession::end_draft(std::unique_lock<std::mutex>& lock, const DeviceThread& thread,
                            const std::shared_ptr<SessionFrame>& mine) {
  const auto over = [&] {
    return closing || thread.leave || pending || mine != current || is_at_rest(state);
  };
  while (!over() && !thread.of_scenes->may_end_draft()) changed.wait_for(lock, look_for_kernels, over);
  if (over()) return;
  pending = Order{mine->generation, mine->scene, mine->settings, mine->clock, mine};
  note();
}

void LiveSession::run_errand(std::unique_lock<std::mutex>& lock, DeviceThread& thread) {
  const std::shared_ptr<Pick> pick = next_pick();
  pick->taken = true;
  lock.unlock();
  std::optional<Picked> picked;
  std::exception_ptr thrown;
  try {
    picked = pick_on(*thread.of_scenes, pick->x, pick->y);
  } catch (const std::exception&) {
    thrown = std::current_exception();
  }
  lock.lock();
  if (std::erase(picks, pick) == 0) return;  // dropped meanwhile
  if (thrown)
    pick->answer.set_exception(thrown);
  else
    pick->answer.set_value(std::move(picked));
}

/// Called by a thread that has added a tile to the frame and holds its mutex.
void LiveSession::note_progress(const std::shared_ptr<SessionFrame>& mine) {
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

/// Develops the picture once for all callers, who hold the frame's mutex.
std::shared_ptr<const Image> LiveSession::picture_so_far(const Frame& frame,
                                                         const std::vector<glm::vec3>& with) const {
  const std::lock_guard lock(picture_mutex);
  const std::uint64_t count = frame.coarse.count + std::uint64_t{frame.film.stage};
  const bool same = picture && picture_frame.lock().get() == &frame && picture_passes == count &&
                    picture_pixels == frame.pixels_done && picture_balance == with;
  if (same) return picture;
  picture = std::make_shared<const Image>(picture_of(frame, with));
  picture_balance = with;
  picture_frame = frame.weak_from_this();
  picture_passes = count;
  picture_pixels = frame.pixels_done;
  return picture;
}

}  // namespace sundog
