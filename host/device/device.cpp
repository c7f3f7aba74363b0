// Opens a device; handles its memory, launches and timing.
#include "device/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "device/cl_status.h"
#include "device/empty_launch.h"
#include "device/kernel_source.h"
#include "device/program.h"

namespace sundog {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }

std::size_t padded(std::size_t size, std::size_t local) {
  return local ? (size + local - 1) / local * local : size;
}

/// The requested part of the device; other parts are released.
cl::Device sub_device(cl::Device parent, const DeviceInfo& info) {
  // Checked first, because clCreateSubDevices may crash in drivers that cannot split (rusticl 22.3.6).
  if (info.max_sub_devices == 0)
    throw DeviceError(fmt::format("{}: cannot be split: drop the /{}", info.label(), info.sub_units));
  const auto units = static_cast<cl_device_partition_property>(info.sub_units);
  const auto kinds = parent.getInfo<CL_DEVICE_PARTITION_PROPERTIES>();
  const bool by_counts =
      std::ranges::count(kinds, cl_device_partition_property{CL_DEVICE_PARTITION_BY_COUNTS}) > 0;
  const auto before = static_cast<cl_device_partition_property>(info.first_unit);
  const cl_device_partition_property counts[] = {CL_DEVICE_PARTITION_BY_COUNTS, before > 0 ? before : units,
                                                 before > 0 ? units : CL_DEVICE_PARTITION_BY_COUNTS_LIST_END,
                                                 CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
  const cl_device_partition_property equally[] = {CL_DEVICE_PARTITION_EQUALLY, units, 0};
  std::vector<cl::Device> parts;
  check_cl(parent.createSubDevices(by_counts ? counts : equally, &parts), info,
           fmt::format("clCreateSubDevices for {} compute units", info.sub_units));
  const std::size_t index = by_counts ? before > 0 : info.first_unit / info.sub_units;
  if (index >= parts.size() || (!by_counts && info.first_unit % info.sub_units != 0))
    throw DeviceError(
        fmt::format("{}: its driver splits it only into equal parts: give each the same /N", info.label()));
  return parts[index];
}

/// Waits until the driver's threads release a queue whose work is done. PoCL's threads may still hold it for
/// its last event, and crash when the sub-device is destroyed. A queue held longer than a second is leaked.
void await_release(const cl::Device& device, const cl::CommandQueue& queue) {
  const auto held = [&] {
    cl_uint references = 1;
    clGetCommandQueueInfo(queue(), CL_QUEUE_REFERENCE_COUNT, sizeof references, &references, nullptr);
    return references > 1;
  };
  for (int polls = 0; held(); ++polls) {
    if (polls == 10'000) {
      clRetainDevice(device());
      clRetainCommandQueue(queue());
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

/// An event's time on the device; 0 if the driver does not measure it. Times below a microsecond count as not
/// measured: rusticl on llvmpipe stamps begin and end nanoseconds apart.
double event_ms(const cl::Event& event) {
  constexpr cl_ulong least = 1000;
  cl_int started = CL_SUCCESS, ended = CL_SUCCESS;
  const cl_ulong start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>(&started);
  const cl_ulong end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>(&ended);
  if (started != CL_SUCCESS || ended != CL_SUCCESS || end < start + least) return 0;
  return static_cast<double>(end - start) * 1e-6;
}

/// Whether the driver reports a fused multiply-add. Not for CPUs: their drivers may report it without the
/// instruction, and their compilers define a macro instead.
bool has_fma_instruction(const cl::Device& device, const DeviceInfo& info) {
  return info.type != "cpu" && (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_FMA) != 0;
}

cl::Context make_context(const cl::Device& device, const DeviceInfo& info) {
  cl_int status = CL_SUCCESS;
  cl::Context context(device, nullptr, nullptr, nullptr, &status);
  check_cl(status, info, "clCreateContext");
  return context;
}

/// PoCL compiles a kernel once per local size, and again for grids below 65536 (its "smallgrid" variant).
std::string variant(const std::string& kernel, const LaunchSize& grid) {
  const char* extent = std::max(grid.x, grid.y) < 65536 ? "small" : "large";
  return fmt::format("{} {}x{} {}", kernel, grid.local_x, grid.local_y, extent);
}

/// Faults injected by tests (base/faults.h).
void inject_launch_faults(const DeviceInfo& info, const std::string& name, std::size_t items,
                          std::size_t group) {
  const auto& faults = value_of(info.environment).faults;
  if (!faults) return;
  while (fault(faults, "hang", info.place(), items)) std::this_thread::sleep_for(std::chrono::hours(1));
  for (const char* kind : {"crash", "kill", "stop"}) faults->end_process(kind, info.place(), items);
  if (const auto status = fault(faults, "launch", info.place(), items))
    check_cl(*status, info, fmt::format("launch of {}", name));
  if (const auto status = fault(faults, "group", info.place(), group))
    check_cl(*status, info, fmt::format("launch of {} in groups of {}", name, group));
}

}  // namespace

DeviceInfo share_context(DeviceInfo info) {
  if (info.usable() && info.sub_units == 0 && !info.context)
    info.context = std::make_shared<cl::Context>(
        make_context(cl::Device(static_cast<cl_device_id>(info.handle), true), info));
  return info;
}

struct Device::Pending {
  cl::Event event;
  std::string name;
  LaunchSize size;
  bool first;  // first launch of its program at this size
};

Device::Device(DeviceInfo info) : info_(std::move(info)), prepared_(std::make_unique<PreparedBuilds>()) {
  if (!info_.usable()) throw DeviceError(fmt::format("{}: {}", info_.label(), info_.problem));
  device_ = cl::Device(static_cast<cl_device_id>(info_.handle), true);
  if (info_.sub_units > 0) device_ = sub_device(device_, info_);
  context_ = info_.context && info_.sub_units == 0 ? *static_cast<const cl::Context*>(info_.context.get())
                                                   : make_context(device_, info_);
  cl_int status = CL_SUCCESS;
  queue_ = cl::CommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE, &status);
  check_cl(status, info_, "clCreateCommandQueue");
  fma_ = has_fma_instruction(device_, info_);
  fence_ = allocate(4, "\0\0\0");
}

Device::Device(Device&&) noexcept = default;

Device::~Device() {
  save_programs();
  // Pending events hold the queue.
  pending_.clear();
  fence_ = {};
  if (info_.sub_units > 0 && queue_()) await_release(device_, queue_);
}

ProgramSource Device::source_of(const std::string& entry, const KernelDefines& defines,
                                const GeneratedFiles& generated) const {
  KernelText text{entry, defines, generated, value_of(info_.environment).kernels};
  if (fma_) text.defines.emplace("DEVICE_HAS_FMA", "1");
  std::string identity = text.identity();
  return {std::move(text), std::move(identity)};
}

const std::shared_ptr<ProgramRecord>* Device::find_built(const ProgramSource& source) const {
  const auto built = std::ranges::find_if(
      programs_, [&, options = all_build_options(info_, wish_, source.text)](const auto& program) {
        return program->source.text.entry == source.text.entry &&
               program->source.identity == source.identity && program->options == options;
      });
  return built == programs_.end() ? nullptr : &*built;
}

bool Device::has(const std::string& entry, const KernelDefines& defines,
                 const GeneratedFiles& generated) const {
  const ProgramSource source = source_of(entry, defines, generated);
  return find_built(source) || is_program_cached(info_, source, wish_, *prepared_);
}

bool Device::build_ahead(const std::string& entry, const KernelDefines& defines, const EmptyLaunch& launch,
                         const GeneratedFiles& generated) noexcept {
  try {
    const ProgramSource source = source_of(entry, defines, generated);
    return !find_built(source) && begin_program(info_, source, wish_, launch, *prepared_);
  } catch (const std::exception&) {
    return false;  // build() will report the error
  }
}

Program Device::build(const std::string& entry, const KernelDefines& defines, BuildReport* report,
                      const GeneratedFiles& generated) {
  const auto start = Clock::now();
  BuildReport own;
  BuildReport& result = report ? *report : own;
  result = {};
  ProgramSource source = source_of(entry, defines, generated);
  if (const auto* built = find_built(source)) {
    result.cached = true;
    return Program(*built);
  }
  programs_.push_back(build_program(context_, device_, info_, std::move(source), wish_, *prepared_, result));
  result.seconds = milliseconds(Clock::now() - start) * 1e-3;
  return Program(programs_.back());
}

void Device::save_programs(bool all) noexcept {
  for (const auto& program : programs_) {
    try {
      save_program(*program, all);
    } catch (const std::exception&) {
      program->cache_file.clear();  // the cache only saves time
    }
  }
}

void Device::check_argument(cl_int status, const std::string& name, cl_uint index) const {
  if (status != CL_SUCCESS) check_cl(status, info_, fmt::format("argument {} of kernel {}", index, name));
}

std::optional<NvidiaLimits> Device::nvidia() const {
  // From cl_nv_device_attribute_query, by value: headers lack the names.
  constexpr cl_device_info major = 0x4000, minor = 0x4001, registers = 0x4002, warp = 0x4003;
  if (info_.extensions.find("cl_nv_device_attribute_query") == std::string::npos) return std::nullopt;
  NvidiaLimits limits;
  const auto ask = [&](cl_device_info what, unsigned& value) {
    cl_uint told = 0;
    if (clGetDeviceInfo(device_(), what, sizeof told, &told, nullptr) == CL_SUCCESS) value = told;
  };
  ask(major, limits.major);
  ask(minor, limits.minor);
  ask(registers, limits.registers);
  ask(warp, limits.warp);
  if (limits.warp == 0 || limits.registers == 0) return std::nullopt;
  return limits;
}

KernelLimits Device::limits_of(const cl::Kernel& kernel) const {
  KernelLimits limits;
  // Values that a driver does not report stay 0.
  kernel.getWorkGroupInfo(device_, CL_KERNEL_WORK_GROUP_SIZE, &limits.work_group);
  kernel.getWorkGroupInfo(device_, CL_KERNEL_PREFERRED_WORK_GROUP_SIZE_MULTIPLE, &limits.preferred_multiple);
  kernel.getWorkGroupInfo(device_, CL_KERNEL_PRIVATE_MEM_SIZE, &limits.private_bytes);
  kernel.getWorkGroupInfo(device_, CL_KERNEL_LOCAL_MEM_SIZE, &limits.local_bytes);
  // Mesa's rusticl reports a sub-group's size for every kernel, but runs larger groups. If the limit is real,
  // a launch fails and is reduced.
  if (limits.work_group <= limits.preferred_multiple) limits.work_group = info_.max_work_group;
  if (const auto most = fault(value_of(info_.environment).faults, "limit", info_.place()))
    limits.work_group = std::min(limits.work_group, static_cast<std::size_t>(*most));
  return limits;
}

cl::Buffer Device::allocate(std::size_t bytes, const void* data, std::shared_ptr<const void> owner) {
  constexpr std::size_t unused = 16;  // OpenCL has no empty buffers
  if (bytes > info_.max_allocation)
    check_cl(CL_MEM_OBJECT_ALLOCATION_FAILURE, info_,
             fmt::format("a buffer of {} bytes where {} is the limit", bytes, info_.max_allocation));
  if (const auto injected = fault(value_of(info_.environment).faults, "alloc", info_.place(), bytes))
    check_cl(*injected, info_, fmt::format("a buffer of {} bytes", bytes));
  cl_int status = CL_SUCCESS;
  const bool given = bytes > 0 && data, in_place = given && owner && shares_memory();
  const cl_mem_flags flags = !given     ? CL_MEM_READ_WRITE
                             : in_place ? CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR
                                        : CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR;
  cl::Buffer buffer(context_, flags, bytes > 0 ? bytes : unused, given ? const_cast<void*>(data) : nullptr,
                    &status);
  check_cl(status, info_, fmt::format("a buffer of {} bytes", bytes));
  if (!in_place) return buffer;
  auto held = std::make_unique<std::shared_ptr<const void>>(std::move(owner));
  const auto let_go = [](cl_mem, void* of) { delete static_cast<std::shared_ptr<const void>*>(of); };
  check_cl(buffer.setDestructorCallback(let_go, held.get()), info_, "clSetMemObjectDestructorCallback");
  [[maybe_unused]] const auto* const the_buffers = held.release();
  return buffer;
}

void Device::write_bytes(const cl::Buffer& buffer, const void* data, std::size_t bytes, std::size_t offset,
                         cl_bool waits) {
  if (bytes == 0) return;
  check_cl(queue_.enqueueWriteBuffer(buffer, waits, offset, bytes, data), info_, "clEnqueueWriteBuffer");
}

void Device::read_bytes(const cl::Buffer& buffer, void* data, std::size_t bytes, std::size_t offset,
                        cl_bool waits) {
  if (bytes == 0) return;
  const bool spoiled = fault(value_of(info_.environment).faults, "spoil", info_.place(), bytes).has_value();
  check_cl(queue_.enqueueReadBuffer(buffer, spoiled ? CL_TRUE : waits, offset, bytes, data), info_,
           "clEnqueueReadBuffer");
  if (!spoiled) return;
  constexpr std::size_t step = 16;  // the first number of each pixel
  for (std::size_t at = 2; at < bytes; at += step) static_cast<unsigned char*>(data)[at] ^= 0x60;
}

// Not clFinish, because rusticl's returns early. The queue is in order, so a read completes last.
void Device::settle() noexcept {
  char ignored[4];
  queue_.enqueueReadBuffer(fence_, CL_TRUE, 0, sizeof ignored, ignored);
}

cl::Event Device::enqueue(cl::Kernel& kernel, const std::string& name, ProgramRecord* program,
                          const LaunchSize& size) {
  cl::Event event;
  if (size.x == 0 || size.y == 0) return event;
  const bool driver_chooses = size.local_x == 0;
  const LaunchSize grid{padded(size.x, size.local_x), driver_chooses ? size.y : padded(size.y, size.local_y),
                        size.local_x, size.local_y};
  const bool flat = grid.y == 1 && size.local_y <= 1;
  const cl::NDRange global = flat ? cl::NDRange(grid.x) : cl::NDRange(grid.x, grid.y);
  const cl::NDRange local = driver_chooses ? cl::NullRange
                            : flat         ? cl::NDRange(size.local_x)
                                           : cl::NDRange(size.local_x, size.local_y);
  inject_launch_faults(info_, name, size.x * size.y, size.local_x * size.local_y);
  if (pending_.empty()) batch_start_ = Clock::now();
  const cl_int status = queue_.enqueueNDRangeKernel(kernel, cl::NullRange, global, local, nullptr, &event);
  if (status != CL_SUCCESS)
    check_cl(status, info_,
             fmt::format("launch of {} over {}x{} in groups of {}x{}", name, grid.x, grid.y, size.local_x,
                         size.local_y));
  check_cl(queue_.flush(), info_, "clFlush");
  const bool first = program && program->launched_variants.insert(variant(name, grid)).second;
  pending_.push_back({event, name, size, first});
  return event;
}

void Device::run_empty(cl::Kernel& kernel, ProgramRecord* program, const EmptyLaunch& launch) {
  const cl_int status = launch_nothing(context_, queue_, kernel, launch);
  if (status != CL_SUCCESS)
    check_cl(status, info_,
             fmt::format("an empty launch of {} in groups of {}x{}", launch.kernel, launch.local_x,
                         launch.local_y));
  if (program)
    program->launched_variants.insert(
        variant(launch.kernel, {launch.local_x, launch.local_y, launch.local_x, launch.local_y}));
}

void Device::finish() {
  if (pending_.empty()) return;
  const std::vector<Pending> batch = std::exchange(pending_, {});
  char ignored[4];
  read_bytes(fence_, ignored, sizeof ignored, 0, CL_TRUE);  // settle(), but with errors
  const double host_ms = milliseconds(Clock::now() - batch_start_);
  std::vector<double> device_ms;
  double total_ms = 0;
  for (const Pending& launch : batch) {
    const cl_int status = launch.event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>();
    if (status < 0) check_cl(status, info_, fmt::format("kernel {}", launch.name));
    device_ms.push_back(event_ms(launch.event));
    total_ms += device_ms.back();
  }
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const double share = total_ms > 0 ? device_ms[i] / total_ms : 1.0 / static_cast<double>(batch.size());
    KernelTimes& times = times_[batch[i].name];
    ++times.launches;
    times.device_ms += device_ms[i];
    times.host_ms += host_ms * share;
    if (batch[i].first && total_ms > 0) times.first_ms += std::max(0.0, host_ms - total_ms) * share;
    times.local_x = batch[i].size.local_x;
    times.local_y = batch[i].size.local_y;
  }
}

}  // namespace sundog
