// See child_process.h.
#include "app/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "base/clock.h"
#include "base/error.h"

namespace sundog {
namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// The environment, with the variables in place of those of the same name.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
  std::vector<std::string> result = variables;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry, name = text.substr(0, text.find('=') + 1);
    bool replaced = false;
    for (const std::string& variable : variables) replaced = replaced || variable.starts_with(name);
    if (!replaced) result.push_back(text);
  }
  return result;
}

pid_t start(std::vector<std::string> arguments, const std::vector<std::string>& variables, int out) {
  arguments.insert(arguments.begin(), "sundog");
  std::vector<std::string> environment = environment_with(variables);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, pointers(arguments).data(),
                                 pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw IoError(std::string("sundog cannot start itself: ") + std::strerror(failed));
  return child;
}

/// Hands on the whole lines of `text`.
void take_lines(std::string& text, const std::function<void(const std::string&)>& on_line) {
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    on_line(text.substr(0, end));
    text.erase(0, end + 1);
  }
}

/// Reads lines to the end of the stream or of the time; false: the time was over.
bool read_lines(int stream, double seconds, const std::function<void(const std::string&)>& on_line) {
  const Stopwatch clock;
  std::string text;
  while (clock.seconds() < seconds) {
    pollfd waited{stream, POLLIN, 0};
    if (::poll(&waited, 1, 200) <= 0) continue;
    std::array<char, 4096> part;
    const ssize_t size = ::read(stream, part.data(), part.size());
    if (size <= 0) return true;
    text.append(part.data(), static_cast<std::size_t>(size));
    take_lines(text, on_line);
  }
  return false;
}

}  // namespace

ChildResult run_self(const std::vector<std::string>& arguments, const std::vector<std::string>& variables,
                     double seconds, const std::function<void(const std::string&)>& on_line) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw IoError(std::string("no pipe: ") + std::strerror(errno));
  ChildResult result;
  pid_t child = 0;
  try {
    child = start(arguments, variables, ends[1]);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
  result.timed_out = !read_lines(ends[0], seconds, on_line);
  ::close(ends[0]);
  if (result.timed_out) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace sundog
