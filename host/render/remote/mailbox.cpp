// A thread sends and receives messages in pieces, each headed by its channel's number and a last-piece flag,
// 4 bytes each. Channel 0 connects the mailboxes themselves.
#include "render/remote/mailbox.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>

namespace sundog {
namespace {

constexpr std::size_t largest_piece = std::size_t{4} << 20, piece_head = 8;
constexpr std::uint32_t control = 0;

// Multiplies rank 0's silence limit, because a user who suspends rank 0 wants to resume it.
constexpr double patience_with_rank_0 = 6;

// At the end of the job, ranks silent for this long are not waited for.
constexpr double silence_at_end = 2;

// Polling interval of the transport: the shortest while messages arrive, rising to the longest when idle.
constexpr std::chrono::microseconds shortest_pause{50}, longest_pause{1000};

using Lock = std::unique_lock<std::mutex>;

std::chrono::duration<double> seconds_of(double seconds) { return std::chrono::duration<double>(seconds); }

}  // namespace

class Mailbox::RankChannel : public Channel {
 public:
  RankChannel(std::shared_ptr<State> state, Key key, std::string name)
      : state_(std::move(state)), key_(key), name_(std::move(name)) {}
  ~RankChannel() override {
    const Lock lock(state_->mutex);
    state_->inboxes.erase(key_);
  }
  void send(const Message& message) override {
    const Lock lock(state_->mutex);
    throw_when_closed();
    post(*state_, key_.first, key_.second, message);
  }
  std::optional<Message> receive(double seconds) override {
    Lock lock(state_->mutex);
    std::deque<Message>& messages = state_->inboxes[key_].messages;
    state_->arrived.wait_for(lock, seconds_of(seconds),
                             [&] { return !messages.empty() || state_->over || peer().gone; });
    if (messages.empty()) {
      throw_when_closed();
      return std::nullopt;
    }
    Message message = std::move(messages.front());
    messages.pop_front();
    return message;
  }

 private:
  const Peer& peer() const { return state_->peers[static_cast<std::size_t>(key_.first)]; }
  void throw_when_closed() const {
    if (peer().gone) throw ChannelClosed(peer().why);
    if (state_->over) throw ChannelClosed(fmt::format("{}: the job is over", name_));
  }

