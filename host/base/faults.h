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

/// Faults are a text, separated by commas, each KIND[=VALUE][>SIZE]@WHERE[#N[+]]: it strikes where KIND
/// happens at WHERE with more than SIZE, at the Nth such occasion, with N+ at all from it on, or at each. The
/// kinds, and what asks for them:
///     build@P:D           the kernels do not build on the device
///     kernels@P:D         the driver creates no kernels from a program that it built from source
///     compile@P:D         the process that compiles for the device ends without a result
///     alloc=STATUS@P:D    a buffer of more than SIZE bytes gives the OpenCL status
///     launch=STATUS@P:D   a launch of more than SIZE work-items gives the OpenCL status
///     group=STATUS@P:D    a launch in groups of more than SIZE work-items gives the OpenCL status
///     limit=MOST@P:D      the driver gives no kernel's groups more than MOST work-items
///     hang@P:D            a launch never comes back
///     photons=KIBIBYTES@P:D  maps of photons take no more on the device, or one map if that is more
///     spoil@P:D           what is read back from the device, more than SIZE bytes, is wrong
///     cut@P:D             the loops of launches of more than SIZE samples are ended early, without an error
///     crash@P:D           a launch ends the process
///     kill@P:D            the process is killed (SIGKILL) at a launch
///     kill@compile        the compiling process is killed
///     stop@P:D            a launch stops the process, as SIGSTOP from outside does
///     write@NAME          a picture, checkpoint or part of that name cannot be written, as on a full disk
///     room=KIBIBYTES@pocl size limit of PoCL's folder
///     hold@NAME           reading an opened scene file of that name never begins
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
  /// Ends or stops the process if such a fault strikes now.
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
