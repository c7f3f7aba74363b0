// An opened device: its context and queue, memory, programs and launches. Only this folder uses OpenCL. Its
// types are thin wrappers that check the kernels' argument types.
#pragma once
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#include <chrono>
#include <CL/opencl.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "device/build_options.h"
#include "device/devices.h"
#include "device/kernel_source.h"
#include "device/launches.h"
#include "device/nvidia.h"

namespace sundog {

struct BuildReport {
  bool cached = false;  // loaded from the binary cache
  double seconds = 0;
  std::string log;   // the compiler's output, including warnings
  std::string note;  // why the binary cache was not usable; empty if it was
};

template <class T>
struct Buffer {
  cl::Buffer memory;
  std::size_t count = 0;  // elements of T
};

/// A type's name as spelled in kernels: "u32", "float4", "Ray"; with * for a buffer.
std::string kernel_type_name(const std::type_info& type);
template <class T>
struct ArgumentType {
  static constexpr std::size_t bytes = sizeof(T);
  static std::string name() { return kernel_type_name(typeid(T)); }
};
template <class T>
struct ArgumentType<Buffer<T>> {
  static constexpr std::size_t bytes = 0;
  static std::string name() { return kernel_type_name(typeid(T)) + "*"; }
};

struct ProgramRecord;   // a built program and its entry in the binary cache (program.h)
struct ProgramSource;   // a program's text (program.h)
struct PreparedBuilds;  // cached or concurrent builds for the next build() (program.h)

/// A kernel with arguments of types Args: Buffer<T> for a __global T*, or a value (scalar, vector or struct).
template <class... Args>
struct Kernel {
  cl::Kernel kernel;
  std::string name;
  std::shared_ptr<ProgramRecord> program;

  static EmptyLaunch empty_launch(std::string name, std::size_t local_x, std::size_t local_y = 1) {
    return {std::move(name), local_x, local_y, {ArgumentType<Args>::bytes...}};
  }
};

/// A driver's figures for a kernel on its device; 0: unknown.
struct KernelLimits {
  std::size_t work_group = 0;  // maximum group size: the device's, or less if registers limit it
  std::size_t preferred_multiple = 0;
  cl_ulong private_bytes = 0, local_bytes = 0;  // per work-item, per group
};

/// A built kernel file.
class Program {
 public:
  Program() = default;
  explicit Program(std::shared_ptr<ProgramRecord> record) : record_(std::move(record)) {}

  /// Throws BuildError for a kernel that is not in the file, or whose parameters differ from Args. Without
  /// Args, the parameters are not checked.
  template <class... Args>
  Kernel<Args...> kernel(const std::string& name) const {
    return {make_kernel(name, {ArgumentType<Args>::name()...}), name, record_};
  }

  std::vector<std::string> kernel_names() const;

 private:
  cl::Kernel make_kernel(const std::string& name, const std::vector<std::string>& host_types) const;
  std::shared_ptr<ProgramRecord> record_;
};

/// The types of a kernel's parameters as in its source, e.g. {"Ray*", "u32"}; empty if not reported.
std::vector<std::string> argument_types(const cl::Kernel& kernel);

/// Adds an OpenCL context to `info` that all its Devices share, unless it has one or is a sub-device. Some
/// compilers start from scratch in each context (PoCL 3.1 reads its library for 0.6 s). A fault in one Device
/// may break the context for all. Throws DeviceError.
DeviceInfo share_context(DeviceInfo info);

/// Use from one host thread per device; not thread-safe.
class Device {
 public:
  /// Opens the device (a sub-device when info.sub_units > 0). Throws DeviceError.
  explicit Device(DeviceInfo info);
  Device(Device&&) noexcept;
  ~Device();

  const DeviceInfo& info() const { return info_; }

  /// Limits of an NVIDIA device; nothing for others.
  std::optional<NvidiaLimits> nvidia() const;

  /// Applies to future calls of build().
  void build_with(BuildWish wish) { wish_ = std::move(wish); }

  /// Builds `entry` ("entry/whitted.cl", embedded or generated) with `defines`, or loads it from the binary
  /// cache; repeated calls return the same program. `generated` are additional files (path -> text, such as
  /// "generated/sdf.cl") that kernels may include. Throws BuildError with the compiler's log.
  Program build(const std::string& entry, const KernelDefines& defines, BuildReport* report = nullptr,
                const GeneratedFiles& generated = {});

  /// Whether build() needs no compilation, because this device or the binary cache has the program.
  bool has(const std::string& entry, const KernelDefines& defines,
           const GeneratedFiles& generated = {}) const;

  /// Starts another process that builds the program for build(), with machine code for `launch`. build() then
  /// waits for it, and builds here if it fails. Returns whether a process was started: not if build() would
  /// not compile, or if the driver can compile concurrently (PoCL on a CPU cannot). Replaces an earlier
  /// process. Never throws.
  bool build_ahead(const std::string& entry, const KernelDefines& defines, const EmptyLaunch& launch,
                   const GeneratedFiles& generated = {}) noexcept;

