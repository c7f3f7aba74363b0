// What a program hands down to the layers below it: what it has read from its environment, and how processes
// are started. Nothing below reads a variable of its own.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sundog {

class Faults;

constexpr int nowhere = -1;  // /dev/null

/// A descriptor of this process, or nowhere, and the number that the new one knows it by.
struct HandedDown {
  int here, there;
};

/// How a process ended: with a status, unless a signal above 0 ended it.
struct ProgramEnd {
  int status = 0, signal = 0;
};

/// A process that was started. One that still runs when this goes is left to itself.
class StartedProgram {
 public:
  virtual ~StartedProgram() = default;
  /// Nothing while it runs.
  virtual std::optional<ProgramEnd> ended() = 0;
  /// Has it end at once, whatever it does; does not wait until it has.
  virtual void end() = 0;
};

/// Starts a process that answers to the arguments "worker" and "compile" as sundog's own program does. Throws
/// IoError.
using StartProgram = std::function<std::unique_ptr<StartedProgram>(std::vector<std::string> arguments,
                                                                   std::vector<HandedDown> descriptors)>;

/// Waits for the end, but no longer than so many seconds.
std::optional<ProgramEnd> wait_for_end(StartedProgram& program, double seconds);

struct HostEnvironment {
  std::filesystem::path cache;        // of kernels and tunings; empty: none
  bool kernel_cache = true;           // compiled kernels are kept there
  std::filesystem::path kernels;      // kernel files are read from this folder; empty: those built in
  std::string dump_folder;            // each program's final text goes there; empty: nowhere
  std::string build_options;          // more options for drivers' compilers
  std::string build_log;              // a folder for each program with its compiler's log; empty: none
  double launch_limit = 0;            // seconds after which a launch hangs; 0: by what is expected of it
  double silence_limit = 10;          // seconds after which a silent process is given up
  std::shared_ptr<Faults> faults{};   // failures on demand; null: none
  StartProgram start_program{};       // empty: everything happens in this process
  std::function<void()> step_back{};  // makes way for other threads, in the thread of a slow device
  /// What drivers read: the user's variables, and what sundog sets where the user has set nothing.
  std::map<std::string, std::string> drivers{};

  /// The driver's variable; empty where it is not set.
  std::string driver(const std::string& name) const;
};

/// Whether one of the folders of `path`, which colons part, has the program.
bool has_program(const std::string& path, const std::string& name);

/// A HostEnvironment as it is handed down; nobody changes it. Null stands for one without anything.
using EnvironmentPtr = std::shared_ptr<const HostEnvironment>;

/// The one that the pointer means.
const HostEnvironment& value_of(const EnvironmentPtr& environment);

/// From the process's variables: XDG_CACHE_HOME, HOME, SUNDOG_* and those of drivers. Called by programs,
/// once. `end_process` is what Faults take. Throws UsageError for SUNDOG_FAULTS that are none.
HostEnvironment read_environment(const std::function<void(const std::string& kind)>& end_process = {});

/// read_environment() for a program that starts no processes.
EnvironmentPtr plain_environment();

}  // namespace sundog
