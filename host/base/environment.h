// HostEnvironment: the settings that a program reads from its environment and passes to the layers below,
// which read no variables themselves, and a function that starts processes.
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

constexpr int nowhere = -1;  // stands for /dev/null

/// A descriptor of this process (or nowhere) and its number in the new process.
struct HandedDown {
  int here, there;
};

/// How a process ended: by `signal` if above 0, else with `status`.
struct ProgramEnd {
  int status = 0, signal = 0;
};

/// A started process. Destruction does not end it.
class StartedProgram {
 public:
  virtual ~StartedProgram() = default;
  /// How the process ended; none while it runs.
  virtual std::optional<ProgramEnd> ended() = 0;
  /// Kills the process; does not wait for its end.
  virtual void end() = 0;
};

/// Starts a process that understands the arguments "worker" and "compile" as sundog does. Throws IoError.
using StartProgram = std::function<std::unique_ptr<StartedProgram>(std::vector<std::string> arguments,
                                                                   std::vector<HandedDown> descriptors)>;

/// Waits for the process to end, for at most `seconds`; none if it still runs.
std::optional<ProgramEnd> wait_for_end(StartedProgram& program, double seconds);

struct HostEnvironment {
  std::filesystem::path cache;        // kernels and tunings; empty: none
  bool kernel_cache = true;           // whether compiled kernels are cached
  std::filesystem::path kernels;      // folder to read kernel files from; empty: the embedded ones
  std::string dump_folder;            // folder for each program's final source; empty: none
  std::string build_options;          // extra options for drivers' compilers
  std::string build_log;              // folder for compilers' logs; empty: none
  double launch_limit = 0;            // seconds after which a launch counts as hung; 0: estimated
  double silence_limit = 10;          // seconds after which a silent process is abandoned
  std::shared_ptr<Faults> faults{};   // injected failures; null: none
  StartProgram start_program{};       // empty: everything runs in this process
  std::function<void()> step_back{};  // lowers the priority of a slow device's thread
  std::function<const std::string&()> standard_input{};  // the scene "-"; empty: "-" is a file
  /// Drivers' variables: the user's values, and sundog's defaults for variables that are not set.
  std::map<std::string, std::string> drivers{};

  /// A driver's variable; empty if not set.
  std::string driver(const std::string& name) const;
};

/// Whether a folder of `path` (colon-separated) contains the program.
bool has_program(const std::string& path, const std::string& name);

/// A shared, immutable HostEnvironment; null: the default one.
using EnvironmentPtr = std::shared_ptr<const HostEnvironment>;

/// Returns the environment, or the default one for null.
const HostEnvironment& value_of(const EnvironmentPtr& environment);

/// Reads XDG_CACHE_HOME, HOME, SUNDOG_* and the drivers' variables. Called once by a program. `end_process`
/// is passed to Faults. Throws UsageError for malformed faults and seconds.
HostEnvironment read_environment(const std::function<void(const std::string& kind)>& end_process = {});

/// Sets an environment variable, for drivers. Keeps a value that is not empty, unless `replaces`. Other
/// threads may call getenv() meanwhile, because unlike setenv() this frees nothing that they may be reading,
/// but they must not set variables.
void set_variable(const std::string& name, const std::string& value, bool replaces = false);

/// read_environment() for a program that starts no processes.
EnvironmentPtr plain_environment();

}  // namespace sundog
