// embree_rays MODEL... : traces the same rays with sundog's tracer and with Embree, in turn, on the same
// number of threads, and prints millions of rays a second and their ratio by kind of ray. Embree gets its own
// input format (one filled RTCRayHit per ray); sundog's time includes launch and wait. Compares the hits: if
// sundog's answer is wrong by more than rounding (bench/rays/check_hits.h), the program fails.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench/rays/check_hits.h"
#include "embree_peer.h"
#include "peer_rays.h"

using namespace sundog;

namespace {

struct Options : RayOptions {
  bool packets = false;
};

/// Rays for which the two disagree: one hits and the other does not, or the distances differ.
struct Mismatches {
  std::size_t count = 0;  // all of them
  std::size_t wrong = 0;  // rays for which sundog's answer is not right within rounding

  template <class Answer>
  void add(const CompiledScene& scene, const Ray& ray, const Answer& answer) {
    ++count;
    wrong += wrong >= 1000 || !is_right(scene, ray, answer);  // enough to fail: further ones are not checked
  }
};

bool same(const Hit& ours, const EmbreeHit& theirs) {
  const bool a = ours.instance != NO_INSTANCE, b = theirs.prim != NO_PRIM;
  return a == b && (!a || std::abs(ours.t - theirs.t) <= 1e-4f * theirs.t);
}

class Comparison {
 public:
  Comparison(const Options& options, const CompiledScene& scene, RayTracer& tracer, const EmbreePeer& embree)
      : options_(options), scene_(scene), tracer_(tracer), embree_(embree) {}

  /// Rays of all sets so far that sundog answered wrongly.
  std::size_t wrong() const { return wrong_; }

  nlohmann::json run(const RaySet& set) {
    set_ = &set;
    hits_.resize(set.rays.size());
    occluded_.resize(set.rays.size());
    tracer_.upload(set.rays);
    ours();
    theirs(EmbreeWidth::single);
    const Mismatches mismatches = compare();
    wrong_ += mismatches.wrong;
    std::vector<double> a, b, c, ratio, packet_ratio;
    for (unsigned i = 0; i < options_.repeats; ++i) {
      const double mine = rate([&] { ours(); });
      const double single = rate([&] { theirs(EmbreeWidth::single); });
      a.push_back(mine);
      b.push_back(single);
      ratio.push_back(mine / single);
      if (options_.packets) {
        c.push_back(rate([&] { theirs(EmbreeWidth::packet16); }));
        packet_ratio.push_back(mine / c.back());
      }
    }
    const Spread r = spread(ratio);
    fmt::print("  {:<11}{:>9}{:>9.2f}{:>9.2f}{:>8.2f} ({:.2f}..{:.2f})", set.kind, set.rays.size(),
               spread(a).median, spread(b).median, r.median, r.min, r.max);
    if (options_.packets) fmt::print("{:>9.2f}{:>7.2f}", spread(c).median, spread(packet_ratio).median);
    fmt::print("{:>8}{}\n", mismatches.count,
               mismatches.wrong ? fmt::format(", {} of them wrong", mismatches.wrong) : "");
    std::fflush(stdout);
    return {{"kind", set.kind},
            {"rays", set.rays.size()},
            {"sundog_mrays", to_json(spread(a))},
            {"embree_mrays", to_json(spread(b))},
            {"embree_packet16_mrays", to_json(spread(c))},
            {"ratio", to_json(r)},
            {"ratio_to_packet16", to_json(spread(packet_ratio))},
            {"mismatches", mismatches.count},
            {"wrong", mismatches.wrong}};
  }

 private:
  void ours() { tracer_.run({set_->any, set_->coherent}); }
  void theirs(EmbreeWidth width) {
    if (set_->any)
      embree_.occluded(set_->rays, occluded_, options_.threads, width, set_->coherent);
    else
      embree_.intersect(set_->rays, hits_, options_.threads, width, set_->coherent);
  }
  Mismatches compare() {
    Mismatches found;
    const std::vector<Ray>& rays = set_->rays;
    if (set_->any) {
      const std::vector<u32> mine = tracer_.occluded();
      for (std::size_t i = 0; i < mine.size(); ++i)
        if (mine[i] != occluded_[i]) found.add(scene_, rays[i], mine[i] != 0);
    } else {
      const std::vector<Hit> mine = tracer_.hits();
      for (std::size_t i = 0; i < mine.size(); ++i)
        if (!same(mine[i], hits_[i])) found.add(scene_, rays[i], mine[i]);
    }
    return found;
  }
  template <class Work>
  double rate(const Work& work) const {
    const double seconds = elapsed(work).of_thread(options_.threads, options_.wall);
    return static_cast<double>(set_->rays.size()) / seconds * 1e-6;
  }

  const Options& options_;
  const CompiledScene& scene_;
  RayTracer& tracer_;
  const EmbreePeer& embree_;
  const RaySet* set_ = nullptr;
  std::vector<EmbreeHit> hits_;
  std::vector<u32> occluded_;
  std::size_t wrong_ = 0;
};

nlohmann::json compare_model(const Options& options, const std::string& path) {
  PeerModel model(path, options);
  const EmbreePeer embree(model.description);
  const BvhFigures& figures = model.scene.figures;
  fmt::print("{}: {} triangles, {} thread(s) of {}; build {:.0f} ms, Embree {:.0f} ms\n", path,
             figures.triangles, options.threads, model.device.info().label(), figures.build_seconds * 1e3,
             embree.build_seconds() * 1e3);
  fmt::print("  {:<11}{:>9}{:>9}{:>9}{:>8}{:>15}\n", "Mrays/s", "rays", "sundog", "Embree", "ratio",
             "differ");
  nlohmann::json result = model.facts();
  result["threads"] = options.threads;
  result["clock"] = options.wall ? "wall" : "processor";
  result["sets"] = nlohmann::json::array();
  Comparison comparison(options, model.scene, model.tracer, embree);
  for (const RaySet& set : model.rays(options)) result["sets"].push_back(comparison.run(set));
  if (comparison.wrong() > 0)
    throw DeviceError(
        fmt::format("{}: {} rays have wrong answers of sundog's: no ratio counts", path, comparison.wrong()));
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Arguments app{"The same rays through sundog's tracer and through Embree, in turn"};
  options.threads = 1;
  add_ray_options(app, options);
  app.add_option("--threads", options.threads, "compute units and Embree threads");
  app.add_flag("--packets", options.packets, "also Embree's 16-wide packets");
  return run_peer_program(app, argc, argv, options,
                          [&](const std::string& model) { return compare_model(options, model); });
}
