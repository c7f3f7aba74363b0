// Executes orders one by one; a thread reads the channel, so that a tile can be cancelled at once.
#include "render/remote/tile_worker.h"

#include <sched.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "render/remote/remote_values.h"

namespace sundog {
namespace {

Message failure(const std::exception& error) {
  nlohmann::json values = {{"what", error.what()}};
  if (const auto* device = dynamic_cast<const DeviceError*>(&error)) values["status"] = device->status;
  if (const auto* build = dynamic_cast<const BuildError*>(&error)) {
    values["build"] = true;
    values["log"] = build->log;
  }
  if (dynamic_cast<const UsageError*>(&error)) values["usage"] = true;
  return {Message::failed, values, {}};
}

/// The current frame's worker.
struct Current {
  OpenedWorker opened;
  nlohmann::json settings;
};

Message opened(Current& current, const Message& order,
               const std::function<OpenedWorker(const nlohmann::json&)>& make) {
  if (!current.opened.worker || current.settings != order.values) {
    if (const auto last = std::exchange(current.opened, {}); last.worker) last.worker->close();
    current.opened = make(order.values);
    current.settings = order.values;
  }
  const RenderTimes times = current.opened.worker->open();
  return {Message::ready, {{"times", times}, {"scene", current.opened.scene}}, {}};
}

Message made(DeviceWorker& worker, const Message& order, const StopFlags& flags) {
  PackedTile packed = pack_tile(worker.render(unpack_request(order.values, order.data), flags));
  packed.values["job"] = order.values.at("job");
  packed.values["figures"] = worker.figures();
  return {Message::tile, std::move(packed.values), std::move(packed.data)};
}

}  // namespace

unsigned usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return ::sched_getaffinity(0, sizeof set, &set) == 0 ? static_cast<unsigned>(CPU_COUNT(&set)) : 0;
}

Orders::Orders(Channel& channel, std::function<void()> on_closed)
    : channel_(channel), on_closed_(std::move(on_closed)), thread_([this] { read(); }) {}

Orders::~Orders() {
  leaving_ = true;
  thread_.join();
}

void Orders::read() {
  try {
    while (!leaving_) {
      std::optional<Message> message = channel_.receive(0.05);
      if (!message) continue;
      const bool last = message->kind == Message::close;
      take(std::move(*message));
      if (last) return;
    }
  } catch (const std::exception&) {  // the peer is gone, or sends malformed data
    on_closed_();
    take({});
  }
}

void Orders::take(Message message) {
  const std::lock_guard lock(mutex_);
  if (message.kind == Message::stop) {
    stopped_job_ = message.values.at("job").get<std::uint64_t>();
    if (stopped_job_ == current_job_) unwanted_ = true;
  } else if (message.kind == Message::close) {
    closed_ = unwanted_ = true;
  } else {
    if (message.kind == Message::open) stopped_job_ = 0;  // the new frame restarts its job numbers
    waiting_.push_back(std::move(message));
  }
  changed_.notify_all();
}

std::optional<Message> Orders::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return closed_ || !waiting_.empty(); });
  if (closed_) return std::nullopt;
  Message message = std::move(waiting_.front());
  waiting_.pop_front();
  if (message.kind == Message::render) {
    current_job_ = message.values.at("job").get<std::uint64_t>();
    unwanted_ = current_job_ == stopped_job_;
  }
  return message;
}

void follow_orders(Channel& channel, Orders& orders,
                   const std::function<OpenedWorker(const nlohmann::json& settings)>& make,
                   const std::function<std::vector<DeviceInfo>()>& list) {
  Current current;
  while (const std::optional<Message> order = orders.next()) {
    Message answer;
    try {
      if (order->kind == Message::list)
        answer = {Message::devices, {{"devices", list()}, {"cores", usable_cores()}}, {}};
      else if (order->kind == Message::open)
        answer = opened(current, *order, make);
      else if (current.opened.worker)
        answer = made(*current.opened.worker, *order, {&orders.unwanted(), nullptr});
    } catch (const std::exception& error) {
      answer = failure(error);
    }
    channel.send(answer);
  }
  if (current.opened.worker) current.opened.worker->close();
}

}  // namespace sundog
