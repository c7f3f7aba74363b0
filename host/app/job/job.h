// A render that mpirun has started as several processes: rank 0 has the frame, the others serve their devices
// to it.
#pragma once
#include <memory>
#include <vector>

#include "app/options/options.h"
#include "compile/compiled_scene.h"
#include "render/remote/kept_channels.h"
#include "render/remote/mailbox.h"
#include "render/render.h"

namespace sundog {

/// This process's rank by the launcher's variables; -1: no launcher of several processes started it.
int job_rank();

/// Joins the other processes; none when there are none. Throws UsageError where that is not possible.
std::unique_ptr<Mailbox> join_job();

/// Serves this process's devices to rank 0, and ends the process when the job is over.
[[noreturn]] void serve_job(std::unique_ptr<Mailbox> job);

/// For rank 0: the devices that the command means on every rank, each device of a machine once. Without any
/// --device: each machine's fastest, and those of the same name. Throws DeviceError where no rank has any;
/// single ranks without are warned of.
std::vector<DeviceInfo> job_devices(Mailbox& job, const RenderCommand& command);

/// For rank 0: how each of them is reached. Ranks that are gone are left out while others are there.
std::vector<WorkerPlan> plan_job(Mailbox& job, const RenderCommand& command,
                                 const std::vector<DeviceInfo>& devices,
                                 const std::shared_ptr<const CompiledScene>& scene,
                                 const KeptChannels& workers);

}  // namespace sundog
