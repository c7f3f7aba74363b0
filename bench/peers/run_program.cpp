#include "run_program.h"

#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace sundog {
namespace {

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

[[noreturn]] void become(const ProgramRun& run) {
  if (run.one_processor) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(0, &one);
    sched_setaffinity(0, sizeof one, &one);
  }
  for (const auto& [name, value] : run.environment) setenv(name.c_str(), value.c_str(), 1);
  if (!std::freopen(run.log.c_str(), "w", stdout) || dup2(1, 2) < 0) _exit(126);
  std::vector<char*> words;
  for (const std::string& word : run.command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execvp(words[0], words.data());
  _exit(127);
}

}  // namespace

Elapsed run_program(const ProgramRun& run) {
  const Stopwatch clock;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) become(run);
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || status != 0)
    throw std::runtime_error(run.command[0] + " failed; see " + run.log);
  return {clock.seconds(), seconds(used.ru_utime) + seconds(used.ru_stime)};
}

}  // namespace sundog
