// Keeps a descriptor of the original standard output, and reads the standard input once.
#include "app/process/standard_streams.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>

#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

constexpr std::size_t most_input = std::size_t{1} << 30;

std::mutex mutex;
std::optional<std::string> input;
int output = STDOUT_FILENO;
bool output_is_closed = false;

std::string read_standard_input() {
  if (::isatty(STDIN_FILENO))
    throw UsageError(
        "-: wanted a scene through a pipe or from a file, found a terminal as the standard input");
  std::string text;
  std::array<char, 1 << 16> part;
  while (true) {
    const ssize_t size = ::read(STDIN_FILENO, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) throw IoError(fmt::format("the standard input cannot be read: {}", std::strerror(errno)));
    if (size == 0) return text;
    text.append(part.data(), static_cast<std::size_t>(size));
    if (text.size() > most_input) throw IoError("the standard input holds more than 1 GiB");
  }
}

/// During its lifetime, a named pipe's reader that leaves early causes an error instead of a signal.
class BrokenPipesAreErrors {
 public:
  BrokenPipesAreErrors() = default;
  ~BrokenPipesAreErrors() { std::signal(SIGPIPE, before_); }
  BrokenPipesAreErrors(const BrokenPipesAreErrors&) = delete;
  BrokenPipesAreErrors& operator=(const BrokenPipesAreErrors&) = delete;

 private:
  void (*before_)(int) = std::signal(SIGPIPE, SIG_IGN);
};

}  // namespace

void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    output_is_closed |= stream == STDOUT_FILENO;
    ::open("/dev/null", O_RDWR);  // takes the lowest free number
  }
}

void require_standard_output() {
  if (output_is_closed) throw UsageError("the standard output is closed: send it to a file or a pipe");
}

void flush_standard_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw IoError("the standard output cannot be written");
}

bool is_standard_stream(const std::filesystem::path& path) { return path == "-"; }

const std::string& standard_input() {
  const std::lock_guard lock(mutex);
  if (!input) input = read_standard_input();
  return *input;
}

void set_standard_input(std::string text) {
  const std::lock_guard lock(mutex);
  input = std::move(text);
}

void claim_standard_output() {
  require_standard_output();
  std::fflush(stdout);
  const int kept = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (kept < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    throw IoError(fmt::format("the standard output cannot be written: {}", std::strerror(errno)));
  output = kept;
  std::signal(SIGPIPE, SIG_IGN);
}

void write_output(const std::filesystem::path& path, std::string_view bytes,
                  const std::shared_ptr<Faults>& faults) {
  if (!is_standard_stream(path)) {
    const BrokenPipesAreErrors scope;
    return write_file(path, bytes, faults);
  }
  while (!bytes.empty()) {
    const ssize_t size = ::write(output, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) throw IoError(fmt::format("the standard output cannot be written: {}", write_error(errno)));
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
}

}  // namespace sundog
