// Options that programs are built with, and bypassing of drivers' caches.
#pragma once
#include <string>

namespace sundog {

struct HostEnvironment;

/// Settings of a device's future builds.
struct BuildWish {
  std::string options;       // in addition to sundog's and the user's (HostEnvironment)
  bool from_source = false;  // do not use caches, which lose the log
};

/// All options of a build: sundog's, the user's (such as -cl-nv-maxrregcount=64), and `wish`'s.
std::string all_build_options(const HostEnvironment& environment, const BuildWish& wish);

/// Disables drivers' own caches, which lose the log. Call before the first OpenCL call.
/// HostEnvironment::build_log implies it.
void bypass_driver_caches();

}  // namespace sundog
