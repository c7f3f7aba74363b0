// Builds kernels in the background: in its own thread, on a second instance of the device, into the binary
// cache, from which the drawing device loads them in milliseconds.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/driver_threads.h"
#include "render/device/kernel_config.h"

namespace sundog {

/// An integrator's kernel and its definitions.
struct KernelOrder {
  std::string entry, kernel;
  KernelConfig config;
};

/// The local size of the first launch, in one column.
std::size_t first_group(const KernelConfig& config);

class KernelBuilder {
 public:
  explicit KernelBuilder(DeviceInfo info);
  /// DeviceInfo::threads adopts the thread of a running compilation.
  ~KernelBuilder();
  KernelBuilder(const KernelBuilder&) = delete;
  KernelBuilder& operator=(const KernelBuilder&) = delete;

  // Call from the worker's thread only, unless stated otherwise.
  /// Builds `order` next, before the waiting orders; skips orders that were built or failed.
  void want(KernelOrder order);
  /// Builds these in turn once no other order has come for a second. Replaces earlier orders of this kind.
  void want_later(std::vector<KernelOrder> orders);
  /// Cancels want_later().
  void forget_later();
  /// Builds the order next and waits for it. Returns false if the build fails, or if wants_no_more() ends the
  /// wait; the build then continues.
  bool wait_for(KernelOrder order);
  /// Allows wait_for() to wait again, until the next wants_no_more().
  void may_wait();
  /// Ends the wait of wait_for(). Thread-safe.
  void wants_no_more();
  bool is_waited_for() const;
  /// Kernels built so far, latest first.
  std::vector<KernelConfig> built() const;
  bool has_built(const KernelOrder& order) const;
  /// Whether it was built, or failed to build.
  bool has_tried(const KernelOrder& order) const;
  /// Number of orders waiting or in progress. Thread-safe.
  std::size_t waiting() const;

 private:
  struct State;
  void begin();
  std::shared_ptr<State> state_;
  DriverThread thread_;
};

}  // namespace sundog
