// `sundog compile P:D`: compiles a program for the sundog process that started it. Not for users.
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "app/options/command.h"
#include "app/process/environment.h"
#include "app/process/interrupt.h"
#include "base/arguments.h"
#include "base/error.h"
#include "device/compile_process.h"

namespace sundog {

namespace {

int compile_for(const std::string& place) {
  if (place.empty() || ::isatty(STDOUT_FILENO))
    throw UsageError("compile is not a command for people: sundog starts it");
  // Ctrl-C and a hang-up reach all processes of a terminal; the parent decides. If the parent ends, the
  // result is of no use, so this process is killed.
  hold_back({SIGINT, SIGHUP});
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  serve_compile(program_environment(), place, STDIN_FILENO, STDOUT_FILENO);
  return exit_done;
}

}  // namespace

void add_compile(Arguments& root, Command& chosen) {
  Arguments* app =
      root.add_subcommand("compile", "Compile a program for the process that started this")->hidden();
  const auto place = std::make_shared<std::string>();
  app->add_option("DEVICE", *place, "P:D");
  app->callback([place, &chosen] {
    chosen = {.run = [place] { return compile_for(*place); }, .in_first_thread = true};
  });
}

}  // namespace sundog
