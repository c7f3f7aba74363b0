// What programs are built with beyond their source: options of the user's, and whether the compiler's log is
// wanted.
#pragma once
#include <string>

namespace sundog {

struct HostEnvironment;

/// How a device builds its programs from now on.
struct BuildWish {
  std::string options;       // on top of sundog's own and of the user's (HostEnvironment)
  bool from_source = false;  // a program from a cache has no log
};

/// All options of a build: sundog's own, the user's (such as -cl-nv-maxrregcount=64), the wish's.
std::string all_build_options(const HostEnvironment& environment, const BuildWish& wish);

/// Asks drivers not to take programs from caches of their own, where the log is lost. Before the first OpenCL
/// call, or it does nothing. HostEnvironment::build_log does it too.
void bypass_driver_caches();

}  // namespace sundog
