#include "app/interrupt.h"

#include <signal.h>
#include <unistd.h>

namespace sundog {
namespace {

std::atomic<bool> stop_asked = false,
                  was_continued = false;  // what a signal handler may touch is lock-free and static
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr int signals[] = {SIGINT, SIGTERM, SIGCONT};
constexpr int count = 3;
struct sigaction previous[count];

extern "C" void on_signal(int signal) {
  if (signal == SIGCONT)
    was_continued = true;
  else if (stop_asked.exchange(true))
    ::_exit(130);
}

}  // namespace

StopOnSignal::StopOnSignal() {
  stop_asked = was_continued = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (int i = 0; i < count; ++i) ::sigaction(signals[i], &action, &previous[i]);
}

StopOnSignal::~StopOnSignal() {
  for (int i = 0; i < count; ++i) ::sigaction(signals[i], &previous[i], nullptr);
}

const std::atomic<bool>& StopOnSignal::flag() const { return stop_asked; }

std::atomic<bool>& StopOnSignal::continued() const { return was_continued; }

}  // namespace sundog
