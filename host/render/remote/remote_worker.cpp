// Sends orders to the other process, and rethrows its failures as the original exceptions.
#include "render/remote/remote_worker.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "render/remote/remote_values.h"

namespace sundog {
namespace {

constexpr double between_flags = 0.005;  // seconds between checks of the flags while a tile is rendered

}  // namespace

/// Rethrows the other process's failure as the original exception type.
void RemoteWorker::fail(const nlohmann::json& failure) {
  std::string what = failure.at("what");
  const std::string where = fmt::format("rank {} on {}", device_.info.rank, device_.info.host);
  if (!device_.info.host.empty() && what.find(where) == std::string::npos)
    what = fmt::format("{}: {}", where, what);
  if (failure.value("hangs", false)) hangs_ = what;
  if (failure.value("closed", false)) throw ChannelClosed(what);
  if (failure.value("usage", false)) throw UsageError(what);
  if (failure.value("build", false)) throw BuildError(what, failure.value("log", ""));
  throw DeviceError(what, failure.value("status", 0));
}

Message RemoteWorker::answer(Message::Kind expected, const StopFlags& flags) {
  bool stopped = false;
  while (true) {
    if (!stopped && flags.set()) {
      stopped = true;
      channel_->send({Message::stop, {{"job", job_}}, {}});
    }
    std::optional<Message> message = channel_->receive(between_flags);
    if (!message) continue;
    if (message->kind == Message::failed) fail(message->values);
    if (message->kind == expected && message->values.value("job", job_) == job_) return std::move(*message);
  }
}

RenderTimes RemoteWorker::try_open() {
  if (!channel_) channel_ = device_.connect();
  channel_->send({Message::open, device_.settings, {}});
  return understood(device_.info.label(), [&] {
    const Message ready = answer(Message::ready, {});
    if (ready.values.at("scene").get<std::uint64_t>() != device_.scene)
      throw DeviceError(
          fmt::format("{}: its process read another scene: a file has changed, or sundog's versions differ",
                      device_.info.label()));
    return ready.values.at("times").get<RenderTimes>();
  });
}

RenderTimes RemoteWorker::open() {
  while (true) {
    if (!hangs_.empty()) throw DeviceError(hangs_);
    try {
      return try_open();
    } catch (const ChannelClosed& error) {
      channel_.reset();
      if (++restarts_ > device_.restarts) throw;
      notes_.push_back(fmt::format("{}; started again", error.what()));
    }
  }
}

TileResult RemoteWorker::render(const TileRequest& request, const StopFlags& flags) {
  try {
    ++job_;
    PackedTile packed = pack_request(request);
    packed.values["job"] = job_;
    channel_->send({Message::render, std::move(packed.values), std::move(packed.data)});
    return understood(device_.info.label(), [&] {
      const Message made = answer(Message::tile, flags);
      figures_ = made.values.at("figures").get<WorkerFigures>();
      const auto aovs = device_.settings.at("aovs").get<std::vector<std::string>>();
      return unpack_tile(made.values, made.data, request, aovs);
    });
  } catch (const ChannelClosed&) {
    channel_.reset();
    throw;
  }
}

WorkerFigures RemoteWorker::figures() const {
  WorkerFigures all = figures_;
  all.notes.insert(all.notes.begin(), notes_.begin(), notes_.end());
  return all;
}

void RemoteWorker::close() {
  if (channel_) channel_->send({Message::close, {}, {}});
  channel_.reset();
}

}  // namespace sundog
