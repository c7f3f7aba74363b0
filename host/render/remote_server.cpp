#include "render/remote_server.h"

#include <fmt/format.h>

#include "render/remote_values.h"

namespace sundog {
namespace {

constexpr double look_again = 0.005;  // seconds between looks at the flags while a tile is made elsewhere

/// What the other side failed at, as the exception that it was there.
[[noreturn]] void rethrow(const nlohmann::json& failure) {
  const std::string what = failure.at("what");
  if (failure.value("usage", false)) throw UsageError(what);
  if (failure.value("build", false)) throw BuildError(what, failure.value("log", ""));
  throw DeviceError(what, failure.value("status", 0));
}

}  // namespace

Message RemoteServer::answer(Message::Kind expected, const StopFlags& flags) {
  bool stopped = false;
  while (true) {
    if (!stopped && flags.set()) {
      stopped = true;
      channel_->send({Message::stop, {{"job", job_}}, {}});
    }
    std::optional<Message> message = channel_->receive(look_again);
    if (!message) continue;
    if (message->kind == Message::failed) rethrow(message->values);
    if (message->kind == expected && message->values.value("job", job_) == job_) return std::move(*message);
  }
}

RenderTimes RemoteServer::try_open() {
  if (!channel_) channel_ = device_.connect();
  channel_->send({Message::open, device_.settings, {}});
  const Message ready = answer(Message::ready, {});
  if (ready.values.at("scene").get<std::uint64_t>() != device_.scene)
    throw DeviceError(
        fmt::format("{}: its process read another scene: a file has changed, or sundog's versions differ",
                    device_.info.label()));
  return ready.values.at("times").get<RenderTimes>();
}

RenderTimes RemoteServer::open() {
  while (true) {
    try {
      return try_open();
    } catch (const ChannelClosed& error) {
      channel_.reset();
      if (++restarts_ > device_.restarts) throw;
      notes_.push_back(fmt::format("{}; started again", error.what()));
    }
  }
}

TileResult RemoteServer::render(const Tile& tile, const StopFlags& flags) {
  try {
    ++job_;
    channel_->send({Message::render, {{"job", job_}, {"tile", tile}}, {}});
    const Message made = answer(Message::tile, flags);
    figures_ = made.values.at("figures").get<ServerFigures>();
    return unpack_tile(made.values, made.data);
  } catch (const ChannelClosed&) {
    channel_.reset();
    throw;
  }
}

ServerFigures RemoteServer::figures() const {
  ServerFigures all = figures_;
  all.notes.insert(all.notes.begin(), notes_.begin(), notes_.end());
  return all;
}

void RemoteServer::close() {
  if (channel_) channel_->send({Message::close, {}, {}});
  channel_.reset();
}

}  // namespace sundog
