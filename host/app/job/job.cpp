// Collects the devices of each rank, selects among them by SPECs, and assigns each device of a machine to one
// rank.
#include "app/job/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/job/remote_devices.h"
#include "app/options/devices.h"
#include "app/process/environment.h"
#include "app/process/warnings.h"
#include "base/error.h"
#include "render/film/hash.h"
#include "render/frame/local_worker.h"
#include "render/plan/deal_devices.h"
#include "render/remote/remote_values.h"
#include "render/remote/remote_worker.h"
#include "render/remote/tile_worker.h"

namespace sundog {
namespace {

// Seconds that a rank may take to list its devices.
constexpr double patience_with_drivers = 60;

struct Listed {
  std::vector<DeviceInfo> devices;
  unsigned cores = 0;
};

/// Waits for a rank's list of devices. Throws DeviceError.
Listed list_of(Channel& channel, const std::string& name) {
  const Stopwatch waited;
  while (waited.seconds() < patience_with_drivers) {
    const std::optional<Message> answer = channel.receive(1);
    if (!answer) continue;
    return understood(name, [&]() -> Listed {
      if (answer->kind == Message::failed)
        throw DeviceError(fmt::format("{}: {}", name, answer->values.at("what").get<std::string>()));
      channel.send({Message::close, {}, {}});
      return {answer->values.at("devices").get<std::vector<DeviceInfo>>(),
              answer->values.at("cores").get<unsigned>()};
    });
  }
  throw DeviceError(
      fmt::format("{}: its drivers have not listed their devices for {} s", name, patience_with_drivers));
}

/// Selects by SPECs; without any, takes the fastest device and others like it, for the ranks of a machine.
std::vector<DeviceInfo> choose(const std::vector<DeviceInfo>& all, const std::vector<std::string>& specs,
                               std::vector<std::string>& warnings) {
  std::vector<DeviceInfo> chosen = select_devices(all, specs, &warnings);
  if (!specs.empty()) return chosen;
  const DeviceInfo best = chosen.front();
  for (const DeviceInfo& device : all)
    if (device.usable() && device.platform == best.platform && device.device != best.device &&
        device.name == best.name && device.type != "cpu")
      chosen.push_back(device);
  return chosen;
}

/// Collects the devices that the command selects on each rank. Warns about ranks without any.
class Choice {
 public:
  explicit Choice(Mailbox& job) : job_(job), ranks_(static_cast<std::size_t>(job.size())) {}

  /// `list` returns the rank's devices, or throws DeviceError.
  template <class List>
  void add(int rank, const std::vector<std::string>& specs, const List& list) {
    try {
      const Listed listed = list();
      RankDevices& mine = ranks_[static_cast<std::size_t>(rank)];
      std::vector<std::string> warnings;
      mine = {listed.cores, choose(listed.devices, specs, warnings)};
      for (const std::string& warning : warnings)
        warnings_.push_back(fmt::format("{}: {}", job_.name(rank), warning));
      for (DeviceInfo& device : mine.devices) {
        device.rank = rank;
        device.threads = driver_threads();
        device.host = job_.host(rank);
      }
    } catch (const DeviceError& error) {
      const std::string name = job_.name(rank), what = error.what();
      warnings_.push_back(what.starts_with(name) ? what : fmt::format("{}: {}", name, what));
    }
  }
  std::vector<DeviceInfo> deal(bool verbose) const {
    std::vector<DeviceInfo> dealt = deal_devices(ranks_);
    if (dealt.empty()) throw DeviceError(warnings_.empty() ? "no device to render on" : warnings_.front());
    print_warnings(warnings_);
    for (int rank = 0; verbose && rank < job_.size(); ++rank)
      if (std::ranges::count(dealt, rank, &DeviceInfo::rank) == 0)
        fmt::print("{} has nothing to do: other ranks have the devices of its machine\n", job_.name(rank));
    return dealt;
  }

 private:
  Mailbox& job_;
  std::vector<RankDevices> ranks_;
  std::vector<std::string> warnings_;
};

/// An index for the cores that the device shares (the first rank of its machine); -1 if it shares none.
int processor_of(const Mailbox& job, const DeviceInfo& device) {
  if (!device.shares_cores()) return -1;
  int first = 0;
  while (job.host(first) != device.host) ++first;
  return first;
}

/// Plans a worker on another rank. Without --isolate, that rank itself keeps its devices between frames.
WorkerPlan plan_rank(Mailbox& job, const RenderCommand& command, const DeviceInfo& device, std::uint64_t hash,
                     const KeptChannels& workers) {
  nlohmann::json settings = remote_settings(command, device);
  settings["isolate"] = command.isolate;
  KeptChannels::Connect connect = job.connector(device.rank);
  if (command.isolate) connect = connect_worker(command, device, workers, std::move(connect));
  const RemoteDevice remote{device,
                            processor_of(job, device),
                            std::move(connect),
                            std::move(settings),
                            hash,
                            command.isolate ? worker_restarts : 0,
                            command.isolate ? worker_restarts + 1 : 3};
  return {device, remote.processor,
          [remote](const RenderOptions&) { return std::make_shared<RemoteWorker>(remote); }};
}

}  // namespace

std::vector<DeviceInfo> job_devices(Mailbox& job, const RenderCommand& command) {
  std::vector<std::unique_ptr<Channel>> channels;
  for (int rank = 1; rank < job.size(); ++rank) {
    channels.push_back(job.connect(rank));
    channels.back()->send({Message::list, {{"isolate", command.isolate}}, {}});
  }
  Choice choice(job);
  choice.add(0, command.devices, [&] {
    return Listed{command.isolate ? enumerate_in_worker() : list_devices(), usable_cores()};
  });
  for (int rank = 1; rank < job.size(); ++rank)
    choice.add(rank, command.devices,
               [&] { return list_of(*channels[static_cast<std::size_t>(rank - 1)], job.name(rank)); });
  return choice.deal(command.verbose && !command.quiet);
}

std::vector<WorkerPlan> plan_job(Mailbox& job, const RenderCommand& command,
                                 const std::vector<DeviceInfo>& devices,
                                 const std::shared_ptr<const CompiledScene>& scene,
                                 const KeptChannels& workers) {
  const std::uint64_t hash = hash_scene(*scene);
  std::vector<WorkerPlan> plans;
  for (const DeviceInfo& device : devices) {
    if (job.gone(device.rank)) continue;
    plans.push_back(device.rank > 0   ? plan_rank(job, command, device, hash, workers)
                    : command.isolate ? plan_isolated(command, device, hash, workers)
                                      : plan_local(scene, device));
    plans.back().processor = processor_of(job, device);
  }
  if (plans.empty()) throw DeviceError("every rank that had devices is gone");
  return plans;
}

}  // namespace sundog
