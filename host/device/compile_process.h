// The compiler in a process of its own. Internal to the device layer, but for serve_compile().
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "device/devices.h"
#include "device/launches.h"

namespace sundog {

class StartedProgram;

/// A program that another process compiles: without linking it, or as a whole, with the machine code that its
/// driver makes at a kernel's first launch. PoCL reads 10 MB of its own built-in functions (half a second)
/// before it can link a process's first program, and holds one lock whenever it compiles. Another process can
/// compile in that time; what it did not link is linked here in 20 ms.
class CompileProcess {
 public:
  /// Builds the program as a whole where a launch is given, else compiles it without linking. None where
  /// nothing would be gained: another driver, one processor, or a HostEnvironment that starts no program.
  /// Never throws: without it programs are built in this process.
  static std::optional<CompileProcess> start(const DeviceInfo& device, const std::string& source,
                                             const std::string& options,
                                             const EmptyLaunch* launch = nullptr) noexcept;
  CompileProcess(CompileProcess&& other) noexcept;
  CompileProcess& operator=(CompileProcess&&) = delete;
  ~CompileProcess();  // ends it

  /// The program, as its driver's binary; empty where there is none.
  std::string wait() noexcept;

 private:
  CompileProcess(std::unique_ptr<StartedProgram> process, int result);
  std::unique_ptr<StartedProgram> process_;  // null: ended
  int result_;                               // a file in memory that it writes
};

/// The other side (`sundog compile P:D`): compiles or builds what stands in the file `in` (a line of options,
/// a line with the launch or nothing, the source) for the device "P:D" and writes the binary to the file
/// `out`. Throws DeviceError, BuildError, IoError.
void serve_compile(const std::shared_ptr<const HostEnvironment>& environment, const std::string& place,
                   int in, int out);

}  // namespace sundog
