// Starts the threads, runs the current frame in each, and at the end leaves behind those inside a driver.
#include "render/frame/frame_loop.h"

namespace sundog {
namespace {

// How long a driver may take to return from a launch when the loop ends.
constexpr std::chrono::seconds ending_grace{10};

}  // namespace

void FrameLoop::add_thread(std::shared_ptr<DeviceWorker> worker) {
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

void FrameLoop::run(const std::shared_ptr<FrameTask>& mine, bool wait) {
  stop_if_asked(*mine->frame);
  {
    const std::lock_guard lock(mutex);
    current = mine;
    note();
  }
  watch_frame(*mine->frame, wait);
  const std::lock_guard lock(mutex);
  current.reset();
}

void FrameLoop::drop_frame() {
  if (!current) return;
  current->frame->stop = true;
  current->frame->queue.close();
  for (const auto* list : {&threads, &leaving})
    for (const auto& thread : *list)
      if (thread->of_scenes) thread->of_scenes->hurry();
}

void FrameLoop::end() {
  std::vector<std::shared_ptr<DeviceThread>> all;
  {
    const std::lock_guard lock(mutex);
    closing = true;
    drop_frame();
    note();
    all = threads;
    all.insert(all.end(), leaving.begin(), leaving.end());
  }
  for (const auto& thread : all) {
    std::unique_lock lock(mutex);
    // A thread that a frame did not wait for may be about to end.
    const bool in_driver = thread->abandoned || (thread->opening && thread->worker->compiles());
    const bool joins =
        changed.wait_for(lock, in_driver ? look_again : ending_grace, [&] { return thread->gone; });
    lock.unlock();
    if (joins)
      thread->driver.thread.join();
    else
      leave_thread(thread->worker->info().threads, std::move(thread->driver));
  }
}

std::optional<std::size_t> FrameLoop::index_of(const DeviceThread& thread) const {
  if (!current) return std::nullopt;
  const auto& workers = current->frame->workers;
  for (std::size_t i = 0; i < workers.size(); ++i)
    if (workers[i].device == thread.worker) return i;
  return std::nullopt;
}

void FrameLoop::run_thread(DeviceThread& thread) {
  std::unique_lock lock(mutex);
  while (true) {
    changed.wait(lock, [&] {
      return closing || thread.leave || (current && current != thread.seen && index_of(thread)) ||
             has_errand(thread);
    });
    if (closing || thread.leave) break;
    const std::optional<std::size_t> index = index_of(thread);
    if (current != thread.seen && index)
      work_on_current(lock, thread, *index);
    else
      run_errand(lock, thread);
  }
  thread.opening = false;
  lock.unlock();
  try {
    if (!thread.closed) thread.worker->close();
  } catch (const std::exception&) {
    // The device is released as far as possible.
  }
  lock.lock();
  thread.gone = true;
  changed.notify_all();
}

void FrameLoop::work_on_current(std::unique_lock<std::mutex>& lock, DeviceThread& thread, std::size_t index) {
  const std::shared_ptr<FrameTask> mine = current;
  std::shared_ptr<FrameTask> before = std::exchange(thread.seen, mine);
  thread.opening = true;
  lock.unlock();
  Frame& frame = *mine->frame;
  if (mine->flat && thread.of_scenes) thread.of_scenes->show(mine->flat, frame.options);
  before.reset();  // may destroy the old frame: outside the lock
  work_on_frame(frame, index);
  if (mine->final) leave_frame(frame, index, mine->closes);
  lock.lock();
  thread.opening = false;
  thread.opened = thread.of_scenes && thread.of_scenes->is_open();
  thread.closed = mine->closes;
  note();
  if (!mine->final) after_frame(lock, thread, mine);
}

void run_frame(const std::shared_ptr<Frame>& frame, bool wait) {
  const auto loop = std::make_shared<FrameLoop>();
  {
    const std::lock_guard lock(loop->mutex);
    for (const Frame::Worker& worker : frame->workers) loop->add_thread(worker.device);
  }
  const auto mine = std::make_shared<FrameTask>();
  mine->frame = frame;
  mine->final = mine->closes = true;
  loop->run(mine, wait);
  {
    const std::lock_guard lock(loop->mutex);
    for (std::size_t i = 0; i < frame->workers.size(); ++i)
      loop->threads[i]->abandoned = frame->workers[i].report.abandoned;
  }
  loop->end();
}

}  // namespace sundog
