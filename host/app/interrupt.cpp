#include "app/interrupt.h"

#include <signal.h>
#include <unistd.h>

namespace sundog {
namespace {

std::atomic<bool> stop_asked = false;  // what a signal handler may touch is lock-free and static
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr int signals[] = {SIGINT, SIGTERM};
struct sigaction previous[2];

extern "C" void on_signal(int) {
  if (stop_asked.exchange(true)) ::_exit(130);
}

}  // namespace

StopOnSignal::StopOnSignal() {
  stop_asked = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (int i = 0; i < 2; ++i) ::sigaction(signals[i], &action, &previous[i]);
}

StopOnSignal::~StopOnSignal() {
  for (int i = 0; i < 2; ++i) ::sigaction(signals[i], &previous[i], nullptr);
}

const std::atomic<bool>& StopOnSignal::flag() const { return stop_asked; }

}  // namespace sundog
