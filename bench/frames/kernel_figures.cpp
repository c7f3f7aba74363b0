// See kernel_figures.h.
#include "bench/frames/kernel_figures.h"

#include <algorithm>

#include "render/device/kernel_config.h"
#include "render/device/scene_programs.h"

namespace sundog {

std::vector<KernelFigures> kernel_figures(Device& device, const CompiledScene& scene) {
  const auto nvidia = device.nvidia();
  device.build_with({nvidia ? "-cl-nv-verbose" : "", true});
  const KernelConfig config = make_kernel_config(scene, device.info());
  const std::size_t room = greatest_work_group(config, device.info());
  std::vector<KernelFigures> result;
  for (const auto& [entry, defines, generated] : scene_programs(scene, device.info())) {
    BuildReport report;
    const Program program = device.build(entry, defines, &report, generated);
    auto compiler = read_ptxas_log(report.log);
    for (const std::string& name : program.kernel_names()) {
      KernelFigures& figures = result.emplace_back();
      figures.kernel = name;
      figures.limits = device.limits(program.kernel<>(name));
      figures.greatest_group =
          room > 0 ? std::min(room, figures.limits.work_group) : figures.limits.work_group;
      figures.compiler = compiler[name];
      if (nvidia && figures.compiler.registers)
        figures.resident_threads = resident_threads(*figures.compiler.registers, *nvidia);
    }
  }
  return result;
}

}  // namespace sundog
