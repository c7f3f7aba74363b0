// Runs a device in its own process, so that crashes and hangs affect nothing else.
#pragma once
#include <memory>
#include <string>

#include "render/remote/channel.h"

namespace sundog {

struct HostEnvironment;

/// Starts `sundog worker 3 NAME` through HostEnvironment::start_program, with a channel as its descriptor 3.
/// The channel's errors say how the process ended. When the channel is destroyed, the process has two seconds
/// to end before it is killed. Throws DeviceError.
std::unique_ptr<Channel> start_worker(const HostEnvironment& environment, const std::string& name);

}  // namespace sundog
