// Connects the processes of a job: channels over a Transport, served by one thread, which also sends
// heartbeats and detects dead processes.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "render/remote/channel.h"
#include "render/remote/silence.h"
#include "render/remote/transport.h"

namespace sundog {

/// Rank 0 opens any number of channels to the other ranks, which accept them. Thread-safe.
class Mailbox {
 public:
  /// Opens the transport in the thread that will use it. A rank that is silent for `limit` seconds is given
  /// up; rank 0, on which the others depend, after six times that.
  Mailbox(const std::function<std::unique_ptr<Transport>()>& open, double limit);
  /// Discards unsent messages.
  ~Mailbox();
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  int rank() const { return rank_; }
  int size() const { return static_cast<int>(hosts_.size()); }
  const std::string& host(int rank) const { return hosts_[static_cast<std::size_t>(rank)]; }
  /// The rank for messages: "rank 2 on node7".
  std::string name(int rank) const;

  /// Opens a channel to this rank. The channel throws ChannelClosed once the rank is gone.
  std::unique_ptr<Channel> connect(int rank) { return connector(rank)(); }
  /// A factory of channels to this rank; it may outlive the mailbox.
  std::function<std::unique_ptr<Channel>()> connector(int rank) const;
  /// The next channel opened by rank 0; none when the job is over.
  std::unique_ptr<Channel> accept();
  /// Whether the rank will send nothing more.
  bool gone(int rank);
  /// The ranks that have been silent for this long.
  std::vector<int> silent_for(double seconds);

  /// Ends the job. Rank 0 notifies the others and waits for them. If some are gone, or take longer than 15
  /// seconds, rank 0 kills them all and exits with `status`. Other ranks return false if rank 0 is gone.
  bool leave(int status);

 private:
  using Key = std::pair<int, std::uint32_t>;  // rank, channel
  struct Outgoing {
    int rank;
    std::string piece;
  };
  struct Inbox {
    std::string begun;  // the first pieces of a message
    std::deque<Message> messages;
  };
  struct Peer {
    Silence silence;
    bool gone = false, left = false;
    std::string why;
  };
  /// Shared by the channels and the thread; may outlive the mailbox.
  struct State {
    std::mutex mutex;
    std::condition_variable outgoing_changed, arrived;
    std::deque<Outgoing> outgoing;
    std::map<Key, Inbox> inboxes;
    std::deque<std::uint32_t> accepted;
    std::uint32_t last_channel = 0;
    std::vector<Peer> peers;
    bool told_to_leave = false;  // rank 0 has ended the job, or is gone
    bool over = false;           // no more traffic
    std::optional<int> abort;    // kill all ranks and exit with this status
    bool finish = false;         // end in an orderly way
  };
  class RankChannel;

  void run(Transport& transport);
  void arrive(const Parcel& parcel);
  void take_control(int from, const Message& message);
  void beat();
  void look_for_silence();
  static void post(State& state, int rank, std::uint32_t channel, const Message& message);

  int rank_ = 0;
  double limit_;
  std::vector<std::string> hosts_;
  std::shared_ptr<State> state_ = std::make_shared<State>();
  Stopwatch since_beat_;
  std::thread thread_;
};

}  // namespace sundog
