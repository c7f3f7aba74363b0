// Holds the table; the first matching row applies. docs/measurements/gpu-compilers.md has the figures. Only
// the compiler's macros, used in kernels/lib/core/config.h, tell the generation of an AMD GPU (DEVICE_WAVES)
// and whether Intel's extension for DEVICE_SUBGROUP exists.
#include "device/device_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "device/choice.h"

namespace sundog {
namespace {

constexpr std::array rules{
    // Inlining everything keeps structs in registers. With 128 registers a multiprocessor holds 16 warps, and
    // most kernels spill little or nothing. The tracer by itself fits into 64 registers without spills, so 32
    // warps run instead of 20; testing four boxes at a time (NODE_LOOP=2) would spill 80 bytes.
    DeviceRule{.name = "nvidia",
               .reports = "NVIDIA",
               .of_gpus = true,
               .options = "-DDEVICE_INLINES_ALL -cl-nv-maxrregcount=128",
               .of_programs = {{{"entry/trace_rays.cl", "-cl-nv-maxrregcount=64"}}},
               .tries_compact = "-DNODE_LOOP=1 -DNODE_LOOP=2",
               .tries = "-cl-nv-maxrregcount=96 -cl-nv-maxrregcount=168 "
                        "!-cl-nv-maxrregcount !-DDEVICE_INLINES_ALL"},
    // Testing four boxes at a time, the traversal needs 79 registers instead of 103, so 16 waves fit instead
    // of 12. Ten waves (RDNA 3 and newer) spill nothing in plain scenes; textures, layers or rough glass
    // spill up to 240 registers, where 5 to 9 waves would fit without spills.
    DeviceRule{.name = "amd",
               .reports = "Advanced Micro Devices",
               .of_gpus = true,
               .options = "-DDEVICE_INLINES_ALL -DNODE_LOOP=2 -DDEVICE_WAVES=10",
               .tries_compact = "-DNODE_LOOP=0 -DNODE_LOOP=1",
               .tries = "-DDEVICE_WAVES=8 -DDEVICE_WAVES=12 !-DDEVICE_WAVES "
                        "!-DDEVICE_INLINES_ALL"},
    // Intel's own driver. If the GPU offers 256 registers per thread instead of 128, at half the threads, the
    // compiler uses them for programs that spill. Paths, photons and the tracer always get them; the tracer
    // then
    // takes 16 rays per thread without spills, where the compiler would choose 8. Other GPUs ignore these.
    DeviceRule{.name = "intel",
               .reports = "Intel(R) OpenCL",
               .of_gpus = true,
               .options = "-DDEVICE_INLINES_ALL -DNODE_LOOP=2 -DDEVICE_SUBGROUP=16 "
                          "-cl-intel-enable-auto-large-GRF-mode",
               .of_programs = {{{"entry/trace_rays.cl", "-cl-intel-256-GRF-per-thread"},
                                {"entry/trace_photons.cl", "-cl-intel-256-GRF-per-thread"},
                                {"entry/render_path.cl", "-cl-intel-256-GRF-per-thread"}}},
               .tries_compact = "-DNODE_LOOP=0 -DNODE_LOOP=1",
               .tries = "-cl-intel-256-GRF-per-thread "
                        "!-cl-intel-256-GRF-per-thread !-cl-intel-enable-auto-large-GRF-mode "
                        "!-DDEVICE_INLINES_ALL"},
    // Intel GPUs under other drivers, which do not know the options above.
    DeviceRule{.reports = "Intel",
               .of_gpus = true,
               .options = "-DDEVICE_INLINES_ALL -DNODE_LOOP=2",
               .tries_compact = "-DNODE_LOOP=0 -DNODE_LOOP=1",
               .tries = "!-DDEVICE_INLINES_ALL"},
    DeviceRule{.of_gpus = true,
               .options = "-DDEVICE_INLINES_ALL",
               .tries_compact = "-DNODE_LOOP=1 -DNODE_LOOP=2",
               .tries = "!-DDEVICE_INLINES_ALL"},
    // Mesa's compilers inline every call; they would take minutes for the interpreter of distance fields
    // (kernels/lib/sdf/interpret.cl).
    DeviceRule{.reports = "rusticl", .vectors = true, .tries_compact = "-DNODE_LOOP=1 -DNODE_LOOP=2"},
    DeviceRule{.reports = "Clover", .vectors = true, .tries_compact = "-DNODE_LOOP=1 -DNODE_LOOP=2"},
    // Under PoCL with AVX-512, the wide tracer is 7 times as fast as the compact one for primary rays and 3
    // times as fast for bounce rays. A loop over boxes (NODE_LOOP) is slower there.
    DeviceRule{.calls = true, .vectors = true, .tries_compact = "-DNODE_LOOP=1 -DNODE_LOOP=2"},
};

}  // namespace

bool DeviceRule::matches(const DeviceInfo& device) const {
  return (!of_gpus || device.device_class == DeviceClass::gpu) &&
         (device.vendor.find(reports) != std::string::npos ||
          device.platform_name.find(reports) != std::string::npos);
}

std::string_view DeviceRule::of_program(const KernelText& text) const {
  const auto own = std::ranges::find(of_programs, text.entry, &ProgramOptions::entry);
  return own == of_programs.end() ? std::string_view{} : own->options;
}

std::span<const DeviceRule> device_rules() { return rules; }

const DeviceRule& rule_of(const DeviceInfo& device) {
  return *std::ranges::find_if(rules, [&](const DeviceRule& rule) { return rule.matches(device); });
}

bool calls_functions(const DeviceInfo& device) { return rule_of(device).calls; }

bool wants_vectors(const DeviceInfo& device) {
  return rule_of(device).vectors && device.native_vector_width > 1;
}

DeviceInfo typical_gpu(std::string_view name) {
  const auto rule = std::ranges::find(rules, name, &DeviceRule::name);
  if (name.empty() || rule == rules.end())
    throw UsageError(fmt::format("{}: wanted nvidia, amd or intel", name));
  DeviceInfo device;
  device.type = "gpu";
  device.device_class = DeviceClass::gpu;
  device.native_vector_width = 1;
  device.vendor = rule->reports;
  return device;
}

}  // namespace sundog
