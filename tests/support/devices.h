// The devices that tests run on, and helpers that run kernels on them.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "catch.h"
#include "device/device.h"
#include "shared/types.h"

/// Sets the drivers' environment variables unless they are set. With `every_driver`, also
/// RUSTICL_ENABLE=llvmpipe, so that a second implementation is tested if Mesa is installed. Must be called
/// before the first OpenCL call.
void prepare_opencl_environment(bool every_driver);

/// Every usable device, or those of SUNDOG_TEST_DEVICES (a comma-separated list of --device SPECs). Throws
/// DeviceError if there is none.
const std::vector<sundog::DeviceInfo>& test_devices();

/// The devices for tests of a picture's content: the first, or all that SUNDOG_TEST_DEVICES lists. Some
/// drivers compile a frame's kernels for ten seconds; frames/test_drivers_agree.cpp tests that they draw what
/// the first does.
std::span<const sundog::DeviceInfo> picture_devices();

/// The number of earlier calls of on_devices() in this run of the test case. A test case runs once for each
/// of its sections; main.cpp resets the count at each run.
int& calls_on_devices();

/// Calls body(DeviceInfo) for each device, in a section of its own. Catch2 enters each section name once, so
/// the number of the call is part of the name.
void on_devices(std::span<const sundog::DeviceInfo> devices, const auto& body) {
  const int call = calls_on_devices()++;
  for (const sundog::DeviceInfo& device : devices) DYNAMIC_SECTION(device.label() << ", call " << call) {
      body(device);
    }
}
void on_every_device(const auto& body) { on_devices(test_devices(), body); }
void on_picture_devices(const auto& body) { on_devices(picture_devices(), body); }

/// Definitions of every shape and feature, for tests of single kernels.
sundog::KernelDefines all_features();

/// Builds kernels from text, which may `#include "lib/..."` and `"shared/..."`, with all features except
/// where `defines` overrides them.
sundog::Program build_text(sundog::Device& device, const std::string& text,
                           const sundog::KernelDefines& defines = {});

/// Runs `kernel void run(global const In* in, global Out* out, u32 count)` of `text` over `inputs`, one
/// work-item for each input.
template <class Out, class In>
std::vector<Out> run_text(sundog::Device& device, const std::string& text, const std::vector<In>& inputs,
                          const sundog::KernelDefines& defines = {}) {
  const auto count = static_cast<sundog::u32>(inputs.size());
  auto kernel =
      build_text(device, text, defines).kernel<sundog::Buffer<In>, sundog::Buffer<Out>, sundog::u32>("run");
  const auto in = device.upload<In>(inputs);
  const auto out = device.make<Out>(inputs.size());
  device.run(kernel, {.x = inputs.size()}, in, out, count);
  std::vector<Out> outputs(inputs.size());
  device.read(out, std::span<Out>(outputs));
  device.finish();
  return outputs;
}
