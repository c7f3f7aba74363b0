// The compiler's front end in a process of its own. Internal to the device layer, but for serve_compile().
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "device/devices.h"

namespace sundog {

class StartedProgram;

/// A program that is being compiled, not linked, by another process. PoCL reads 10 MB of its own built-in
/// functions (half a second) before it can link a process's first program, and holds one lock meanwhile.
/// Another process can compile in that time; what it made is linked here in 20 ms.
class CompileProcess {
 public:
  /// None where nothing would be gained: another driver, one processor, or a HostEnvironment that starts no
  /// program. Never throws: without it programs are built in this process.
  static std::optional<CompileProcess> start(const DeviceInfo& device, const std::string& source,
                                             const std::string& options) noexcept;
  CompileProcess(CompileProcess&& other) noexcept;
  CompileProcess& operator=(CompileProcess&&) = delete;
  ~CompileProcess();  // ends it

  /// The compiled program, as its driver's binary; empty where there is none.
  std::string wait() noexcept;

 private:
  CompileProcess(std::unique_ptr<StartedProgram> process, int result);
  std::unique_ptr<StartedProgram> process_;  // null: ended
  int result_;                               // a file in memory that it writes
};

/// The other side (`sundog compile P:D`): compiles the source and options in the file `in` for the device
/// "P:D" and writes the binary to the file `out`. Throws DeviceError, BuildError, IoError.
void serve_compile(const std::shared_ptr<const HostEnvironment>& environment, const std::string& place,
                   int in, int out);

}  // namespace sundog
