// The processes of one job to each other: channels over a Transport, served by one thread, which also says
// that this process lives and notices those that do not.
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

/// Rank 0 opens channels to the others, as many as it likes; the others accept them. Every function may be
/// called by any thread.
class Mailbox {
 public:
  /// Opens the transport in the thread that will use it. A rank that says nothing for `limit` seconds is
  /// given up; rank 0, without which the others have nothing to do, after six times that.
  Mailbox(const std::function<std::unique_ptr<Transport>()>& open, double limit);
  /// What has not left by then is left behind as it is.
  ~Mailbox();
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  int rank() const { return rank_; }
  int size() const { return static_cast<int>(hosts_.size()); }
  const std::string& host(int rank) const { return hosts_[static_cast<std::size_t>(rank)]; }
  /// "rank 2 on node7".
  std::string name(int rank) const;

  /// A new channel to that rank, which throws ChannelClosed once the rank is gone.
  std::unique_ptr<Channel> connect(int rank) { return connector(rank)(); }
  /// What makes them, and may outlive the mailbox.
  std::function<std::unique_ptr<Channel>()> connector(int rank) const;
  /// The next channel that rank 0 has opened; none when the job is over.
  std::unique_ptr<Channel> accept();
  /// Whether the rank will send nothing further.
  bool gone(int rank);
  /// The ranks of which nothing has been heard for so long.
  std::vector<int> silent_for(double seconds);

  /// The end of the job. Rank 0 tells the others, and each waits for all. When some are gone, or take more
  /// than `grace` seconds, rank 0 ends them all by force, itself with `status`. Another rank returns false
  /// when it was rank 0 that has gone.
  bool leave(int status, double grace = 15);

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
  /// What channels share with the thread; they may outlive the mailbox.
  struct State {
    std::mutex mutex;
    std::condition_variable outgoing_changed, arrived;
    std::deque<Outgoing> outgoing;
    std::map<Key, Inbox> inboxes;
    std::deque<std::uint32_t> accepted;
    std::uint32_t last_channel = 0;
    std::vector<Peer> peers;
    bool told_to_leave = false;  // rank 0 has said that the job is over, or is gone
    bool over = false;           // nothing goes or comes any more
    std::optional<int> abort;    // to end everything with that status
    bool finish = false;         // to end in good order
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
