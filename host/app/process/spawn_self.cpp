// Calls posix_spawn() on /proc/self/exe; the new process blocks no signals.
#include "app/process/spawn_self.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/auxv.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace sundog {
namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// The environment with `variables`, which replace others of the same name.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
  std::vector<std::string> result = variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry, name = text.substr(0, text.find('=') + 1);
    const auto same_name = [&](const std::string& variable) { return variable.starts_with(name); };
    if (std::ranges::none_of(variables, same_name)) result.push_back(text);
  }
  return result;
}

class SpawnedSelf : public StartedProgram {
 public:
  explicit SpawnedSelf(pid_t process) : process_(process) {}
  std::optional<ProgramEnd> ended() override {
    if (end_) return end_;
    int status = 0;
    const pid_t ended = ::waitpid(process_, &status, WNOHANG);
    if (ended == process_)
      end_ = WIFSIGNALED(status) ? ProgramEnd{0, WTERMSIG(status)} : ProgramEnd{WEXITSTATUS(status), 0};
    else if (ended < 0 && errno != EINTR)
      end_ = ProgramEnd{-1, 0};  // other code has waited for it, so its status is unknown
    return end_;
  }
  void end() override {
    if (!ended()) ::kill(process_, SIGKILL);
  }

 private:
  pid_t process_;
  std::optional<ProgramEnd> end_;
};

constexpr const char* own_link = "/proc/self/exe";

/// The path with which this program was started. It may be relative; no code changes the working directory.
const char* started_file() {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): an address
  return reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
}

}  // namespace

std::filesystem::path program_file() {
  std::error_code failed;
  const std::filesystem::path file = std::filesystem::read_symlink(own_link, failed);
  return failed ? std::filesystem::canonical(started_file(), failed) : file;
}

pid_t spawn_self(std::vector<std::string> arguments, std::vector<HandedDown> descriptors,
                 const std::vector<std::string>& variables) {
  arguments.insert(arguments.begin(), "sundog");
  std::vector<std::string> environment = environment_with(variables);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO})
    if (std::ranges::find(descriptors, stream, &HandedDown::there) == descriptors.end())
      descriptors.push_back({nowhere, stream});
  for (const HandedDown& one : descriptors)
    if (one.here == nowhere)
      ::posix_spawn_file_actions_addopen(&actions, one.there, "/dev/null", O_RDWR, 0);
    else
      ::posix_spawn_file_actions_adddup2(&actions, one.here, one.there);
  // The new process must not inherit blocked signals.
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t none;
  ::sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t process = 0;
  const char* file = ::access(own_link, X_OK) == 0 ? own_link : started_file();
  const int failed = ::posix_spawn(&process, file, &actions, &attributes, pointers(arguments).data(),
                                   pointers(environment).data());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw IoError(std::string("sundog cannot start itself: ") + std::strerror(failed));
  return process;
}

std::unique_ptr<StartedProgram> start_self(std::vector<std::string> arguments,
                                           std::vector<HandedDown> descriptors) {
  return std::make_unique<SpawnedSelf>(spawn_self(std::move(arguments), std::move(descriptors)));
}

int wait_for_end(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

}  // namespace sundog
