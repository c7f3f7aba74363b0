// Scalar and vector types shared by host and kernels: only 4-byte scalars and 16-byte vectors, so that OpenCL
// compilers lay out these structs like the host (a probe kernel checks it).
#pragma once

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
typedef uint u32;
typedef int i32;
#define SUNDOG_SHARED_BEGIN
#define SUNDOG_SHARED_END
#define SUNDOG_SHARED_SIZE(type, bytes)
#define SUNDOG_ENUM_OF_U32
#else
#include <cstdint>
#define SUNDOG_SHARED_BEGIN namespace sundog {
#define SUNDOG_SHARED_END }
#define SUNDOG_ENUM_OF_U32 : u32
#define SUNDOG_SHARED_SIZE(type, bytes) \
  static_assert(sizeof(type) == (bytes), #type " must be " #bytes " bytes");
namespace sundog {
using u32 = std::uint32_t;
using i32 = std::int32_t;
using u64 = std::uint64_t;
struct alignas(16) float4 {
  float x = 0, y = 0, z = 0, w = 0;
  friend bool operator==(const float4&, const float4&) = default;
};
}  // namespace sundog
#endif
