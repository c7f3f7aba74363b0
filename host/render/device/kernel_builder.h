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

class KernelBuilder {
 public:
  explicit KernelBuilder(DeviceInfo info);
  /// A compiler that is at work keeps its thread, which goes to DeviceInfo::threads.
  ~KernelBuilder();
  KernelBuilder(const KernelBuilder&) = delete;
  KernelBuilder& operator=(const KernelBuilder&) = delete;

  // Called by one thread, the server's, but for what says otherwise.
  /// To be built next. What waits already is built after it; what was built, or failed to, is not again.
  void want(KernelOrder order);
  /// To be built in turn when nothing else was wanted for a second. They take the place of what waits so
  /// already.
  void want_later(std::vector<KernelOrder> orders);
  /// The same, and waits for it. False when it does not build, or wants_no_more() comes first: then it is
  /// built nevertheless.
  bool wait_for(KernelOrder order);
  /// From now on wait_for() waits, until wants_no_more().
  void may_wait();
  /// Nobody wants what wait_for() waits for. Any thread.
  void wants_no_more();
  bool is_waited_for() const;
  /// What was built so far, the latest first.
  std::vector<KernelConfig> built() const;
  /// How many wait or are in hand. Any thread.
  std::size_t waiting() const;

 private:
  struct State;
  void begin();
  std::shared_ptr<State> state_;
  DriverThread thread_;
};

}  // namespace sundog
