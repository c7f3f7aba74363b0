// Compiles tinybvh's kernel files after the declarations that they need; leaves out a kernel that fails.
#include "tinybvh_peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <tuple>

#include "base/file.h"

namespace sundog {
namespace {

using PeerRay = TinyBvhRay;
using PeerNode = tinybvh_kernels::BVHNode;

// Declarations that tinybvh's kernel files need before them.
constexpr const char* prelude = R"(
struct BVHNode { float4 lmin, lmax, rmin, rmax; };
struct Ray { float4 O, D, rD, hit; };
#define STACK_SIZE 64
)";

float reciprocal(float x) { return std::abs(x) > 1e-12f ? 1 / x : tinybvh_far; }

/// One of tinybvh's kernels, for nearest hits and for any hit; some versions lack the latter.
template <class... Tables>
struct PeerKernels {
  using Type = Kernel<Buffer<Tables>..., Buffer<PeerRay>>;
  Type nearest;
  std::optional<Type> any;
  std::tuple<Buffer<Tables>...> tables;
};

template <class... Tables>
PeerKernels<Tables...> build_peer(Device& device, const TinyBvhOptions& options, const std::string& file,
                                  const std::string& kernel, const std::string& defines,
                                  Buffer<Tables>... tables) {
  const std::string text = read_file(options.folder + "/kernels/" + file);
  device.build_with({options.build, false});
  const Program program =
      device.build("tinybvh_" + file, {}, nullptr, {{"tinybvh_" + file, defines + prelude + text}});
  device.build_with({});
  PeerKernels<Tables...> kernels{
      program.kernel<Buffer<Tables>..., Buffer<PeerRay>>(kernel), {}, {std::move(tables)...}};
  const std::vector<std::string> names = program.kernel_names();
  if (std::ranges::count(names, kernel + "_any") > 0)
    kernels.any = program.kernel<Buffer<Tables>..., Buffer<PeerRay>>(kernel + "_any");
  return kernels;
}

template <class... Tables>
Contestant contestant(std::string name, Device& device, Buffer<PeerRay>& rays, const std::size_t& count,
                      unsigned group, PeerKernels<Tables...> made) {
  auto kernels = std::make_shared<PeerKernels<Tables...>>(std::move(made));
  const auto read = [&device, &rays] {
    std::vector<PeerRay> values(rays.count);
    device.read(rays, std::span<PeerRay>(values));
    return values;
  };
  Contestant result{std::move(name), {}, {}, {}, kernels->any.has_value(), {}};
  result.run = [kernels, &device, &rays, group](const RaySet& set) {
    auto& kernel = set.any ? *kernels->any : kernels->nearest;
    device.forget_times();
    const LaunchSize size{rays.count, 1, group, 1};
    const auto run = [&](const auto&... tables) { device.run(kernel, size, tables..., rays); };
    std::apply(run, kernels->tables);
    device.finish();
    return 1e-3 * device.times().at(kernel.name).device_ms;
  };
  result.distances = [read, &count] {
    std::vector<float> distances;
    for (const PeerRay& ray : read()) distances.push_back(ray.hit.x);
    distances.resize(count);
    return distances;
  };
  result.occluded = [read, &count] {
    std::vector<bool> hits;
    for (const PeerRay& ray : read()) hits.push_back(std::bit_cast<u32>(ray.hit.w) != 0);
    hits.resize(count);
    return hits;
  };
  return result;
}

std::string definitions(const TinyBvhOptions& options, const Device& device, const TinyBvhTables& tables) {
  std::string text;
  for (const std::string& define : options.defines) {
    const std::size_t equals = define.find('=');
    text += fmt::format("#define {} {}\n", define.substr(0, equals),
                        equals == std::string::npos ? "" : define.substr(equals + 1));
  }
  if (device.nvidia()) text += "#define ISNVIDIA\n";
  if (tables.compressed_triangles) text += "#define CWBVH_COMPRESSED_TRIS\n";
  return text;
}

}  // namespace

std::vector<TinyBvhRay> tinybvh_rays(const std::vector<Ray>& rays, unsigned group) {
  std::vector<PeerRay> result;
  for (const Ray& ray : rays)
    result.push_back({{ray.ox, ray.oy, ray.oz, 0},
                      {ray.dx, ray.dy, ray.dz, 0},
                      {reciprocal(ray.dx), reciprocal(ray.dy), reciprocal(ray.dz), 0},
                      {tinybvh_far, 0, 0, 0}});
  while (result.size() % group != 0) result.push_back(result.back());
  return result;
}

std::vector<Contestant> tinybvh_kernels_of(const TinyBvhOptions& options, Device& device,
                                           const TinyBvhTables& tables, Buffer<PeerRay>& rays,
                                           const std::size_t& count) {
  std::vector<Contestant> result;
  const std::string defines = definitions(options, device, tables);
  const auto try_one = [&](const char* name, const auto& make) {
    try {
      result.push_back(contestant(name, device, rays, count, options.group, make()));
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: left out: {}\n", name, error.what());
    }
  };
  const auto upload = [&](const auto& values) { return device.upload(std::span(values)); };
  try_one("cwbvh", [&] {
    return build_peer(device, options, "traverse_cwbvh.cl", "batch_cwbvh", defines, upload(tables.nodes),
                      upload(tables.triangles));
  });
  try_one("bvh2", [&] {
    std::vector<PeerNode> nodes(tables.nodes2.size() / 4);
    for (std::size_t i = 0; i < tables.nodes2.size(); ++i) nodes[i / 4].words[i % 4] = tables.nodes2[i];
    return build_peer(device, options, "traverse_bvh2.cl", "batch_ailalaine", defines, upload(nodes),
                      upload(tables.order2), upload(tables.vertices2));
  });
  return result;
}

}  // namespace sundog
