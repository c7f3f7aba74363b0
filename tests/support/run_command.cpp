// Runs a program and collects its output, status and time.
#include "run_command.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The parent's and the child's end of a stream.
struct Stream {
  int parent = -1, child = -1;
};

Stream open_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return {ends[0], ends[1]};
}

Stream open_terminal() {
  Stream stream;
  stream.parent = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (stream.parent < 0 || ::grantpt(stream.parent) != 0 || ::unlockpt(stream.parent) != 0)
    throw std::runtime_error("no terminal");
  stream.child = ::open(::ptsname(stream.parent), O_RDWR | O_NOCTTY | O_CLOEXEC);
  winsize size{};
  size.ws_row = 25;
  size.ws_col = 80;
  ::ioctl(stream.child, TIOCSWINSZ, &size);
  return stream;
}

[[noreturn]] void become(const std::vector<std::string>& arguments, const CommandOptions& options, int out,
                         int err) {
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(126);
  for (const auto& [name, value] : options.environment)
    value.empty() ? ::unsetenv(name.c_str()) : ::setenv(name.c_str(), value.c_str(), 1);
  if (options.file_limit > 0) {
    std::signal(SIGXFSZ, SIG_IGN);  // so that a write fails as on a full disk
    const rlimit limit{options.file_limit, options.file_limit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  ::execvp(pointers[0], pointers.data());
  ::_exit(127);
}

/// Reads available bytes; false at the stream's end.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 4096> buffer;
  const ssize_t size = ::read(descriptor, buffer.data(), buffer.size());
  if (size > 0) text.append(buffer.data(), static_cast<std::size_t>(size));
  return size > 0;  // a terminal whose other side is closed gives an error
}

class Watch {
 public:
  Watch(pid_t child, const CommandOptions& options, pollfd& err)
      : child_(child), options_(options), err_(err) {}

  void step(CommandResult& result) {
    const double seconds = seconds_since(start_);
    const bool text_seen =
        !options_.signal_at.empty() && result.err.find(options_.signal_at) != std::string::npos;
    std::error_code none;
    const bool file_seen = !options_.signal_folder.empty() &&
                           std::filesystem::exists(options_.signal_folder, none) &&
                           !std::filesystem::is_empty(options_.signal_folder, none);
    if (!signalled_ && (text_seen || file_seen)) {
      signalled_ = true;
      options_.hang_up ? hang_up() : static_cast<void>(::kill(child_, options_.signal));
    }
    if (seconds > options_.timeout && !result.timed_out) {
      result.timed_out = true;
      ::kill(child_, SIGKILL);
    }
  }

  bool has_hung_up() const { return signalled_ && options_.hang_up; }

  void finish(CommandResult& result) const {
    int status = 0;
    ::waitpid(child_, &status, 0);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.seconds = seconds_since(start_);
  }

 private:
  void hang_up() {
    ::close(err_.fd);
    err_.fd = -1;
    for (int i = 0; i < 2; ++i) {
      ::kill(child_, options_.signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }

  pid_t child_;
  const CommandOptions& options_;
  pollfd& err_;
  bool signalled_ = false;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

CommandResult run_command(const std::vector<std::string>& arguments, const CommandOptions& options) {
  const Stream out = open_pipe();
  const Stream err = options.terminal ? open_terminal() : open_pipe();
  const pid_t child = ::fork();
  if (child == 0) become(arguments, options, out.child, err.child);
  ::close(out.child);
  ::close(err.child);
  CommandResult result;
  std::array<pollfd, 2> streams = {pollfd{out.parent, POLLIN, 0}, pollfd{err.parent, POLLIN, 0}};
  Watch watch(child, options, streams[1]);
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    ::poll(streams.data(), streams.size(), 20);
    if (streams[0].revents != 0 && !read_some(out.parent, result.out)) streams[0].fd = -1;
    if (streams[1].revents != 0 && !read_some(err.parent, result.err)) streams[1].fd = -1;
    watch.step(result);
  }
  watch.finish(result);
  ::close(out.parent);
  if (!watch.has_hung_up()) ::close(err.parent);
  return result;
}

CommandResult run_sundog(std::vector<std::string> arguments, const CommandOptions& options) {
  arguments.insert(arguments.begin(), SUNDOG_BINARY);
  return run_command(arguments, options);
}
