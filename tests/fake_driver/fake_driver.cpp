// An OpenCL driver that is wrong in every way that the list of devices must survive. Loaded by the ICD
// loader; it has five platforms:
//   "Fake failing"   the list of its devices fails with CL_OUT_OF_HOST_MEMORY
//   "Fake mute"      two devices: one that does not know its name, and one that has no compiler
//   "Fake old"       a device that speaks OpenCL C 1.1, and one that is big-endian
//   "Fake empty"     no device
//   "Fake crashing"  a device that looks usable, and crashes in the first call that uses it
// With the variable FAKE_DRIVER_GPU it has also "Fake GPU", a large GPU that looks usable.
// With the variable FAKE_DRIVER_ABORTS it ends the process when it is asked for its platforms, with
// FAKE_DRIVER_NEVER_ENDS its exit handler never comes back, with FAKE_DRIVER_TAKES_SIGNALS
// it answers Ctrl-C itself. Its version ends in the value of CL_CONFIG_USE_VECTORIZER as it was when the
// driver was loaded.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_icd.h>

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

struct _cl_platform_id {
  const cl_icd_dispatch* dispatch;
  const char* name;
  cl_int list_status;
  cl_device_id devices[2];
};
struct _cl_device_id {
  const cl_icd_dispatch* dispatch;
  const char* name;  // null: asking for it fails
  const char* c_version;
  cl_bool compiler, little_endian;
  cl_ulong type = CL_DEVICE_TYPE_GPU;
};

