// Estimates a device's speed from what it reports; only the order matters. Internal to the device layer.
#pragma once
#include "device/devices.h"

namespace sundog {

/// cpu for a device of that type or one that prefers explicit vectors, else gpu.
DeviceClass device_class(const DeviceInfo& device);

/// compute units * clock * lanes; `host_threads` is the machine's thread count, for CPU-type devices.
double estimate_speed(const DeviceInfo& device, unsigned host_threads);

}  // namespace sundog
