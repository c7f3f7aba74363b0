// The integrator kernels that a device has built or can load, and those being built in the background. Picks
// the kernels that draw a scene.
#pragma once
#include <optional>
#include <vector>

#include "base/error.h"
#include "device/device.h"
#include "render/device/kernel_builder.h"

namespace sundog {

/// The scene was replaced while its kernels were being built. The previous kernels are unchanged.
struct NotWantedAnyMore : DeviceError {
  using DeviceError::DeviceError;
};

/// How the kernels that draw relate to those that the scene asks for: the same, others that give the same
/// bits, or others that round differently.
enum class Fit { own, exact, draft };

struct KernelPick {
  KernelOrder kernel;
  Fit fit = Fit::own;
  bool built = true;  // false: the caller builds it
};

/// Use from the device's thread only, unless stated otherwise.
class KernelStore {
 public:
  explicit KernelStore(const DeviceInfo& device) : builder_(device) {}

  /// Begins another scene, for whose kernels `general` may stand in, besides kernels that have drawn before.
  void begin_scene(std::vector<KernelConfig> general);

  /// Returns the wanted kernels if they are built or nothing can stand in for them, not even a draft.
  KernelPick pick(const Device& device, KernelOrder wanted);

  /// Waits until the builder's thread has built the kernels, unless the device keeps no programs. Throws
  /// NotWantedAnyMore if the scene is replaced meanwhile. Returns the number of kernels built.
  unsigned wait_for(const Device& device, const KernelOrder& order);

  /// Records kernels that draw, so that they may stand in for later ones.
  void remember(const KernelConfig& config) { known_.push_back(config); }

  /// Orders the kernels for which others stand in.
  void build_wanted();

  /// The wanted kernels, once they are built: they replace stand-ins that give the same bits.
  std::optional<KernelOrder> take_wanted(const Device& device);

  /// Whether a draft stands in, and whether its scene's kernels are built or have failed to build.
  bool draws_draft() const { return fit_ == Fit::draft; }
  bool may_end_draft() const { return draws_draft() && builder_.has_tried(*wanted_); }

  /// Called when the session rests: orders the general kernels, which draw while an edit's own are built.
  void build_general(const Device& device, const KernelOrder& own);

  KernelBuilder& builder() { return builder_; }
  const KernelBuilder& builder() const { return builder_; }

 private:
  KernelBuilder builder_;
  Fit fit_ = Fit::own;
  std::optional<KernelOrder> wanted_;        // the scene's, while others stand in
  std::vector<KernelConfig> known_;          // built by this device
  std::vector<KernelConfig> general_;        // stand-ins for the scene's kernels
  std::vector<KernelConfig> built_general_;  // stand-ins known to be built
};

}  // namespace sundog
