// Launches without work, and their text form for other processes. Internal to the device layer.
#pragma once
#include <string>

#include "device/device.h"

namespace sundog {

/// Conversion to one line and back.
std::string to_line(const EmptyLaunch& launch);
EmptyLaunch empty_launch_of(const std::string& line);

/// Launches the kernel over no work and waits. Returns an OpenCL status.
cl_int launch_nothing(const cl::Context& context, const cl::CommandQueue& queue, cl::Kernel& kernel,
                      const EmptyLaunch& launch);

}  // namespace sundog
