// Starts a program beside the test, reads its output by lines, and ends it.
#include "background_program.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
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

}  // namespace

BackgroundProgram::BackgroundProgram(const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder,
                                     const std::map<std::string, std::string>& environment) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  child_ = ::fork();
  if (child_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that crashes leaves no server behind
    ::setpgid(0, 0);
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(ends[1], STDOUT_FILENO);
    if (!folder.empty() && ::chdir(folder.c_str()) != 0) ::_exit(126);
    for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
    std::vector<char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    ::execvp(pointers[0], pointers.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  out_ = ends[0];
}

BackgroundProgram::~BackgroundProgram() {
  end();
  ::close(out_);
}

std::string BackgroundProgram::line_with(const std::string& part, double seconds) {
  const auto start = Clock::now();
  for (;;) {
    for (std::size_t end; (end = text_.find('\n')) != std::string::npos;) {
      const std::string line = text_.substr(0, end);
      text_.erase(0, end + 1);
      if (line.find(part) != std::string::npos) return line;
    }
    if (seconds_since(start) > seconds)
      throw std::runtime_error("no line with \"" + part + "\" came in time");
    pollfd stream{out_, POLLIN, 0};
    if (::poll(&stream, 1, 100) <= 0) continue;
    std::array<char, 4096> buffer;
    const ssize_t size = ::read(out_, buffer.data(), buffer.size());
    if (size <= 0) throw std::runtime_error("the program ended without a line with \"" + part + "\"");
    text_.append(buffer.data(), static_cast<std::size_t>(size));
  }
}

bool BackgroundProgram::runs() const { return child_ > 0 && ::waitpid(child_, nullptr, WNOHANG) == 0; }

/// Ends the whole process group, because a browser has children of its own.
void BackgroundProgram::end() {
  if (child_ <= 0) return;
  ::kill(-child_, SIGTERM);
  const auto start = Clock::now();
  while (::waitpid(child_, nullptr, WNOHANG) == 0) {
    if (seconds_since(start) > 5) ::kill(-child_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(-child_, SIGKILL);  // children that the first process left
  child_ = -1;
}
