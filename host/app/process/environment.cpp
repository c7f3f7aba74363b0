// Reads the variables once, and gives the layers below functions that start and end processes.
#include "app/process/environment.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "app/process/spawn_self.h"
#include "app/process/standard_streams.h"

namespace sundog {
namespace {

/// Performs an injected fault that ends or stops the process (base/faults.h).
void end_process(const std::string& kind) {
  if (kind == "crash") std::abort();
  std::raise(kind == "kill" ? SIGKILL : SIGSTOP);
}

EnvironmentPtr read_program_environment() {
  HostEnvironment environment = read_environment(end_process);
  environment.start_program = start_self;
  environment.standard_input = standard_input;
  environment.step_back = [] { ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 19); };
  return std::make_shared<const HostEnvironment>(std::move(environment));
}

}  // namespace

const EnvironmentPtr& program_environment() {
  static const EnvironmentPtr environment = read_program_environment();
  return environment;
}

const std::shared_ptr<DriverThreads>& driver_threads() {
  static const auto threads = std::make_shared<DriverThreads>();
  return threads;
}

}  // namespace sundog
