// A render by several processes under mpirun: rank 0 renders, the other ranks are its device workers.
#pragma once
#include <memory>
#include <vector>

#include "app/options/options.h"
#include "compile/compiled_scene.h"
#include "render/remote/kept_channels.h"
#include "render/remote/mailbox.h"
#include "render/render.h"

namespace sundog {

/// This process's rank from the launcher's variables; -1 if it is not one of several processes.
int job_rank();

/// Connects to the other processes; null if there are none. Throws UsageError if that is not possible.
std::unique_ptr<Mailbox> join_job();

/// Serves this process's devices to rank 0; ends the process at the end of the job.
[[noreturn]] void work_for_job(std::unique_ptr<Mailbox> job);

/// For rank 0: the devices that the command selects on every rank, each device of a machine once. Without
/// --device: each rank's fastest device and others of the same name. Warns about ranks without devices;
/// throws DeviceError if no rank has any.
std::vector<DeviceInfo> job_devices(Mailbox& job, const RenderCommand& command);

/// For rank 0: plans how to reach each device. Leaves out ranks that are gone; throws DeviceError if all are.
std::vector<WorkerPlan> plan_job(Mailbox& job, const RenderCommand& command,
                                 const std::vector<DeviceInfo>& devices,
                                 const std::shared_ptr<const CompiledScene>& scene,
                                 const KeptChannels& workers);

}  // namespace sundog
