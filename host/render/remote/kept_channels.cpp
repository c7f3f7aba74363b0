// Lends idle channels by peer. Closing a lent channel returns it, unless it broke; the destructor closes the
// idle ones.
#include "render/remote/kept_channels.h"

#include <map>
#include <mutex>
#include <utility>

namespace sundog {
namespace {

void end(Channel& channel) {
  try {
    channel.send({Message::close, {}, {}});
  } catch (const ChannelClosed&) {
    // The peer has already ended.
  }
}

}  // namespace

struct KeptChannels::Idle {
  std::mutex mutex;
  bool over = false;
  std::multimap<std::string, std::unique_ptr<Channel>> channels;

  std::unique_ptr<Channel> take(const std::string& peer) {
    const std::lock_guard lock(mutex);
    const auto found = channels.find(peer);
    return found == channels.end() ? nullptr : std::move(channels.extract(found).mapped());
  }
  void put(const std::string& peer, std::unique_ptr<Channel> channel) {
    const std::lock_guard lock(mutex);
    if (!over)
      channels.emplace(peer, std::move(channel));
    else
      end(*channel);
  }
};

/// A channel lent to one user, who may close it.
class KeptChannels::Lent : public Channel {
  template <class Use>
  auto watched(const Use& use) {
    try {
      return use();
    } catch (const ChannelClosed&) {
      works_ = false;
      throw;
    }
  }

 public:
  Lent(std::shared_ptr<Idle> idle, std::string peer, std::unique_ptr<Channel> channel)
      : idle_(std::move(idle)), peer_(std::move(peer)), channel_(std::move(channel)) {}
  ~Lent() override {
    if (closed_ && works_) idle_->put(peer_, std::move(channel_));
  }
  void send(const Message& message) override {
    closed_ = message.kind == Message::close;
    if (!closed_) watched([&] { channel_->send(message); });
  }
  std::optional<Message> receive(double seconds) override {
    return watched([&] { return channel_->receive(seconds); });
  }

 private:
  std::shared_ptr<Idle> idle_;
  std::string peer_;
  std::unique_ptr<Channel> channel_;
  bool closed_ = false, works_ = true;
};

KeptChannels::KeptChannels() : idle_(std::make_shared<Idle>()) {}

KeptChannels::~KeptChannels() {
  std::multimap<std::string, std::unique_ptr<Channel>> channels;
  {
    const std::lock_guard lock(idle_->mutex);
    idle_->over = true;
    channels.swap(idle_->channels);
  }
  for (const auto& [peer, channel] : channels) end(*channel);
}

KeptChannels::Connect KeptChannels::kept(std::string peer, Connect connect) const {
  return [idle = idle_, peer = std::move(peer), connect = std::move(connect)] {
    std::unique_ptr<Channel> channel = idle->take(peer);
    if (!channel) channel = connect();
    return std::make_unique<Lent>(idle, peer, std::move(channel));
  };
}

}  // namespace sundog
