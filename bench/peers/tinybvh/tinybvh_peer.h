// tinybvh's OpenCL kernels as something that traces rays on a device, beside sundog's tracer.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/rays/ray_sets.h"
#include "device/device.h"
#include "tinybvh_tables.h"

/// Its structs by the names that its kernels have.
namespace tinybvh_kernels {
using sundog::float4;
struct Ray {
  float4 origin, direction, reciprocal, hit;  // hit: t, u, v, triangle; any hit: w is not 0
};
struct BVHNode {
  float4 words[4];
};
}  // namespace tinybvh_kernels

namespace sundog {

using TinyBvhRay = tinybvh_kernels::Ray;

constexpr float tinybvh_far = 1e30f;  // the end of its rays

struct TinyBvhOptions {
  std::string folder, build = "-cl-fast-relaxed-math -cl-mad-enable";
  std::vector<std::string> defines;  // NAME=VALUE
  unsigned group = 64;
};

/// In its form, the last one again until groups of that size are whole: its kernels compare their index with
/// no count.
std::vector<TinyBvhRay> tinybvh_rays(const std::vector<Ray>& rays, unsigned group);

/// Something that traces: rays to hits, in seconds.
struct Contestant {
  std::string name;
  std::function<double(const RaySet&)> run;       // kernel seconds; 0: the driver gives no times
  std::function<std::vector<float>()> distances;  // of nearest hits; tinybvh_far: none
  std::function<std::vector<bool>()> occluded;
  bool any = true;
  std::vector<double> mrays;
};

/// The kernels that the checkout has and the driver builds; the others are reported on stderr. They trace the
/// first `count` of `rays` as these are at the time of a run.
std::vector<Contestant> tinybvh_kernels_of(const TinyBvhOptions& options, Device& device,
                                           const TinyBvhTables& tables, Buffer<TinyBvhRay>& rays,
                                           const std::size_t& count);

}  // namespace sundog
