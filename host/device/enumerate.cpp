// Queries every platform and device. Failures become a row's `problem`; no driver ends the enumeration.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pthread.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <thread>

#include "base/environment.h"
#include "device/build_options.h"
#include "device/cl_status.h"
#include "device/devices.h"
#include "device/driver_folder.h"
#include "device/estimate.h"
#include "device/machine_topology.h"
#include "device/process_lock.h"
#include "device/thread_limits.h"

namespace sundog {
namespace {

std::string trimmed(std::string text) {
  text = text.substr(0, text.find('\0'));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first);
}

std::string platform_text(cl_platform_id platform, cl_platform_info what) {
  std::size_t size = 0;
  if (clGetPlatformInfo(platform, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  if (clGetPlatformInfo(platform, what, size, text.data(), nullptr) != CL_SUCCESS) return {};
  return trimmed(text);
}

/// Reads a device's properties; a missing essential property is noted in `problem`.
struct Query {
  cl_device_id device;
  std::string problem;

  void note(const char* what, cl_int status) {
    if (problem.empty()) problem = fmt::format("{}: {}", what, cl_status_name(status));
  }
  template <class T>
  T optional(cl_device_info what, T otherwise) {
    T value{};
    return clGetDeviceInfo(device, what, sizeof value, &value, nullptr) == CL_SUCCESS ? value : otherwise;
  }
  template <class T>
  T required(cl_device_info what, const char* name) {
    T value{};
    const cl_int status = clGetDeviceInfo(device, what, sizeof value, &value, nullptr);
    if (status != CL_SUCCESS) note(name, status);
    return status == CL_SUCCESS ? value : T{};
  }
  std::string text(cl_device_info what, const char* name) {
    std::size_t size = 0;
    cl_int status = clGetDeviceInfo(device, what, 0, nullptr, &size);
    std::string value(size, '\0');
    if (status == CL_SUCCESS) status = clGetDeviceInfo(device, what, size, value.data(), nullptr);
    if (status != CL_SUCCESS) note(name, status);
    return status == CL_SUCCESS ? trimmed(value) : "";
  }
};

std::string type_name(cl_device_type type) {
  // Oclgrind claims all types, so the first match counts.
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  if (type & CL_DEVICE_TYPE_GPU) return "gpu";
  return type & CL_DEVICE_TYPE_ACCELERATOR ? "accelerator" : "custom";
}

/// Whether the device supports OpenCL C 1.2: `c_version` is "OpenCL C 1.2 ..." or newer.
bool speaks_c12(const std::string& c_version) {
  int major = 0, minor = 0;
  if (std::sscanf(c_version.c_str(), "OpenCL C %d.%d", &major, &minor) != 2) return false;
  return major > 1 || (major == 1 && minor >= 2);
}

std::string unusable_because(const DeviceInfo& info) {
  if (!info.available) return "the driver says that it is not available";
  if (!info.compiler_available) return "its driver has no compiler";
  if (!info.little_endian) return "it is big-endian";
  if (!speaks_c12(info.c_version))
    return fmt::format("speaks \"{}\", wanted OpenCL C 1.2 or later", info.c_version);
  return {};
}

void read_texts(Query& query, DeviceInfo& info) {
  info.name = query.text(CL_DEVICE_NAME, "CL_DEVICE_NAME");
  info.vendor = query.text(CL_DEVICE_VENDOR, "CL_DEVICE_VENDOR");
  info.driver = query.text(CL_DRIVER_VERSION, "CL_DRIVER_VERSION");
  info.version = query.text(CL_DEVICE_VERSION, "CL_DEVICE_VERSION");
  info.c_version = query.text(CL_DEVICE_OPENCL_C_VERSION, "CL_DEVICE_OPENCL_C_VERSION");
  info.extensions = query.text(CL_DEVICE_EXTENSIONS, "CL_DEVICE_EXTENSIONS");
}

void read_figures(Query& query, DeviceInfo& info) {
  info.type = type_name(query.required<cl_device_type>(CL_DEVICE_TYPE, "CL_DEVICE_TYPE"));
  info.compute_units = query.required<cl_uint>(CL_DEVICE_MAX_COMPUTE_UNITS, "CL_DEVICE_MAX_COMPUTE_UNITS");
  info.max_work_group =
      query.required<std::size_t>(CL_DEVICE_MAX_WORK_GROUP_SIZE, "CL_DEVICE_MAX_WORK_GROUP_SIZE");
  info.global_memory = query.required<cl_ulong>(CL_DEVICE_GLOBAL_MEM_SIZE, "CL_DEVICE_GLOBAL_MEM_SIZE");
  info.max_allocation =
      query.required<cl_ulong>(CL_DEVICE_MAX_MEM_ALLOC_SIZE, "CL_DEVICE_MAX_MEM_ALLOC_SIZE");
  info.available = query.required<cl_bool>(CL_DEVICE_AVAILABLE, "CL_DEVICE_AVAILABLE") != CL_FALSE;
  info.compiler_available =
      query.required<cl_bool>(CL_DEVICE_COMPILER_AVAILABLE, "CL_DEVICE_COMPILER_AVAILABLE") != CL_FALSE;
  info.little_endian =
      query.required<cl_bool>(CL_DEVICE_ENDIAN_LITTLE, "CL_DEVICE_ENDIAN_LITTLE") != CL_FALSE;
  info.clock_mhz = query.optional<cl_uint>(CL_DEVICE_MAX_CLOCK_FREQUENCY, 0);
  info.native_vector_width = query.optional<cl_uint>(CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, 0);
  info.preferred_vector_width = query.optional<cl_uint>(CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT, 0);
  info.local_memory = query.optional<cl_ulong>(CL_DEVICE_LOCAL_MEM_SIZE, 0);
  info.cache = query.optional<cl_ulong>(CL_DEVICE_GLOBAL_MEM_CACHE_SIZE, 0);
  info.timer_resolution_ns = query.optional<std::size_t>(CL_DEVICE_PROFILING_TIMER_RESOLUTION, 0);
  info.max_sub_devices = query.optional<cl_uint>(CL_DEVICE_PARTITION_MAX_SUB_DEVICES, 0);
  info.host_unified_memory = query.optional<cl_bool>(CL_DEVICE_HOST_UNIFIED_MEMORY, CL_FALSE) != CL_FALSE;
}

/// An identifier that all processes on a machine agree on; empty if the driver cannot identify the device.
std::string identity(cl_device_id device, const std::string& extensions) {
  const auto hex = [&](cl_device_info what, std::size_t size) {
    std::array<unsigned char, 16> bytes{};
    if (clGetDeviceInfo(device, what, size, bytes.data(), nullptr) != CL_SUCCESS) return std::string();
    return fmt::format("{:02x}",
                       fmt::join(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size), ""));
  };
  // From extensions, by value: older headers lack the names.
  constexpr cl_device_info device_uuid = 0x106A, pci_bus_info = 0x410F, pci_bus_nv = 0x4008,
                           pci_slot_nv = 0x4009;
  const auto has = [&](const char* name) { return extensions.find(name) != std::string::npos; };
  if (has("cl_khr_device_uuid")) return hex(device_uuid, 16);
  if (has("cl_khr_pci_bus_info")) return hex(pci_bus_info, 16);
  if (has("cl_nv_device_attribute_query")) return hex(pci_bus_nv, 4) + hex(pci_slot_nv, 4);
  return {};
}

DeviceInfo describe(DeviceInfo info, cl_device_id device) {
  Query query{device, {}};
  info.handle = device;
  read_texts(query, info);
  read_figures(query, info);
  info.identity = identity(device, info.extensions);
  info.device_class = device_class(info);
  info.estimate = estimate_speed(info, std::thread::hardware_concurrency());
  info.problem = query.problem.empty() ? unusable_because(info) : query.problem;
  return info;
}

constexpr const char* rusticl_mend = "it wants the name of one, RUSTICL_ENABLE=llvmpipe for the processor";

void list_platform(DeviceInfo platform, cl_platform_id id, std::vector<DeviceInfo>& rows) {
  const auto problem = [&](const std::string& what) {
    platform.problem = what;
    rows.push_back(platform);
  };
  cl_uint count = 0;
  cl_int status = clGetDeviceIDs(id, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
  if (status == CL_DEVICE_NOT_FOUND || (status == CL_SUCCESS && count == 0)) {
    const HostEnvironment& environment = value_of(platform.environment);
    const std::string why = is_pocl(platform) ? driver_folder(environment).problem(environment)
                            : platform.platform_name == "rusticl" ? rusticl_mend
                                                                  : "";
    return problem("the platform has no device" + (why.empty() ? "" : ": " + why));
  }
  if (status != CL_SUCCESS) return problem("clGetDeviceIDs: " + cl_status_name(status));
  std::vector<cl_device_id> devices(count);
  status = clGetDeviceIDs(id, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr);
  if (status != CL_SUCCESS) return problem("clGetDeviceIDs: " + cl_status_name(status));
  for (cl_uint i = 0; i < count; ++i) {
    platform.device = static_cast<int>(i);
    rows.push_back(describe(platform, devices[i]));
  }
}

// A CPU driver that chooses the work-group size may use thousands of work-items, whose private memory lies on
// one thread's stack. The size is only reserved, not allocated.
constexpr std::size_t thread_stack = std::size_t{256} << 20;

void enlarge_thread_stacks() {
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  std::size_t bytes = 0;
  if (pthread_attr_getstacksize(&attributes, &bytes) == 0 && bytes < thread_stack &&
      pthread_attr_setstacksize(&attributes, thread_stack) == 0)
    pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

/// Sets drivers' variables before the first OpenCL call, keeping the user's. Drivers offer no other interface
/// than the process's environment.
bool prepare_drivers(const HostEnvironment& environment) {
  for (const auto& [name, value] : environment.drivers)
    set_variable(name, value, name == "PATH");  // folders may have been appended
  if (!environment.build_log.empty()) bypass_driver_caches();
  (void)driver_folder(environment);
  describe_machine_to_drivers(environment);
  enlarge_thread_stacks();
  check_thread_limits(std::thread::hardware_concurrency(), thread_stack);
  return true;
}

}  // namespace

std::vector<DeviceInfo> enumerate_devices(const EnvironmentPtr& environment) {
  // Drivers load at the first call, and PoCL admits a second thread before it is ready.
  const ProcessLock lock;
  [[maybe_unused]] static const bool prepared = prepare_drivers(value_of(environment));
  cl_uint count = 0;
  // Having no platform is an error status too (CL_PLATFORM_NOT_FOUND_KHR); report it as an empty list.
  if (clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) return {};
  std::vector<cl_platform_id> platforms(count);
  if (clGetPlatformIDs(count, platforms.data(), nullptr) != CL_SUCCESS) return {};
  std::vector<DeviceInfo> rows;
  for (cl_uint i = 0; i < count; ++i) {
    DeviceInfo platform;
    platform.environment = environment;
    platform.platform = static_cast<int>(i);
    platform.platform_name = platform_text(platforms[i], CL_PLATFORM_NAME);
    platform.platform_version = platform_text(platforms[i], CL_PLATFORM_VERSION);
    list_platform(platform, platforms[i], rows);
  }
  return rows;
}

}  // namespace sundog