  std::shared_ptr<State> state_;
  Key key_;
  std::string name_;
};

/// Requires the state's mutex.
void Mailbox::post(State& state, int rank, std::uint32_t channel, const Message& message) {
  const std::string bytes = pack(message);
  for (std::size_t at = 0; at < bytes.size(); at += largest_piece) {
    const std::size_t size = std::min(largest_piece, bytes.size() - at);
    const std::uint32_t last = at + size == bytes.size();
    std::string piece(piece_head, '\0');
    std::memcpy(piece.data(), &channel, sizeof channel);
    std::memcpy(piece.data() + sizeof channel, &last, sizeof last);
    state.outgoing.push_back({rank, piece.append(bytes, at, size)});
  }
  state.outgoing_changed.notify_one();
}

Mailbox::Mailbox(const std::function<std::unique_ptr<Transport>()>& open, double limit) : limit_(limit) {
  std::promise<void> opened;
  std::future<void> ready = opened.get_future();
  thread_ = std::thread([this, open, opened = std::move(opened)]() mutable {
    std::unique_ptr<Transport> transport;
    try {
      transport = open();
    } catch (...) {
      opened.set_exception(std::current_exception());
      return;
    }
    rank_ = transport->rank();
    hosts_ = transport->hosts();
    state_->peers.resize(hosts_.size());
    opened.set_value();
    run(*transport);
  });
  try {
    ready.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

Mailbox::~Mailbox() {
  {
    const Lock lock(state_->mutex);
    state_->over = true;
  }
  state_->outgoing_changed.notify_one();
  state_->arrived.notify_all();
  thread_.join();
}

std::string Mailbox::name(int rank) const { return fmt::format("rank {} on {}", rank, host(rank)); }

void Mailbox::run(Transport& transport) {
  for (auto pause = shortest_pause;; pause = std::min(2 * pause, longest_pause)) {
    std::deque<Outgoing> outgoing;
    std::optional<int> abort;
    bool over = false, finish = false;
    beat();
    {
      Lock lock(state_->mutex);
      state_->outgoing_changed.wait_for(
          lock, pause, [&] { return !state_->outgoing.empty() || state_->over || state_->abort; });
      outgoing.swap(state_->outgoing);
      abort = state_->abort;
      over = state_->over;
      finish = state_->finish;
    }
    if (!outgoing.empty()) pause = shortest_pause;
    for (Outgoing& each : outgoing) transport.post(each.rank, std::move(each.piece));
    while (const std::optional<Parcel> parcel = transport.take()) {
      arrive(*parcel);
      pause = shortest_pause;
    }
    look_for_silence();
    if (abort) transport.abort(*abort);
    if (over) {
      if (finish) transport.finish();
      return;
    }
  }
}

void Mailbox::arrive(const Parcel& parcel) {
  if (parcel.bytes.size() < piece_head) return;
  std::uint32_t channel = 0, last = 0;
  std::memcpy(&channel, parcel.bytes.data(), sizeof channel);
  std::memcpy(&last, parcel.bytes.data() + sizeof channel, sizeof last);
  const Lock lock(state_->mutex);
  state_->peers[static_cast<std::size_t>(parcel.from)].silence.heard();
  if (rank_ != 0 && channel > state_->last_channel) {
    state_->last_channel = channel;
    state_->inboxes[{parcel.from, channel}];
    state_->accepted.push_back(channel);
  }
  const auto inbox = channel == control ? state_->inboxes.try_emplace({parcel.from, control}).first
                                        : state_->inboxes.find({parcel.from, channel});
  if (inbox == state_->inboxes.end()) return;  // closed on this side
  inbox->second.begun.append(parcel.bytes, piece_head);
  if (last == 0) return;
  Message message;
  try {
    message = unpack(inbox->second.begun);
  } catch (const ChannelClosed& error) {
    Peer& peer = state_->peers[static_cast<std::size_t>(parcel.from)];
    peer.gone = true;
    peer.why = fmt::format("{}: {}", name(parcel.from), error.what());
  }
  inbox->second.begun.clear();
  if (channel == control)
    take_control(parcel.from, message);
  else if (message.kind != Message::alive)
    inbox->second.messages.push_back(std::move(message));
  state_->arrived.notify_all();
}

void Mailbox::take_control(int from, const Message& message) {
  if (message.kind == Message::leave) state_->told_to_leave = true;
  if (message.kind == Message::left) state_->peers[static_cast<std::size_t>(from)].left = true;
}

/// Sends heartbeats: rank 0 to all, the others to rank 0.
void Mailbox::beat() {
  if (since_beat_.seconds() < beat_seconds) return;
  since_beat_ = Stopwatch();
  const Lock lock(state_->mutex);
  const int end = rank_ == 0 ? size() : 1;
  for (int rank = rank_ == 0; rank < end; ++rank)
    if (!state_->peers[static_cast<std::size_t>(rank)].gone)
      post(*state_, rank, control, {Message::alive, {}, {}});
}

void Mailbox::look_for_silence() {
  const Lock lock(state_->mutex);
  const int end = rank_ == 0 ? size() : 1;
  for (int rank = rank_ == 0; rank < end; ++rank) {
    Peer& peer = state_->peers[static_cast<std::size_t>(rank)];
    const double seconds = peer.silence.seconds();
    if (peer.gone || peer.left || seconds < limit_ * (rank == 0 ? patience_with_rank_0 : 1)) continue;
    peer.gone = true;
    peer.why =
        fmt::format("{} has not been heard of for {:.1f} s: it has died or is stopped", name(rank), seconds);
    if (rank == 0) state_->told_to_leave = true;
    state_->arrived.notify_all();
  }
}

std::function<std::unique_ptr<Channel>()> Mailbox::connector(int rank) const {
  return [state = state_, rank, label = name(rank)] {
    const Lock lock(state->mutex);
    const Key key{rank, ++state->last_channel};
    state->inboxes[key];
    // Registers channels at the rank in ascending order.
    post(*state, rank, key.second, {Message::alive, {}, {}});
    return std::make_unique<RankChannel>(state, key, label);
  };
}

std::unique_ptr<Channel> Mailbox::accept() {
  Lock lock(state_->mutex);
  state_->arrived.wait(lock,
                       [&] { return state_->told_to_leave || state_->over || !state_->accepted.empty(); });
  if (state_->told_to_leave || state_->over) return nullptr;
  const Key key{0, state_->accepted.front()};
  state_->accepted.pop_front();
  return std::make_unique<RankChannel>(state_, key, name(0));
}

bool Mailbox::gone(int rank) {
  const Lock lock(state_->mutex);
  return state_->peers[static_cast<std::size_t>(rank)].gone;
}

std::vector<int> Mailbox::silent_for(double seconds) {
  const Lock lock(state_->mutex);
  std::vector<int> silent;
  for (int rank = 0; rank < size(); ++rank)
    if (Peer& peer = state_->peers[static_cast<std::size_t>(rank)];
        rank != rank_ && !peer.left && peer.silence.seconds() >= seconds)
      silent.push_back(rank);
  return silent;
}

bool Mailbox::leave(int status) {
  constexpr double grace = 15;
  const Stopwatch waited;
  Lock lock(state_->mutex);
  if (rank_ != 0) {
    const bool told = !state_->peers[0].gone;
    if (told) post(*state_, 0, control, {Message::left, {}, {}});
    state_->finish = state_->over = told;
    return told;
  }
  for (int rank = 1; rank < size(); ++rank) post(*state_, rank, control, {Message::leave, {}, {}});
  const auto others_are = [&](const auto& so) {
    return std::all_of(state_->peers.begin() + 1, state_->peers.end(), so);
  };
  const auto has_left = [](const Peer& peer) { return peer.left; };
  const auto settled = [](Peer& peer) {
    return peer.left || peer.gone || peer.silence.seconds() > silence_at_end;
  };
  while (!others_are(settled) && waited.seconds() < grace) state_->arrived.wait_for(lock, seconds_of(0.05));
  if (others_are(has_left))
    state_->finish = state_->over = true;
  else
    state_->abort = status;
  state_->outgoing_changed.notify_one();
  // If ranks are missing, abort() ends the process here.
  state_->arrived.wait(lock, [&] { return state_->over; });
  return true;
}

}  // namespace sundog
