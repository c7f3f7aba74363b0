// Injects failures, to test how sundog handles them. A program passes them down in its HostEnvironment.
#pragma once
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace sundog {

/// Faults are a comma-separated text of KIND[=VALUE][>SIZE]@WHERE[#N[+]]. A fault strikes when KIND happens
/// at WHERE with a size above SIZE: every time, only the Nth time (#N), or from the Nth time on (#N+). The
/// kinds:
///     build@P:D           the kernels do not build on the device
///     kernels@P:D         the driver creates no kernels from a program that it built from source
///     compile@P:D         the process that compiles for the device ends without a result
///     alloc=STATUS@P:D    a buffer of more than SIZE bytes gives the OpenCL status
///     launch=STATUS@P:D   a launch of more than SIZE work-items gives the OpenCL status
///     group=STATUS@P:D    a launch in groups of more than SIZE work-items gives the OpenCL status
///     limit=MOST@P:D      the driver limits every kernel's groups to MOST work-items
///     hang@P:D            a launch never returns
///     photons=KIBIBYTES@P:D  memory budget of the device's photon maps; one map may exceed it
///     spoil@P:D           a read of more than SIZE bytes from the device returns wrong values
///     cut@P:D             loops in launches of more than SIZE samples end early, without an error
///     crash@P:D           a launch ends the process
///     kill@P:D            the process is killed (SIGKILL) at a launch
///     kill@compile        the compiling process is killed
///     stop@P:D            a launch stops the process (SIGSTOP)
///     write@NAME          a picture, checkpoint or part of that name cannot be written, as on a full disk
///     room=KIBIBYTES@pocl free space in PoCL's folder
///     hold@NAME           an input file of that name is opened but never read
///     stall@NAME          writing a file of that name never ends
class Faults {
 public:
  /// `end_process` performs crash, kill and stop. Throws UsageError for malformed text.
  explicit Faults(const std::string& text, std::function<void(const std::string& kind)> end_process = {});
  ~Faults();
  Faults(const Faults&) = delete;
  Faults& operator=(const Faults&) = delete;

  /// Returns VALUE (default 0) if a fault strikes now. Thread-safe.
  std::optional<int> strike(std::string_view kind, std::string_view where, std::size_t size);
  /// Ends or stops the process if a fault of this kind strikes now.
  void end_process(const char* kind, std::string_view where, std::size_t size);

 private:
  struct Fault;
  std::deque<Fault> faults_;
  std::function<void(const std::string& kind)> end_process_;
};

/// strike() for a pointer that may be null.
std::optional<int> fault(const std::shared_ptr<Faults>& faults, std::string_view kind, std::string_view where,
                         std::size_t size = 0);

}  // namespace sundog
