// Launches that do nothing, and how other processes are asked for them. Internal to the device layer.
#pragma once
#include <string>

#include "device/device.h"

namespace sundog {

/// As one line, and back.
std::string to_line(const EmptyLaunch& launch);
EmptyLaunch empty_launch_of(const std::string& line);

/// Waits for its end. Returns an OpenCL status.
cl_int launch_nothing(const cl::Context& context, const cl::CommandQueue& queue, cl::Kernel& kernel,
                      const EmptyLaunch& launch);

}  // namespace sundog
