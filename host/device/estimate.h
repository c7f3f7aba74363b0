// How fast a device may be, by what it reports; the order matters, not the unit. Internal to the device
// layer.
#pragma once
#include "device/devices.h"

namespace sundog {

/// cpu for a device that says it is one or that wants explicit vectors, else gpu.
DeviceClass device_class(const DeviceInfo& device);

/// compute units * clock * lanes; `host_threads` are the threads that this machine has for a CPU-type device.
double estimate_speed(const DeviceInfo& device, unsigned host_threads);

}  // namespace sundog
