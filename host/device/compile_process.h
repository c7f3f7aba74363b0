// Runs the OpenCL compiler in another process. Internal to the device layer, except serve_compile().
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "device/devices.h"
#include "device/launches.h"

namespace sundog {

class StartedProgram;

/// A program being compiled by another process: either without linking, or entirely, with the machine code
/// that its driver generates at a kernel's first launch. PoCL reads 10 MB of its own built-in functions (half
/// a second) before it can link a process's first program, and compiles under a single lock. Another process
/// can compile meanwhile; linking its result here takes 20 ms.
class CompileProcess {
 public:
  /// With a launch, builds the whole program, else compiles it without linking. Returns none if nothing would
  /// be gained (a driver other than PoCL, or a single processor), if HostEnvironment forbids starting
  /// programs, or on failure; this process then builds the program. Never throws.
  static std::optional<CompileProcess> start(const DeviceInfo& device, const std::string& source,
                                             const std::string& options,
                                             const EmptyLaunch* launch = nullptr) noexcept;
  CompileProcess(CompileProcess&& other) noexcept;
  CompileProcess& operator=(CompileProcess&&) = delete;
  ~CompileProcess();  // kills the process

  /// Waits for the driver's binary of the program; empty on failure.
  std::string wait() noexcept;

 private:
  CompileProcess(std::unique_ptr<StartedProgram> process, int result);
  std::unique_ptr<StartedProgram> process_;  // null: ended
  int result_;                               // memory file with the process's output
};

/// The other side (`sundog compile P:D`): compiles or builds the contents of the file `in` (a line of
/// options, a line with the launch or an empty one, the source) for the device "P:D" and writes the binary to
/// the file `out`. Throws DeviceError, BuildError, IoError.
void serve_compile(const std::shared_ptr<const HostEnvironment>& environment, const std::string& place,
                   int in, int out);

}  // namespace sundog
