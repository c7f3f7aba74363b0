// What programs are built with beyond their source: options of the user's, and whether the compiler's log is
// wanted.
#pragma once
#include <string>

namespace sundog {

/// How a device builds its programs from now on.
struct BuildWish {
  std::string options;       // on top of sundog's own and of SUNDOG_BUILD_OPTIONS
  bool from_source = false;  // a program from a cache has no log
};

/// The variable SUNDOG_BUILD_OPTIONS: options for the driver's compiler, such as -cl-nv-maxrregcount=64;
/// empty without it.
std::string user_build_options();

/// All options of a build: sundog's own, the user's, the wish's.
std::string all_build_options(const BuildWish& wish);

/// The folder of the variable SUNDOG_BUILD_LOG, for a file a program with its log; empty without it.
std::string build_log_folder();

/// Asks drivers not to take programs from caches of their own, where the log is lost. Before the first OpenCL
/// call, or it does nothing. The variable SUNDOG_BUILD_LOG does it too.
void bypass_driver_caches();

}  // namespace sundog
