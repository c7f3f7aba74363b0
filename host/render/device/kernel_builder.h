// Kernels that are built beside the work: in a thread of its own, on the device opened once more, into the
// binary cache, from which the device that draws takes them in milliseconds.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/driver_threads.h"
#include "render/device/kernel_config.h"

namespace sundog {

/// An integrator's kernel, and its definitions.
struct KernelOrder {
  std::string entry, kernel;
  KernelConfig config;
};

/// The local size that is launched first, in one column.
std::size_t first_group(const KernelConfig& config);

class KernelBuilder {
 public:
  explicit KernelBuilder(DeviceInfo info);
  /// If a compilation is still running, DeviceInfo::threads takes its thread over.
  ~KernelBuilder();
  KernelBuilder(const KernelBuilder&) = delete;
  KernelBuilder& operator=(const KernelBuilder&) = delete;

  // Only the server's thread calls these, unless the comment says otherwise.
  /// To be built next. What waits already is built after it; what was built, or failed to, is not again.
  void want(KernelOrder order);
  /// Builds them in turn once nothing else was wanted for a second. They replace the earlier orders of this
  /// kind.
  void want_later(std::vector<KernelOrder> orders);
  /// Builds none of them.
  void forget_later();
  /// Builds it next and waits for it. Returns false if the build fails, or if wants_no_more() ends the wait;
  /// the build then continues.
  bool wait_for(KernelOrder order);
  /// Allows wait_for() to wait until the next wants_no_more().
  void may_wait();
  /// Ends the wait of wait_for(). Any thread may call it.
  void wants_no_more();
  bool is_waited_for() const;
  /// What was built so far, the latest first.
  std::vector<KernelConfig> built() const;
  bool has_built(const KernelOrder& order) const;
  /// Whether it was built, or could not be.
  bool has_tried(const KernelOrder& order) const;
  /// How many wait or are in hand. Any thread.
  std::size_t waiting() const;

 private:
  struct State;
  void begin();
  std::shared_ptr<State> state_;
  DriverThread thread_;
};

}  // namespace sundog
