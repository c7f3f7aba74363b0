// Reads a child's lines until it ends; kills it on timeout.
#include "app/process/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/clock.h"
#include "base/error.h"

namespace sundog {
namespace {

/// Passes on the complete lines of `text` and removes them.
void take_lines(std::string& text, const std::function<void(const std::string&)>& on_line) {
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    on_line(text.substr(0, end));
    text.erase(0, end + 1);
  }
}

/// Reads lines to the end of the stream; returns false on timeout.
bool read_lines(int stream, double seconds, const std::function<void(const std::string&)>& on_line) {
  const Stopwatch clock;
  std::string text;
  while (clock.seconds() < seconds) {
    pollfd waited{stream, POLLIN, 0};
    if (::poll(&waited, 1, 200) <= 0) continue;
    std::array<char, 4096> part;
    const ssize_t size = ::read(stream, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return true;
    text.append(part.data(), static_cast<std::size_t>(size));
    take_lines(text, on_line);
  }
  return false;
}

}  // namespace

ChildResult run_self(const std::vector<std::string>& arguments, const std::vector<std::string>& variables,
                     double seconds, const std::function<void(const std::string&)>& on_line,
                     std::vector<HandedDown> descriptors) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw IoError(std::string("no pipe: ") + std::strerror(errno));
  ChildResult result;
  pid_t child = 0;
  try {
    const bool speaks =
        std::ranges::any_of(descriptors, [](const HandedDown& d) { return d.there == STDERR_FILENO; });
    if (!speaks) descriptors.push_back({nowhere, STDERR_FILENO});
    descriptors.insert(descriptors.begin(), {ends[1], STDOUT_FILENO});
    child = spawn_self(arguments, std::move(descriptors), variables);
  } catch (...) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw;
  }
  ::close(ends[1]);
  result.timed_out = !read_lines(ends[0], seconds, on_line);
  ::close(ends[0]);
  if (result.timed_out) ::kill(child, SIGKILL);
  const int status = wait_for_end(child);
  if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace sundog
