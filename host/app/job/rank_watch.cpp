// Looks for silent ranks every 10 ms once the job is interrupted.
#include "app/job/rank_watch.h"

#include <fmt/format.h>

#include <chrono>
#include <vector>

#include "app/process/warnings.h"

namespace sundog {
namespace {

// A rank that is silent for this many seconds when the job is interrupted has died: mpirun interrupts the
// others a second later, and each sends a sign of life four times a second.
constexpr double suspicious_silence = 0.7;

}  // namespace

RankWatch::RankWatch(Mailbox* job, const std::atomic<bool>& stop, std::string kept_in)
    : job_(job), stop_(stop), kept_in_(std::move(kept_in)) {
  if (job_) thread_ = std::thread([this] { watch(); });
}

RankWatch::~RankWatch() {
  leaving_ = true;
  if (thread_.joinable()) thread_.join();
}

void RankWatch::watch() {
  for (; !leaving_; std::this_thread::sleep_for(std::chrono::milliseconds(10)))
    if (stop_) look();
}

void RankWatch::look() {
  std::vector<std::string> sentences;
  for (const int rank : job_->silent_for(suspicious_silence))
    if (named_.insert(rank).second)
      sentences.push_back(
          fmt::format("{} says nothing any more: it has died or is stopped; mpirun ends all ranks when one "
                      "dies, with --enable-recovery the others continue{}",
                      job_->name(rank), kept_in_.empty() ? "" : "; finished work is kept in " + kept_in_));
  print_warnings(sentences);
}

}  // namespace sundog
