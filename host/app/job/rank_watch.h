// Names the rank that has died, at once: mpirun kills the others a second after it has interrupted them, and
// by then the picture need not be written.
#pragma once
#include <atomic>
#include <set>
#include <string>
#include <thread>

#include "render/remote/mailbox.h"

namespace sundog {

/// For rank 0. Once `stop` is set, warns on stderr about each rank that no longer responds. `kept_in` is
/// where the frame's checkpoint goes; empty: nowhere. Without a job it does nothing.
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
