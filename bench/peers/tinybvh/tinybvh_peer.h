// Runs tinybvh's OpenCL kernels on a device, to compare them with sundog's tracer.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/rays/ray_sets.h"
#include "device/device.h"
#include "tinybvh_tables.h"

/// tinybvh's structs, under the names that its kernels use.
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

constexpr float tinybvh_far = 1e30f;  // end of tinybvh's rays; as a hit's distance: no hit

struct TinyBvhOptions {
  std::string folder, build = "-cl-fast-relaxed-math -cl-mad-enable";
  std::vector<std::string> defines;  // NAME=VALUE
  unsigned group = 64;
};

/// Converts rays to tinybvh's layout and repeats the last one to fill the last work-group, because tinybvh's
/// kernels do not check their index against a count.
std::vector<TinyBvhRay> tinybvh_rays(const std::vector<Ray>& rays, unsigned group);

/// A tracer in the comparison: sundog's, or one of tinybvh's kernels.
struct Contestant {
  std::string name;
  std::function<double(const RaySet&)> run;       // kernel seconds; 0: the driver gives no times
  std::function<std::vector<float>()> distances;  // of nearest hits; tinybvh_far: none
  std::function<std::vector<bool>()> occluded;
  bool any = true;
  std::vector<double> mrays;
};

/// The kernels that the checkout has and the driver builds; the others are reported on stderr. Each run reads
/// `rays` and `count` anew and returns results for the first `count` rays.
std::vector<Contestant> tinybvh_kernels_of(const TinyBvhOptions& options, Device& device,
                                           const TinyBvhTables& tables, Buffer<TinyBvhRay>& rays,
                                           const std::size_t& count);

}  // namespace sundog