namespace {

cl_icd_dispatch dispatch{};
_cl_device_id nameless{&dispatch, nullptr, "OpenCL C 1.2", CL_TRUE, CL_TRUE};
_cl_device_id no_compiler{&dispatch, "uncompiling", "OpenCL C 1.2", CL_FALSE, CL_TRUE};
_cl_device_id old{&dispatch, "old", "OpenCL C 1.1", CL_TRUE, CL_TRUE};
_cl_device_id big_endian{&dispatch, "backwards", "OpenCL C 1.2", CL_TRUE, CL_FALSE};
_cl_device_id crashing{&dispatch, "crashing", "OpenCL C 1.2", CL_TRUE, CL_TRUE, CL_DEVICE_TYPE_CPU};
_cl_device_id gpu{&dispatch, "large GPU", "OpenCL C 1.2", CL_TRUE, CL_TRUE};
_cl_platform_id platforms[] = {
    {&dispatch, "Fake failing", CL_OUT_OF_HOST_MEMORY, {nullptr, nullptr}},
    {&dispatch, "Fake mute", CL_SUCCESS, {&nameless, &no_compiler}},
    {&dispatch, "Fake old", CL_SUCCESS, {&old, &big_endian}},
    {&dispatch, "Fake empty", CL_DEVICE_NOT_FOUND, {nullptr, nullptr}},
    {&dispatch, "Fake crashing", CL_SUCCESS, {&crashing, nullptr}},
    {&dispatch, "Fake GPU", CL_SUCCESS, {&gpu, nullptr}},
};

/// Intel's driver reads it when it is loaded.
std::string version_with_vectorizer() {
  const char* value = std::getenv("CL_CONFIG_USE_VECTORIZER");
  return std::string("OpenCL 1.2 fake, vectorizer ") + (value ? value : "unset");
}
const std::string version = version_with_vectorizer();

cl_int answer(const void* value, size_t bytes, size_t room, void* to, size_t* needed) {
  if (needed) *needed = bytes;
  if (to && room < bytes) return CL_INVALID_VALUE;
  if (to) std::memcpy(to, value, bytes);
  return CL_SUCCESS;
}

cl_int answer_text(const char* text, size_t room, void* to, size_t* needed) {
  return answer(text, std::strlen(text) + 1, room, to, needed);
}

cl_int CL_API_CALL get_platforms(cl_uint room, cl_platform_id* list, cl_uint* count) {
  if (std::getenv("FAKE_DRIVER_ABORTS")) std::abort();
  const cl_uint all = std::size(platforms) - (std::getenv("FAKE_DRIVER_GPU") ? 0 : 1);
  if (count) *count = all;
  for (cl_uint i = 0; list && i < std::min(room, all); ++i) list[i] = &platforms[i];
  return CL_SUCCESS;
}

cl_int CL_API_CALL platform_info(cl_platform_id platform, cl_platform_info what, size_t room, void* to,
                                 size_t* needed) {
  if (what == CL_PLATFORM_NAME) return answer_text(platform->name, room, to, needed);
  if (what == CL_PLATFORM_VERSION) return answer_text(version.c_str(), room, to, needed);
  if (what == CL_PLATFORM_EXTENSIONS) return answer_text("cl_khr_icd", room, to, needed);
  return answer_text("fake", room, to, needed);
}

cl_int CL_API_CALL get_devices(cl_platform_id platform, cl_device_type, cl_uint room, cl_device_id* list,
                               cl_uint* count) {
  if (platform->list_status != CL_SUCCESS) return platform->list_status;
  const cl_uint devices = platform->devices[1] ? 2 : 1;
  if (count) *count = devices;
  for (cl_uint i = 0; list && i < std::min(room, devices); ++i) list[i] = platform->devices[i];
  return CL_SUCCESS;
}

cl_int CL_API_CALL device_info(cl_device_id device, cl_device_info what, size_t room, void* to,
                               size_t* needed) {
  const cl_ulong bytes = 1 << 20;
  const cl_uint units = device == &gpu ? 1000 : 1;
  const size_t group = 64;
  const cl_bool yes = CL_TRUE;
  switch (what) {
    case CL_DEVICE_NAME:
      return device->name ? answer_text(device->name, room, to, needed) : CL_OUT_OF_RESOURCES;
    case CL_DEVICE_OPENCL_C_VERSION:
      return answer_text(device->c_version, room, to, needed);
    case CL_DEVICE_VENDOR:
    case CL_DRIVER_VERSION:
    case CL_DEVICE_VERSION:
    case CL_DEVICE_EXTENSIONS:
      return answer_text("fake", room, to, needed);
    case CL_DEVICE_TYPE:
      return answer(&device->type, sizeof device->type, room, to, needed);
    case CL_DEVICE_GLOBAL_MEM_SIZE:
    case CL_DEVICE_MAX_MEM_ALLOC_SIZE:
      return answer(&bytes, sizeof bytes, room, to, needed);
    case CL_DEVICE_MAX_COMPUTE_UNITS:
      return answer(&units, sizeof units, room, to, needed);
    case CL_DEVICE_MAX_WORK_GROUP_SIZE:
      return answer(&group, sizeof group, room, to, needed);
    case CL_DEVICE_AVAILABLE:
      return answer(&yes, sizeof yes, room, to, needed);
    case CL_DEVICE_COMPILER_AVAILABLE:
      return answer(&device->compiler, sizeof device->compiler, room, to, needed);
    case CL_DEVICE_ENDIAN_LITTLE:
      return answer(&device->little_endian, sizeof device->little_endian, room, to, needed);
    default:
      return CL_INVALID_VALUE;
  }
}

struct AtExit {
  ~AtExit() {
    while (std::getenv("FAKE_DRIVER_NEVER_ENDS")) ::pause();
  }
} at_exit;

/// As LLVM's compiler does, in the place of the program's own handlers.
struct AtStart {
  AtStart() {
    if (!std::getenv("FAKE_DRIVER_TAKES_SIGNALS")) return;
    for (const int signal : {SIGINT, SIGTERM})
      std::signal(signal, [](int) {
        constexpr std::string_view complaint = "1 error generated.\n";
        if (::write(STDERR_FILENO, complaint.data(), complaint.size()) < 0) ::_exit(1);
      });
  }
} at_start;

}  // namespace

extern "C" __attribute__((visibility("default"))) void* clGetExtensionFunctionAddress(const char* name) {
  dispatch.clGetPlatformInfo = platform_info;
  dispatch.clGetDeviceIDs = get_devices;
  dispatch.clGetDeviceInfo = device_info;
  if (std::string_view(name) == "clIcdGetPlatformIDsKHR") return reinterpret_cast<void*>(get_platforms);
  if (std::string_view(name) == "clGetPlatformInfo") return reinterpret_cast<void*>(platform_info);
  return nullptr;
}