  /// Makes the driver generate a kernel's machine code for a local size, if it does so at the first launch
  /// (EmptyLaunch). Throws DeviceError.
  template <class... Args>
  void make_ready(Kernel<Args...>& kernel, std::size_t local_x, std::size_t local_y = 1) {
    run_empty(kernel.kernel, kernel.program.get(),
              Kernel<Args...>::empty_launch(kernel.name, local_x, local_y));
  }

  /// Copies `values` to a device array (an empty span gives one unused element).
  template <class T>
  Buffer<T> upload(std::span<const T> values) {
    return {allocate(values.size_bytes(), values.data()), values.size()};
  }
  /// Whether the device uses the host's memory, so share() copies nothing.
  bool shares_memory() const { return info_.type == "cpu" && info_.host_unified_memory; }
  /// upload() without a copy if shares_memory(), for kernels that only read. `owner` keeps the values in
  /// place and unchanged; it is released when the last launch that reads them has ended.
  template <class T>
  Buffer<T> share(std::span<const T> values, std::shared_ptr<const void> owner) {
    return {allocate(values.size_bytes(), values.data(), std::move(owner)), values.size()};
  }
  template <class T>
  Buffer<T> make(std::size_t count) {  // contents undefined
    return {allocate(count * sizeof(T), nullptr), count};
  }
  template <class T>
  void write(Buffer<T>& buffer, std::span<const T> values, std::size_t first = 0) {
    write_bytes(buffer.memory, values.data(), values.size_bytes(), first * sizeof(T), CL_TRUE);
  }
  /// Blocks until the values are read; the only reliable way to wait on every driver.
  template <class T>
  void read(const Buffer<T>& buffer, std::span<T> values, std::size_t first = 0) {
    read_bytes(buffer.memory, values.data(), values.size_bytes(), first * sizeof(T), CL_TRUE);
  }
  /// Starts a write at the buffer's beginning without waiting: the values must stay valid until a later
  /// write() or read() has returned or, if that throws, settle().
  template <class T>
  void begin_write(Buffer<T>& buffer, std::span<const T> values) {
    write_bytes(buffer.memory, values.data(), values.size_bytes(), 0, CL_FALSE);
  }
  template <class T>
  void begin_read(const Buffer<T>& buffer, std::span<T> values) {
    read_bytes(buffer.memory, values.data(), values.size_bytes(), 0, CL_FALSE);
  }
  /// Waits for all transfers and ignores errors.
  void settle() noexcept;

  /// Enqueues a launch. Throws DeviceError with the OpenCL status.
  template <class... Args>
  cl::Event run(Kernel<Args...>& kernel, const LaunchSize& size, const std::type_identity_t<Args>&... args) {
    cl_uint index = 0;
    (set_argument(kernel.kernel, kernel.name, index++, args), ...);
    return enqueue(kernel.kernel, kernel.name, kernel.program.get(), size);
  }

  template <class... Args>
  KernelLimits limits(const Kernel<Args...>& kernel) const {
    return limits_of(kernel.kernel);
  }

  /// Waits for all launches and adds their times to `times()`.
  void finish();
  const std::map<std::string, KernelTimes>& times() const { return times_; }
  void forget_times() { times_.clear(); }

  /// Stores in the binary cache the machine code compiled since the last call (some drivers compile at the
  /// first launch of each local size). `all` includes programs that were never launched, which PoCL must
  /// compile first. Also called by the destructor. Never throws.
  void save_programs(bool all = false) noexcept;

 private:
  template <class T>
  void set_argument(cl::Kernel& kernel, const std::string& name, cl_uint index, const Buffer<T>& buffer) {
    check_argument(kernel.setArg(index, buffer.memory), name, index);
  }
  template <class T>
  void set_argument(cl::Kernel& kernel, const std::string& name, cl_uint index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0,
                  "kernel values are scalars, vectors and plain structs");
    check_argument(kernel.setArg(index, sizeof(T), &value), name, index);
  }
  ProgramSource source_of(const std::string& entry, const KernelDefines& defines,
                          const GeneratedFiles& generated) const;
  const std::shared_ptr<ProgramRecord>* find_built(const ProgramSource& source) const;
  KernelLimits limits_of(const cl::Kernel& kernel) const;
  void check_argument(cl_int status, const std::string& name, cl_uint index) const;
  cl::Buffer allocate(std::size_t bytes, const void* data, std::shared_ptr<const void> owner = nullptr);
  void write_bytes(const cl::Buffer& buffer, const void* data, std::size_t bytes, std::size_t offset,
                   cl_bool waits);
  void read_bytes(const cl::Buffer& buffer, void* data, std::size_t bytes, std::size_t offset, cl_bool waits);
  cl::Event enqueue(cl::Kernel& kernel, const std::string& name, ProgramRecord* program,
                    const LaunchSize& size);
  void run_empty(cl::Kernel& kernel, ProgramRecord* program, const EmptyLaunch& launch);

  DeviceInfo info_;
  bool fma_ = false;  // the device has an fma instruction (kernels/lib/core/config.h)
  BuildWish wish_;
  std::unique_ptr<PreparedBuilds> prepared_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  cl::Buffer fence_;
  struct Pending;
  std::vector<Pending> pending_;
  std::chrono::steady_clock::time_point batch_start_;
  std::vector<std::shared_ptr<ProgramRecord>> programs_;
  std::map<std::string, KernelTimes> times_;
};

}  // namespace sundog
