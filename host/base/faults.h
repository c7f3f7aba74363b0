// Faults on demand, to test what is done about them. Without the variable SUNDOG_FAULTS there are none.
#pragma once
#include <cstddef>
#include <optional>
#include <string_view>

namespace sundog {

/// SUNDOG_FAULTS holds faults separated by commas, each KIND[=VALUE][>SIZE]@WHERE[#N]: it strikes where KIND
/// happens at WHERE with more than SIZE, at the Nth such occasion or at each. The kinds, and what asks for
/// them:
///     build@P:D           the kernels do not build on the device
///     kernels@P:D         the driver makes no kernels of a program that it has built from its source
///     compile@P:D         the process that compiles for the device ends without a result
///     alloc=STATUS@P:D    a buffer of more than SIZE bytes gives the OpenCL status
///     launch=STATUS@P:D   a launch of more than SIZE work-items gives the OpenCL status
///     group=STATUS@P:D    a launch in groups of more than SIZE work-items gives the OpenCL status
///     limit=MOST@P:D      the driver gives no kernel's groups more than MOST work-items
///     hang@P:D            a launch never comes back
///     cut@P:D             the loops of launches of more than SIZE samples are ended early, without an error
///     crash@P:D           a launch ends the process
///     kill@P:D            the process is killed (SIGKILL) at a launch
///     stop@P:D            a launch stops the process, as SIGSTOP from outside does
///     write@NAME          a file of that name cannot be written, as on a full disk
///     room=KIBIBYTES@pocl no more can be written to the folder where PoCL writes
///     hold@NAME           reading an opened file of that name never begins
///     stall@NAME          writing a file of that name never ends
/// Returns VALUE (0 without one) where a fault strikes now. Throws UsageError for a variable that is none.
std::optional<int> fault(std::string_view kind, std::string_view where, std::size_t size = 0);

}  // namespace sundog
