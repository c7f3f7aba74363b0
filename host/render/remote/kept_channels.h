// Channels to workers that stay open from one frame to the next.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "render/remote/channel.h"

namespace sundog {

class KeptChannels {
 public:
  using Connect = std::function<std::unique_ptr<Channel>()>;

  KeptChannels();
  /// Tells the peers of channels that are not in use to end, and waits for them.
  ~KeptChannels();
  KeptChannels(const KeptChannels&) = delete;
  KeptChannels& operator=(const KeptChannels&) = delete;

  /// Connects to the peer of that name, by a channel that an earlier user has closed if there is one. The
  /// result may outlive this; its channels, once closed, are kept unless they have failed.
  Connect kept(std::string peer, Connect connect) const;

 private:
  struct Idle;
  class Lent;
  std::shared_ptr<Idle> idle_;
};

}  // namespace sundog
