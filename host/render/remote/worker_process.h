// A process of its own for a device: what crashes or hangs there takes nothing else along.
#pragma once
#include <memory>
#include <string>

#include "render/remote/channel.h"

namespace sundog {

struct HostEnvironment;

/// Starts a process by HostEnvironment::start_program as `sundog worker 3 NAME`, with a channel to it as its
/// descriptor 3. The
/// channel's errors say how the process ended; when the channel goes, the process is given two seconds to end
/// by itself. Throws DeviceError.
std::unique_ptr<Channel> start_worker(const HostEnvironment& environment, const std::string& name);

}  // namespace sundog
