// Composes the options that programs are built with, and disables drivers' caches.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

struct DeviceInfo;
struct KernelText;

/// Settings for a device's future builds.
struct BuildWish {
  std::string options{};     // replace the device's options of the same name; "!OPTION" removes one
  bool from_source = false;  // do not use caches, which lose the log
  std::string tuned{};       // like `options`, but only for integrators' programs, which a tuning compares
};

/// All options of a build of `text`: sundog's, the device's (device_rules.h), `wish`'s, and the user's
/// (HostEnvironment, such as -cl-nv-maxrregcount=64). Later options replace earlier ones of the same name.
std::string all_build_options(const DeviceInfo& device, const BuildWish& wish, const KernelText& text);

/// Options that a tuning may build `entry` with on the device. Each list has the alternatives of one name
/// (options, or "!OPTION" to remove one) that change the build. Those of different names may be combined.
/// `compact`: the scene is traced by the compact tracer.
std::vector<std::vector<std::string>> options_to_try(const DeviceInfo& device, std::string_view entry,
                                                     bool compact);

/// Whether a tuning could have produced these options: each is listed to be tried on some device.
bool may_be_tuned(std::string_view options);

/// `options` without the -cl- options from the device's rule, including those to try: vendor options, which
/// an older driver may refuse.
std::string portable_options(const DeviceInfo& device, const std::string& options);

/// Disables drivers' own caches, which lose the log. Call before the first OpenCL call.
/// HostEnvironment::build_log implies it.
void bypass_driver_caches();

}  // namespace sundog
