// Tries each device in turn, then the host.
#include "app/process/trace_halo_map.h"

#include <fmt/format.h>

#include "app/process/progress.h"
#include "app/process/warnings.h"
#include "base/error.h"
#include "render/device/halo_tracer.h"

namespace sundog {

TracedHalo trace_halo_map(const EnvironmentDescription& environment, const std::vector<DeviceInfo>& devices,
                          bool quiet) {
  const HaloPlan plan = plan_halo(environment);
  ProgressBar bar(!quiet);
  Stopwatch clock;
  const auto progress = [&](std::uint64_t done) {
    bar.update({done, plan.rays, clock.seconds()});
    return true;
  };
  TracedHalo traced{{}, plan.rays, 0, "host"};
  for (const DeviceInfo& info : devices) try {
      Device device(info);
      build_halo_kernel(device);
      clock = {};
      traced.map = trace_halo_on(device, plan, progress);
      traced.seconds = clock.seconds();
      traced.device = info.label();
      return traced;
    } catch (const DeviceError& error) {
      print_warnings({{fmt::format("{}: the halo is traced elsewhere: {}", info.label(), error.what())}});
    } catch (const BuildError& error) {
      print_warnings({{fmt::format("{}: the halo is traced elsewhere: {}", info.label(), error.what())}});
    }
  clock = {};
  traced.map = trace_halo(plan, progress);
  traced.seconds = clock.seconds();
  return traced;
}

}  // namespace sundog
