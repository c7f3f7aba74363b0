// The program `sundog`: parses the command line, runs the command, and turns an error into one line on stderr
// and an exit status.
#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <future>

#include "app/command_line.h"
#include "app/job/job.h"
#include "app/process/environment.h"
#include "app/process/exit_status.h"
#include "app/process/interrupt.h"
#include "app/process/standard_streams.h"
#include "base/error.h"
#include "base/memory.h"
#include "device/driver_folder.h"

namespace sundog {
namespace {

int run_command_line(int argc, char** argv) {
  // All processes of a job have the same command line, so only rank 0 reports its errors.
  Command command;
  const auto parse = [&] {
    command = parse_command_line(argc, argv);
    return exit_done;
  };
  // mpirun ends a job at the first rank that fails, and may lose what others print, so only rank 0 fails.
  if (const int status = exit_status_of(parse, job_rank() <= 0)) return job_rank() > 0 ? exit_done : status;
  if (command.only_prints) require_standard_output();
  if (command.stops_on_signal) hold_back({SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGCONT});
  const int status =
      command.in_first_thread ? command.run() : std::async(std::launch::async, command.run).get();
  flush_standard_output();
  return status;
}

volatile std::sig_atomic_t final_status = 0;

/// Ends the process after at most 5 s (0.1 s if interrupted): drivers' exit handlers wait for their threads,
/// which may compile or render for minutes or forever. Everything is written by then.
void bound_the_end(int status) {
  const itimerval patience{{}, status == exit_interrupted ? timeval{0, 100'000} : timeval{5, 0}};
  final_status = status;
  std::fflush(nullptr);
  std::signal(SIGALRM, [](int) { ::_exit(static_cast<int>(final_status)); });
  ::setitimer(ITIMER_REAL, &patience, nullptr);
}

/// Ends the process by _exit() while drivers are at work, because a return would destroy their globals. PoCL
/// may miss the folder that it writes to, so its messages and an abort are suppressed.
[[noreturn]] void end_beside_drivers(int status) {
  final_status = status;
  std::fflush(nullptr);
  std::signal(SIGABRT, [](int) { ::_exit(static_cast<int>(final_status)); });
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0)
    ::dup2(nowhere, STDERR_FILENO);
  driver_folder(*program_environment()).remove();
  ::_exit(status);
}

}  // namespace
}  // namespace sundog

int main(int argc, char** argv) {
  sundog::open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding a file size limit becomes an error, like a full disk
  sundog::keep_freed_memory();
  const int status = sundog::exit_status_of([&] { return sundog::run_command_line(argc, argv); });
  if (sundog::driver_threads()->count() > 0) sundog::end_beside_drivers(status);
  sundog::bound_the_end(status);
  return status;
}
