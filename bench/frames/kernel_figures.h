// Group sizes, memory and registers of the kernels that a scene needs, as a device's compiler reports them.
#pragma once
#include <string>
#include <vector>

#include "compile/compiled_scene.h"
#include "device/device.h"

namespace sundog {

struct KernelFigures {
  std::string kernel;
  KernelLimits limits;
  std::size_t greatest_group =
      0;                  // that sundog gives it: the kernel's limit, and room on a processor's stack
  PtxasFigures compiler;  // by the build log, where the driver tells
  std::optional<unsigned> resident_threads;  // on a multiprocessor, by its registers alone; NVIDIA's devices
};

/// Builds the kernels from their source: those of frames, with and without AOVs, and those of `bench rays`
/// where something is traced. On NVIDIA's devices with -cl-nv-verbose. Throws DeviceError, BuildError.
std::vector<KernelFigures> kernel_figures(Device& device, const CompiledScene& scene);

}  // namespace sundog
