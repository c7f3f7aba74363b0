// Parent and child share a folder: the child writes each row that it enters to a file, the parent how the
// child crashed there.
#include "bench/commands/crash_guard.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <set>

#include "app/process/exit_status.h"
#include "app/process/spawn_self.h"
#include "app/process/standard_streams.h"
#include "app/process/warnings.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory_file.h"
#include "bench/commands/bench_options.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder_variable = "SUNDOG_BENCH_FOLDER";
constexpr int poll_ms = 20;

/// The child's state: the shared folder, and the rows in which earlier children crashed.
struct Guarded {
  fs::path folder;
  std::ofstream entered;                       // a line for each row
  std::map<std::string, std::string> crashed;  // how, by row
};
Guarded& guarded_state() {
  static Guarded state;
  return state;
}

std::string last_line(const fs::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);) last = line;
  return last;
}

/// How the child ended: waitpid()'s status.
struct End {
  int status = 0;
  bool interrupted = false;  // a signal asked it to end
};

/// Waits for the child and passes on signals that were sent to this process alone; a terminal's signals reach
/// both.
End wait_and_pass_signals(pid_t process) {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&set, signal);
  for (End end;;) {
    if (::waitpid(process, &end.status, WNOHANG) != 0) return end;
    const timespec pause{0, poll_ms * 1'000'000L};
    siginfo_t info{};
    const int signal = ::sigtimedwait(&set, &info, &pause);
    end.interrupted |= signal > 0;
    if (signal > 0 && info.si_code <= 0) ::kill(process, signal);
  }
}

std::string end_text(int signal) {
  return fmt::format("the process was ended by signal {} ({}){}", signal, ::strsignal(signal),
                     signal == SIGKILL ? ", as when memory runs out" : ", as when a driver crashes");
}

int measure_in_others(const fs::path& folder, bool reads_input) {
  ::signal(SIGCHLD, SIG_DFL);  // if SIGCHLD is ignored, waitpid() gives no status
  const int input = reads_input ? memory_file(standard_input()) : STDIN_FILENO;
  std::set<std::string> crashed;
  for (;;) {
    std::ofstream(folder / "entered") << "";
    if (reads_input) ::lseek(input, 0, SEEK_SET);
    const pid_t process =
        spawn_self(command_line_words(), {{input, STDIN_FILENO}, {STDOUT_FILENO, STDOUT_FILENO}},
                   {fmt::format("{}={}", folder_variable, folder.string())});
    const End end = wait_and_pass_signals(process);
    if (WIFEXITED(end.status)) return WEXITSTATUS(end.status);
    const int signal = WTERMSIG(end.status);
    if (const std::string status = last_line(folder / "status"); !status.empty())
      return std::atoi(status.c_str());  // it crashed only at exit
    // A signal that arrives before the child handles signals kills it.
    if (end.interrupted || signal == SIGINT || signal == SIGTERM || signal == SIGHUP) return exit_interrupted;
    const std::string row = last_line(folder / "entered"), why = end_text(signal);
    if (row.empty() || !crashed.insert(row).second)
      throw DeviceError(fmt::format("{}, {}: `sundog check` says which device does so", why,
                                    row.empty() ? "at no row" : "again at " + row));
    tell(fmt::format("\nsundog: {}: {}; the others are measured\n", row, why));
    std::ofstream(folder / "crashed", std::ios::app) << row << '\n' << why << '\n';
  }
}

int measure_for_first(const std::function<int()>& measure, const fs::path& folder) {
  const pid_t first = ::getppid();
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::unsetenv(folder_variable);
  Guarded& state = guarded_state();
  state.folder = folder;
  std::ifstream crashed(folder / "crashed");
  for (std::string row, why; std::getline(crashed, row) && std::getline(crashed, why);)
    state.crashed[row] = why;
  state.entered.open(folder / "entered");
  const int status = measure();
  std::ofstream(folder / "status") << status << '\n';
  std::error_code failed;
  if (::getppid() != first) fs::remove_all(folder, failed);
  return status;
}

}  // namespace

int guarded(const std::function<int()>& measure, bool reads_input) {
  if (const char* folder = std::getenv(folder_variable); folder && *folder)
    return measure_for_first(measure, folder);
  std::string name = (temporary_folder() / "sundog-bench-XXXXXX").string();
  if (!::mkdtemp(name.data())) return measure();
  const auto remove = [&](const char*) {
    std::error_code failed;
    fs::remove_all(name, failed);
  };
  const std::unique_ptr<const char, decltype(remove)> removed(name.c_str(), remove);
  return measure_in_others(name, reads_input);
}

std::string enter_row(std::string name) {
  Guarded& state = guarded_state();
  std::ranges::replace(name, '\n', ' ');  // a file's name may contain one
  if (state.folder.empty()) return "";
  state.entered << name << std::endl;  // flushed: the process may crash at once
  const auto crashed = state.crashed.find(name);
  return crashed == state.crashed.end() ? "" : crashed->second;
}

fs::path kept_for_next() {
  const fs::path& folder = guarded_state().folder;
  return folder.empty() ? fs::path() : folder / "report.json";
}

}  // namespace sundog
