// Options that programs are built with, and bypassing of drivers' caches.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sundog {

struct DeviceInfo;
struct KernelText;

/// Settings of a device's future builds.
struct BuildWish {
  std::string options{};     // in place of the device's by the same name; "!OPTION": without that
  bool from_source = false;  // do not use caches, which lose the log
  std::string tuned{};       // as options, for the programs of integrators alone: a tuning compared no others
};

/// All options of a build of `text`: sundog's, the device's (device_rules.h), `wish`'s, and the user's
/// (HostEnvironment, such as -cl-nv-maxrregcount=64). Later ones take the place of earlier by the same name.
std::string all_build_options(const DeviceInfo& device, const BuildWish& wish, const KernelText& text);

/// Options that a tuning may build `entry` with on the device: a list for each name, of options and "!OPTION"
/// that change a build. Options of different names may be combined.
std::vector<std::vector<std::string>> options_to_try(const DeviceInfo& device, std::string_view entry);

/// Whether a tuning may have these options: each is one to try on some device.
bool may_be_tuned(std::string_view options);

/// `options` without those of its maker that the device's rule gives or has a tuning try, which an older
/// driver may refuse.
std::string portable_options(const DeviceInfo& device, const std::string& options);

/// Disables drivers' own caches, which lose the log. Call before the first OpenCL call.
/// HostEnvironment::build_log implies it.
void bypass_driver_caches();

}  // namespace sundog
