// tinybvh_rays MODEL... : traces the same rays with sundog's tracer and with the OpenCL kernels of tinybvh
// (https://github.com/jbikker/tinybvh: two-wide after Aila and Laine, compressed eight-wide) on one device,
// in turn, and prints millions of rays a second by kernel time (by the host's clock if the driver gives no
// times) and their ratio by kind of ray. tinybvh's kernels do not bound rays, so both tracers get rays that
// start at 0 and do not end: a shadow ray continues past its light. Differing hits are counted and printed.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "peer_rays.h"
#include "tinybvh_peer.h"

using namespace sundog;

namespace {

struct Options : RayOptions {
  TinyBvhOptions peer;
};

/// The rays with t from 0 to tinybvh_far.
RaySet without_ends(RaySet set) {
  for (Ray& ray : set.rays) {
    ray.ox += ray.t_min * ray.dx;
    ray.oy += ray.t_min * ray.dy;
    ray.oz += ray.t_min * ray.dz;
    ray.t_min = 0;
    ray.t_max = tinybvh_far;
  }
  return set;
}

Contestant sundog_contestant(RayTracer& tracer) {
  Contestant result{"sundog", {}, {}, {}, true, {}};
  result.run = [&](const RaySet& set) { return tracer.run({set.any, set.coherent}); };
  result.distances = [&] {
    std::vector<float> distances;
    for (const Hit& hit : tracer.hits())
      distances.push_back(hit.instance == NO_INSTANCE ? tinybvh_far : hit.t);
    return distances;
  };
  result.occluded = [&] {
    std::vector<bool> hits;
    for (const u32 hit : tracer.occluded()) hits.push_back(hit != 0);
    return hits;
  };
  return result;
}

/// Rays for which the two disagree: one hits and the other does not, or the distances differ.
std::size_t count_mismatches(const RaySet& set, const Contestant& ours, const Contestant& theirs) {
  std::size_t count = 0;
  if (set.any) {
    const std::vector<bool> a = ours.occluded(), b = theirs.occluded();
    for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  } else {
    const std::vector<float> a = ours.distances(), b = theirs.distances();
    for (std::size_t i = 0; i < a.size(); ++i) count += !(std::abs(a[i] - b[i]) <= 1e-4f * b[i]);
  }
  return count;
}

/// Millions of rays a second of one run; clears `by_events` if the driver gives no kernel time.
double rate(Contestant& who, const RaySet& set, bool& by_events) {
  const Stopwatch clock;
  const double kernel = who.run(set), wall = clock.seconds();
  by_events = by_events && kernel > 0;
  who.mrays.push_back(1e-6 * static_cast<double>(set.rays.size()) / (kernel > 0 ? kernel : wall));
  return who.mrays.back();
}

nlohmann::json compare(const Options& options, const RaySet& set, std::vector<Contestant>& all) {
  nlohmann::json result{{"kind", set.kind}, {"rays", set.rays.size()}};
  std::vector<std::size_t> differ(all.size());
  std::vector<std::vector<double>> ratios(all.size());
  bool by_events = true;
  const auto runs = [&](const Contestant& who) { return who.any || !set.any; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].mrays.clear();
    if (!runs(all[i])) continue;
    all[i].run(set);
    if (i > 0) differ[i] = count_mismatches(set, all[0], all[i]);
  }
  for (unsigned n = 0; n < options.repeats; ++n) {
    const double ours = rate(all[0], set, by_events);
    for (std::size_t i = 1; i < all.size(); ++i)
      if (runs(all[i])) ratios[i].push_back(ours / rate(all[i], set, by_events));
  }
  fmt::print("  {:<11}{:>9}{:>9.2f}", set.kind, set.rays.size(), spread(all[0].mrays).median);
  result["sundog_mrays"] = to_json(spread(all[0].mrays));
  result["clock"] = by_events ? "events" : "wall";
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::string& name = all[i].name;
    if (ratios[i].empty()) {
      fmt::print("{:>9}{:>8}{:>8}", "-", "-", "-");
      continue;
    }
    const Spread theirs = spread(all[i].mrays), ratio = spread(ratios[i]);
    fmt::print("{:>9.2f}{:>8.2f}{:>8}", theirs.median, ratio.median, differ[i]);
    result[name + "_mrays"] = to_json(theirs);
    result["ratio_to_" + name] = to_json(ratio);
    result[name + "_mismatches"] = differ[i];
  }
  fmt::print("\n");
  std::fflush(stdout);
  return result;
}

/// Three corners for each triangle, in world space.
std::vector<float4> corners_of(const SceneDescription& scene) {
  std::vector<float4> corners;
  for (const Mesh& mesh : scene.meshes)
    for (const glm::uvec3& triangle : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const glm::vec3& p = mesh.positions[triangle[k]];
        corners.push_back({p.x, p.y, p.z, 0});
      }
  return corners;
}

nlohmann::json compare_model(const Options& options, const std::string& path) {
  PeerModel model(path, options);
  const TinyBvhTables tables = tinybvh_tables(corners_of(model.description));
  Buffer<TinyBvhRay> rays;
  std::size_t count = 0;
  std::vector<Contestant> all = tinybvh_kernels_of(options.peer, model.device, tables, rays, count);
  if (all.empty())
    throw BuildError(fmt::format("{}: none of tinybvh's kernels runs here, for the reasons above (--tinybvh "
                                 "names a checkout with a folder of kernels)",
                                 options.peer.folder),
                     "");
  all.insert(all.begin(), sundog_contestant(model.tracer));
  const BvhFigures& figures = model.scene.figures;
  fmt::print("{}: {} triangles, {}, {} tracer; tinybvh {}; build {:.0f} ms, tinybvh {:.0f} ms\n", path,
             figures.triangles, model.device.info().label(), model.tracer_name(), tables.version,
             figures.build_seconds * 1e3, tables.build_seconds * 1e3);
  fmt::print("  {:<11}{:>9}{:>9}", "Mrays/s", "rays", "sundog");
  for (std::size_t i = 1; i < all.size(); ++i) fmt::print("{:>9}{:>8}{:>8}", all[i].name, "ratio", "differ");
  fmt::print("\n");
  nlohmann::json result = model.facts();
  result["tinybvh"] = tables.version;
  result["options"] = options.peer.build;
  result["sets"] = nlohmann::json::array();
  for (const RaySet& each : model.rays(options)) {
    const RaySet set = without_ends(each);
    model.tracer.upload(set.rays);
    count = set.rays.size();
    rays = model.device.upload(std::span<const TinyBvhRay>(tinybvh_rays(set.rays, options.peer.group)));
    result["sets"].push_back(compare(options, set, all));
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.peer.folder = TINYBVH_FOLDER;
  Arguments app{"The same rays through sundog's tracer and through tinybvh's OpenCL kernels, in turn"};
  options.device = "gpu";
  add_ray_options(app, options);
  app.add_option("--tracer", options.tracer, "sundog's: auto, wide or compact")
      ->one_of({"auto", "wide", "compact"});
  app.add_option("--tinybvh", options.peer.folder, "its checkout, for the kernels' text");
  app.add_option("--peer-options", options.peer.build, "build options of its kernels");
  app.add_option("--define", options.peer.defines, "NAME[=VALUE] for its kernels, such as USE_VLOAD_VSTORE");
  app.add_option("--group", options.peer.group, "work-items of a group of its kernels")->positive();
  return run_peer_program(app, argc, argv, options,
                          [&](const std::string& model) { return compare_model(options, model); });
}
