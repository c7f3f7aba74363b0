// Reports a dead rank at once: mpirun kills the other ranks a second after it has interrupted them, when the
// picture may not be written yet.
#pragma once
#include <atomic>
#include <set>
#include <string>
#include <thread>

#include "render/remote/mailbox.h"

namespace sundog {

/// For rank 0. Once `stop` is set, warns on stderr about each rank that no longer responds. `kept_in`: the
/// frame's checkpoint file; empty: none. Does nothing without a job.
class RankWatch {
 public:
  RankWatch(Mailbox* job, const std::atomic<bool>& stop, std::string kept_in);
  ~RankWatch();
  RankWatch(const RankWatch&) = delete;
  RankWatch& operator=(const RankWatch&) = delete;

 private:
  void watch();
  void look();

  Mailbox* job_;
  const std::atomic<bool>& stop_;
  std::string kept_in_;
  std::set<int> named_;
  std::atomic<bool> leaving_{false};
  std::thread thread_;
};

}  // namespace sundog
