// Blocks the signals, and starts one thread that waits for them until the process ends.
#include "app/process/interrupt.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <mutex>
#include <optional>
#include <thread>

#include "app/process/exit_status.h"
#include "app/process/warnings.h"
#include "base/clock.h"

namespace sundog {
namespace {

constexpr double at_once = 0.3;  // seconds within which two signals count as one

enum class Answer { ask, end, end_silently };

/// State of the thread that waits for signals. Both live as long as the process.
struct Waiting {
  std::atomic<bool> stop_asked = false, was_continued = false;
  std::mutex mutex;  // guards the members below
  Answer answer = Answer::ask;
  std::string why;
};

Waiting& waiting() {
  static auto* const one = new Waiting;
  return *one;
}

sigset_t set_of(std::initializer_list<int> signals) {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : signals) ::sigaddset(&set, signal);
  return set;
}

/// Whether the signal is ignored, as SIGHUP is under nohup.
bool is_ignored(int signal) {
  struct sigaction action{};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// Acts on a signal. `repeats`: it may repeat the previous one, so it does not count as a second request: a
/// closing terminal and its shell both send SIGHUP, a limit on processor time sends SIGXCPU every second, and
/// a SIGTERM to a process group may also be passed on by the parent.
void answer_stop(Waiting& state, bool repeats) {
  const std::lock_guard lock(state.mutex);
  if (state.answer == Answer::end) tell(fmt::format("sundog: interrupted: {}\n", state.why));
  if (state.answer == Answer::ask && (!state.stop_asked.exchange(true) || repeats)) return;
  ::_exit(exit_interrupted);
}

void wait_for_signals(Waiting& state) {
  sigset_t set = set_of({SIGINT, SIGTERM, SIGXCPU, SIGCONT});
  if (!is_ignored(SIGHUP)) ::sigaddset(&set, SIGHUP);
  std::optional<Stopwatch> since_last;
  for (siginfo_t info{};;) {
    const int signal = ::sigwaitinfo(&set, &info);
    if (signal == SIGCONT) state.was_continued = true;
    if (signal <= 0 || signal == SIGCONT) continue;
    const bool sent_twice = info.si_code <= 0 && since_last && since_last->seconds() < at_once;
    answer_stop(state, signal == SIGHUP || signal == SIGXCPU || sent_twice);
    since_last.emplace();
  }
}

void set_answer(Answer answer, const std::string& why = "") {
  Waiting& state = waiting();
  const std::lock_guard lock(state.mutex);
  state.answer = answer;
  state.why = why;
}

}  // namespace

void hold_back(std::initializer_list<int> signals) {
  const sigset_t set = set_of(signals);
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

StopOnSignal::StopOnSignal() {
  hold_back({SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGCONT});
  ::signal(SIGPIPE, SIG_IGN);  // the reader of the messages may leave
  waiting().stop_asked = waiting().was_continued = false;
  asks();
  static std::once_flag begun;
  std::call_once(begun, [] { std::thread([] { wait_for_signals(waiting()); }).detach(); });
}

StopOnSignal::~StopOnSignal() { set_answer(Answer::end_silently); }

void StopOnSignal::asks() const { set_answer(Answer::ask); }

void StopOnSignal::ends_all(const std::string& why) const { set_answer(Answer::end, why); }

const std::atomic<bool>& StopOnSignal::flag() const { return waiting().stop_asked; }

std::atomic<bool>& StopOnSignal::continued() const { return waiting().was_continued; }

}  // namespace sundog
