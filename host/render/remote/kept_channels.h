// Keeps channels to workers open from one frame to the next.
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
  /// Sends `close` to the peers of idle channels, and waits for them to end.
  ~KeptChannels();
  KeptChannels(const KeptChannels&) = delete;
  KeptChannels& operator=(const KeptChannels&) = delete;

  /// A function that connects to the peer of this name, reusing a channel that an earlier user closed, if
  /// any. It may outlive this object. Its channels, once closed, are kept unless they have failed.
  Connect kept(std::string peer, Connect connect) const;

 private:
  struct Idle;
  class Lent;
  std::shared_ptr<Idle> idle_;
};

}  // namespace sundog
