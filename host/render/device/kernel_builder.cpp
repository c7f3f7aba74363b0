// One thread builds the newest order first, then orders for later; another serves a caller that waits.
#include "render/device/kernel_builder.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "base/clock.h"
#include "base/environment.h"
#include "render/device/frame_kernels.h"

namespace sundog {
namespace {

bool same(const KernelOrder& a, const KernelOrder& b) {
  return a.entry == b.entry && same_kernels(a.config, b.config);
}

bool is_among(const std::vector<KernelOrder>& list, const KernelOrder& order) {
  return std::ranges::any_of(list, [&](const KernelOrder& other) { return same(order, other); });
}

/// Builds a kernel and launches it over no pixels, because some drivers compile at the first launch of a
/// local size.
void build(const DeviceInfo& info, const KernelOrder& order) {
  Device device(info);
  device.build_with({.tuned = order.config.options});
  const Program program = device.build(order.entry, order.config.defines(), nullptr, order.config.generated);
  IntegratorKernel kernel = integrator_kernel(program, order.kernel);
  device.make_ready(kernel, first_group(order.config));
  device.save_programs();
}

}  // namespace

std::size_t first_group(const KernelConfig& config) { return config.tile_w * config.tile_h > 1 ? 1 : 64; }

// Shared with the threads, so that destroying the builder does not wait for a compiler.
struct KernelBuilder::State {
  explicit State(DeviceInfo device) : info(std::move(device)) {}

  const DeviceInfo info;
  std::mutex mutex;  // guards everything below
  std::condition_variable changed;
  std::vector<KernelOrder> waiting;  // the last one is next
  std::vector<KernelOrder> later;
  Stopwatch since_wish;
  std::optional<KernelOrder> in_hand;
  std::vector<KernelOrder> done, failed;
  bool ends = false, is_waited_for = true;
  // An order with a waiting caller has its own thread, so that it never queues behind speculative orders.
  DriverThread urgent_thread;
  std::optional<KernelOrder> urgent, urgent_in_hand;

  bool is_in_hand(const KernelOrder& order) const {
    return (in_hand && same(*in_hand, order)) || (urgent_in_hand && same(*urgent_in_hand, order));
  }
  bool is_known(const KernelOrder& order) const {
    return is_among(done, order) || is_among(failed, order) || is_in_hand(order);
  }
  void note_wish() {
    since_wish = Stopwatch();
    changed.notify_all();
  }
  std::optional<KernelOrder> take(std::unique_lock<std::mutex>& lock);
  void build_in_hand(std::unique_lock<std::mutex>& lock, DeviceInfo& device,
                     std::optional<KernelOrder>& order);
  void run();
  void run_urgent();
};

KernelBuilder::KernelBuilder(DeviceInfo info) : state_(std::make_shared<State>(std::move(info))) {}

void KernelBuilder::begin() {
  if (thread_.thread.joinable()) return;
  thread_ = start_thread([state = state_]() mutable {
    state->run();
    state.reset();
  });
}

KernelBuilder::~KernelBuilder() {
  bool compiles = false, compiles_urgent = false;
  DriverThread urgent;
  {
    const std::lock_guard lock(state_->mutex);
    state_->ends = true;
    compiles = state_->in_hand.has_value();
    compiles_urgent = state_->urgent_in_hand.has_value();
    urgent = std::move(state_->urgent_thread);
    state_->changed.notify_all();
  }
  const auto end = [&](DriverThread& thread, bool is_left) {
    if (!thread.thread.joinable()) return;
    if (is_left)
      leave_thread(state_->info.threads, std::move(thread));
    else
      thread.thread.join();
  };
  end(thread_, compiles);
  end(urgent, compiles_urgent);
}

void KernelBuilder::want(KernelOrder order) {
  begin();
  const std::lock_guard lock(state_->mutex);
  if (state_->is_known(order)) return;
  std::erase_if(state_->waiting, [&](const KernelOrder& other) { return same(order, other); });
  state_->waiting.push_back(std::move(order));
  state_->note_wish();
}

void KernelBuilder::want_later(std::vector<KernelOrder> orders) {
  begin();
  const std::lock_guard lock(state_->mutex);
  std::erase_if(orders, [&](const KernelOrder& order) { return state_->is_known(order); });
  if (orders.empty()) return;
  state_->later = std::move(orders);
  state_->note_wish();
}

void KernelBuilder::forget_later() {
  const std::lock_guard lock(state_->mutex);
  state_->later.clear();
}

bool KernelBuilder::wait_for(KernelOrder order) {
  std::unique_lock lock(state_->mutex);
  if (!state_->is_known(order)) {
    state_->urgent = order;
    state_->note_wish();
    if (!state_->urgent_thread.thread.joinable())
      state_->urgent_thread = start_thread([state = state_]() mutable {
        state->run_urgent();
        state.reset();
      });
  }
  state_->changed.wait(lock, [&] {
    return !state_->is_waited_for || is_among(state_->done, order) || is_among(state_->failed, order);
  });
  return is_among(state_->done, order);
}

void KernelBuilder::may_wait() {
  const std::lock_guard lock(state_->mutex);
  state_->is_waited_for = true;
}

void KernelBuilder::wants_no_more() {
  const std::lock_guard lock(state_->mutex);
  state_->is_waited_for = false;
  state_->changed.notify_all();
}

bool KernelBuilder::is_waited_for() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_waited_for;
}

