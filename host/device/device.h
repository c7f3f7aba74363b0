// An opened device: its context and queue, memory, programs and launches. The only folder that knows OpenCL;
// the types here are thin, and the kernels' argument types are part of the call.
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
#include "device/launches.h"
#include "device/nvidia.h"

namespace sundog {

/// `-D` definitions, sorted by name: part of the kernel cache's key.
using KernelDefines = std::map<std::string, std::string>;

/// Kernel text that the host writes (formulas): path as the kernels include it -> text.
using GeneratedFiles = std::map<std::string, std::string>;

struct BuildReport {
  bool cached = false;  // from the binary cache: nothing was compiled
  double seconds = 0;
  std::string log;   // the compiler's, its warnings included
  std::string note;  // why the binary cache could not be used; empty when it could
};

template <class T>
struct Buffer {
  cl::Buffer memory;
  std::size_t count = 0;  // elements of T
};

/// A type's name as kernels spell it: "u32", "float4", "Ray"; with a * for a buffer.
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

struct ProgramRecord;   // what the binary cache must know of a built program (program.h)
struct PreparedBuilds;  // what is there for the next build() (program.h)

/// A kernel whose arguments have the types Args: Buffer<T> for a __global T*, or a plain value: a scalar, a
/// vector, a struct.
template <class... Args>
struct Kernel {
  cl::Kernel kernel;
  std::string name;
  std::shared_ptr<ProgramRecord> program;

  static EmptyLaunch empty_launch(std::string name, std::size_t local_x, std::size_t local_y = 1) {
    return {std::move(name), local_x, local_y, {ArgumentType<Args>::bytes...}};
  }
};

/// What a driver tells of a kernel on its device; 0: it does not.
struct KernelLimits {
  std::size_t work_group = 0;  // the most work-items of a group: the device's, where registers allow as many
  std::size_t preferred_multiple = 0;
  cl_ulong private_bytes = 0, local_bytes = 0;  // of a work-item, of a group
};

/// A built kernel file.
class Program {
 public:
  Program() = default;
  explicit Program(std::shared_ptr<ProgramRecord> record) : record_(std::move(record)) {}

  /// Throws BuildError for a kernel that is not in the file, or whose parameters are not Args. No Args: they
  /// are not compared.
  template <class... Args>
  Kernel<Args...> kernel(const std::string& name) const {
    return {make_kernel(name, {ArgumentType<Args>::name()...}), name, record_};
  }

  std::vector<std::string> kernel_names() const;

 private:
  cl::Kernel make_kernel(const std::string& name, const std::vector<std::string>& host_types) const;
  std::shared_ptr<ProgramRecord> record_;
};

/// The types of a kernel's parameters as its source spells them: {"Ray*", "u32"}; none where the driver does
/// not tell.
std::vector<std::string> argument_types(const cl::Kernel& kernel);

/// The row with an OpenCL context that all Devices opened of it share, unless it has one; not of a
/// sub-device. Some drivers' compilers begin anew in each context (PoCL 3.1 reads its library for 0.6 s). A
/// context that one Device's fault ends is lost to all of them. Throws DeviceError.
DeviceInfo share_context(DeviceInfo info);

/// Not shared between threads: one host thread a device.
class Device {
 public:
  /// Opens the device (a sub-device when info.sub_units > 0). Throws DeviceError.
  explicit Device(DeviceInfo info);
  Device(Device&&) noexcept;
  ~Device();

  const DeviceInfo& info() const { return info_; }

  /// Of a device of NVIDIA's; nothing for the others.
  std::optional<NvidiaLimits> nvidia() const;

  /// For every build() from now on.
  void build_with(BuildWish wish) { wish_ = std::move(wish); }

  /// Builds `entry` ("entry/whitted.cl", embedded or generated) with `defines`, from the binary cache when it
  /// holds it; what it has built before it gives again. `generated` are further files (path -> text, such as
  /// "generated/sdf.cl") that the kernels may include. Throws BuildError with the compiler's log.
  Program build(const std::string& entry, const KernelDefines& defines, BuildReport* report = nullptr,
                const GeneratedFiles& generated = {});

  /// Whether build() would compile nothing: it has built this before, or the binary cache holds it.
  bool has(const std::string& entry, const KernelDefines& defines,
           const GeneratedFiles& generated = {}) const;

  /// Begins to build in another process what build() will be asked for, as a whole and with machine code for
  /// `launch`. build() then waits for that process, and builds in this one if the other fails. Returns
  /// whether one is at work: not where build() would compile nothing, or where the driver can build beside
  /// (PoCL on a processor cannot). A new one ends the last. Never throws.
  bool build_ahead(const std::string& entry, const KernelDefines& defines, const EmptyLaunch& launch,
                   const GeneratedFiles& generated = {}) noexcept;

  /// Has the driver make a kernel's machine code for a local size, as far as it does that at the first launch
  /// (EmptyLaunch). Throws DeviceError.
  template <class... Args>
  void make_ready(Kernel<Args...>& kernel, std::size_t local_x, std::size_t local_y = 1) {
    run_empty(kernel.kernel, kernel.program.get(),
              Kernel<Args...>::empty_launch(kernel.name, local_x, local_y));
  }

  /// A device array with a copy of `values` (never zero bytes: an empty span gives one unused element).
  template <class T>
  Buffer<T> upload(std::span<const T> values) {
    return {allocate(values.size_bytes(), values.data()), values.size()};
  }
  /// Whether the device reads the host's memory: share() copies nothing.
  bool shares_memory() const { return info_.type == "cpu" && info_.host_unified_memory; }
  /// The same without a copy where shares_memory(): for kernels to read, and never written. `owner` keeps the
  /// values in place and as they are; it is let go of when the last launch that reads them has ended.
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
  /// Blocking; also the only reliable way to wait on every driver.
  template <class T>
  void read(const Buffer<T>& buffer, std::span<T> values, std::size_t first = 0) {
    read_bytes(buffer.memory, values.data(), values.size_bytes(), first * sizeof(T), CL_TRUE);
  }
  /// The same from the buffer's beginning, without waiting: the values must stay in place until a later
  /// write() or read() has returned. If that throws, until settle() has returned.
  template <class T>
  void begin_write(Buffer<T>& buffer, std::span<const T> values) {
    write_bytes(buffer.memory, values.data(), values.size_bytes(), 0, CL_FALSE);
  }
  template <class T>
  void begin_read(const Buffer<T>& buffer, std::span<T> values) {
    read_bytes(buffer.memory, values.data(), values.size_bytes(), 0, CL_FALSE);
  }
  /// Waits until all transfers have ended, and ignores errors.
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

  /// Waits for all launches so far and adds their times to `times()`.
  void finish();
  const std::map<std::string, KernelTimes>& times() const { return times_; }
  void forget_times() { times_.clear(); }

  /// Stores in the binary cache what has been compiled since the last call (some drivers compile at the first
  /// launch of each local size). The destructor does it too. Never throws.
  void save_programs() noexcept;

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
  std::string expanded(const std::string& entry, const KernelDefines& defines,
                       const GeneratedFiles& generated) const;
  const std::shared_ptr<ProgramRecord>* find_built(const std::string& entry, const std::string& source) const;
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
  bool fma_ = false;  // has the instruction (kernels/lib/core/config.h)
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
