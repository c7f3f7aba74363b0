// `sundog compile P:D`: compiles a program for the process that started it. Not for people.
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "app/options/commands.h"
#include "app/process/environment.h"
#include "app/process/interrupt.h"
#include "base/error.h"
#include "device/compile_process.h"

namespace sundog {

int compile_command(int argc, const char* const* argv) {
  if (argc != 3 || ::isatty(STDOUT_FILENO))
    throw UsageError("compile is not a command for people: sundog starts it");
  // Ctrl-C and a hang-up go to all of a terminal's processes; the one that started this decides. What it may
  // leave behind when it ends at once is of no use to anyone.
  hold_back({SIGINT, SIGHUP});
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  serve_compile(program_environment(), argv[2], STDIN_FILENO, STDOUT_FILENO);
  return exit_done;
}

}  // namespace sundog
