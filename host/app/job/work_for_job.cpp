// Serves rank 0 of an MPI job from another rank: one thread for each channel that rank 0 opens. The thread
// renders on a device, or passes messages on to a worker process (--isolate).
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/job/job.h"
#include "app/job/remote_devices.h"
#include "app/options/devices.h"
#include "app/process/environment.h"
#include "app/process/exit_status.h"
#include "render/remote/hang_watch.h"
#include "render/remote/remote_values.h"
#include "render/remote/worker_process.h"

namespace sundog {
namespace {

// Seconds that a driver still at work at the end of the job gets to return.
constexpr double closing_grace = 10;

struct Service {
  KeptOpen kept;
  std::atomic<int> channels{0}, hanging{0};
};

/// A channel whose first message, which says what the channel is for, is read ahead and then received again.
class ReadAhead : public Channel {
 public:
  explicit ReadAhead(Channel& channel) : channel_(channel) {
    while (!first_) first_ = channel_.receive(1);
  }
  const Message& first() const { return *first_; }
  void send(const Message& message) override { channel_.send(message); }
  std::optional<Message> receive(double seconds) override {
    return first_ ? std::exchange(first_, std::nullopt) : channel_.receive(seconds);
  }

 private:
  Channel& channel_;
  std::optional<Message> first_;
};

/// Passes messages on both ways until the job orders to close. Throws ChannelClosed if either end is gone.
void pass_on(Channel& job, Channel& worker) {
  constexpr double look_again = 0.002;
  while (true) {
    if (const std::optional<Message> order = job.receive(look_again)) {
      worker.send(*order);
      if (order->kind == Message::close) return;
    }
    if (const std::optional<Message> answer = worker.receive(look_again)) job.send(*answer);
  }
}

void work_by_process(ReadAhead& channel) {
  const nlohmann::json& order = channel.first().values;
  const std::string name =
      order.contains("device") ? order["device"].get<DeviceInfo>().label() : "the list of devices";
  try {
    pass_on(channel, *start_worker(*program_environment(), name));
  } catch (const DeviceError& error) {
    channel.send({Message::failed, {{"what", error.what()}, {"closed", true}}, {}});
  }
}

void work_here(Channel& channel, Service& service) {
  Orders orders(channel, [] {});
  HangWatch watch([&](const std::string& what) {
    ++service.hanging;
    try {
      channel.send({Message::failed, {{"what", what}, {"closed", true}, {"hangs", true}}, {}});
    } catch (const ChannelClosed&) {
      // nobody is left to receive it
    }
  });
  follow_orders(
      channel, orders,
      [&](const nlohmann::json& settings) {
        OpenedWorker opened = open_worker(settings, &service.kept);
        watch.look_at(opened);
        return opened;
      },
      list_devices);
}

void work_for(Channel& opened, Service& service) {
  try {
    ReadAhead channel(opened);
    if (channel.first().values.value("isolate", false))
      work_by_process(channel);
    else
      work_here(channel, service);
  } catch (const ChannelClosed&) {
    // rank 0 is gone, or the job is over
  }
}

}  // namespace

void work_for_job(std::unique_ptr<Mailbox> job) {
  const auto service = std::make_shared<Service>();
  while (std::shared_ptr<Channel> channel = job->accept()) {
    ++service->channels;
    std::thread([service, channel]() mutable {
      work_for(*channel, *service);
      channel.reset();
      --service->channels;
    }).detach();
  }
  const Stopwatch waited;
  while (service->channels > service->hanging && waited.seconds() < closing_grace)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const bool in_order = job->leave(exit_done);
  job.reset();
  ::_exit(in_order ? exit_done : exit_failure);  // a thread may still sit in a driver
}

}  // namespace sundog
