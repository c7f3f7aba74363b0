// Picks a scene's own kernels if they are built, then exact stand-ins, then drafts.
#include "render/device/kernel_store.h"

#include <algorithm>
#include <utility>

#include "base/environment.h"

namespace sundog {
namespace {

bool keeps_programs(const Device& device) {
  const HostEnvironment& environment = value_of(device.info().environment);
  return environment.kernel_cache && !environment.cache.empty();
}

bool is_built(const Device& device, const std::string& entry, const KernelConfig& config) {
  return device.has(entry, config.defines(), config.generated);
}

}  // namespace

void KernelStore::begin_scene(std::vector<KernelConfig> general) {
  general_ = std::move(general);
  wanted_.reset();
  fit_ = Fit::own;
}

KernelPick KernelStore::pick(const Device& device, KernelOrder wanted) {
  if (is_built(device, wanted.entry, wanted.config)) return {std::move(wanted)};
  std::vector<KernelConfig> candidates = builder_.built();
  candidates.insert(candidates.end(), known_.rbegin(), known_.rend());
  candidates.insert(candidates.end(), general_.begin(), general_.end());
  std::ranges::stable_partition(candidates, [](const KernelConfig& one) { return !interprets(one); });
  const bool tried = builder_.has_tried(wanted);
  for (const Fit fit : {Fit::exact, Fit::draft})
    for (const KernelConfig& one : candidates) {
      const bool fits =
          fit == Fit::exact ? stands_in(one, wanted.config) : !tried && drafts(one, wanted.config);
      if (!fits || !is_built(device, wanted.entry, one)) continue;
      fit_ = fit;
      KernelPick picked{{wanted.entry, wanted.kernel, one}, fit};
      wanted_ = std::move(wanted);
      return picked;
    }
  return {std::move(wanted), Fit::own, false};
}

unsigned KernelStore::wait_for(const Device& device, const KernelOrder& order) {
  if (!keeps_programs(device)) return 0;
  if (builder_.wait_for(order)) return 1;
  if (!builder_.is_waited_for())
    throw NotWantedAnyMore("the scene was replaced before its kernels were built");
  return 0;  // the build failed: the caller repeats it and reports the error
}

void KernelStore::build_wanted() {
  if (wanted_) builder_.want(*wanted_);
}

std::optional<KernelOrder> KernelStore::take_wanted(const Device& device) {
  if (!wanted_ || fit_ == Fit::draft || !keeps_programs(device) || !builder_.has_built(*wanted_))
    return std::nullopt;
  fit_ = Fit::own;
  remember(wanted_->config);
  return std::exchange(wanted_, std::nullopt);
}

void KernelStore::build_general(const Device& device, const KernelOrder& own) {
  std::vector<KernelOrder> orders;
  std::vector<KernelConfig> built;  // remembered, because lookups read the disk cache and compute checksums
  for (const KernelConfig& general : general_)
    if (std::ranges::find(built_general_, general) != built_general_.end() ||
        is_built(device, own.entry, general))
      built.push_back(general);
    else
      orders.push_back({own.entry, own.kernel, general});
  built_general_ = std::move(built);
  if (!orders.empty()) builder_.want_later(std::move(orders));
}

}  // namespace sundog