std::vector<KernelConfig> KernelBuilder::built() const {
  const std::lock_guard lock(state_->mutex);
  std::vector<KernelConfig> configs;
  for (auto order = state_->done.rbegin(); order != state_->done.rend(); ++order)
    configs.push_back(order->config);
  return configs;
}

bool KernelBuilder::has_built(const KernelOrder& order) const {
  const std::lock_guard lock(state_->mutex);
  return is_among(state_->done, order);
}

bool KernelBuilder::has_tried(const KernelOrder& order) const {
  const std::lock_guard lock(state_->mutex);
  return is_among(state_->done, order) || is_among(state_->failed, order);
}

std::size_t KernelBuilder::waiting() const {
  const std::lock_guard lock(state_->mutex);
  return state_->waiting.size() + state_->later.size() + (state_->in_hand ? 1 : 0) +
         (state_->urgent ? 1 : 0) + (state_->urgent_in_hand ? 1 : 0);
}

/// Waits for the next order; nothing at the end.
std::optional<KernelOrder> KernelBuilder::State::take(std::unique_lock<std::mutex>& lock) {
  constexpr double rest = 1;  // seconds
  while (!ends) {
    if (!waiting.empty()) {
      KernelOrder order = std::move(waiting.back());
      waiting.pop_back();
      return order;
    }
    const double left = rest - since_wish.seconds();
    if (!later.empty() && left <= 0) {
      KernelOrder order = std::move(later.front());
      later.erase(later.begin());
      return order;
    }
    if (!later.empty())
      changed.wait_for(lock, std::chrono::duration<double>(left));
    else
      changed.wait(lock);
  }
  return std::nullopt;
}

void KernelBuilder::State::build_in_hand(std::unique_lock<std::mutex>& lock, DeviceInfo& device,
                                         std::optional<KernelOrder>& order) {
  lock.unlock();
  bool works = true;
  try {
    device = share_context(std::move(device));
    build(device, *order);
  } catch (const std::exception&) {
    works = false;  // the caller repeats the build and reports the error
  }
  lock.lock();
  (works ? done : failed).push_back(std::move(*order));
  order.reset();
  changed.notify_all();
}

void KernelBuilder::State::run_urgent() {
  DeviceInfo device = info;
  std::unique_lock lock(mutex);
  while (true) {
    changed.wait(lock, [&] { return ends || urgent; });
    if (ends) return;
    urgent_in_hand = std::exchange(urgent, std::nullopt);
    build_in_hand(lock, device, urgent_in_hand);
  }
}

void KernelBuilder::State::run() {
  // The compiler runs at low priority.
  if (const auto& step_back = value_of(info.environment).step_back) step_back();
  DeviceInfo device = info;
  std::unique_lock lock(mutex);
  while ((in_hand = take(lock))) build_in_hand(lock, device, in_hand);
}

}  // namespace sundog
