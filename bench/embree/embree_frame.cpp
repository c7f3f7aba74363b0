// embree_frame MODEL... : a whole Whitted frame, a glass model between mirror balls, by sundog and by the
// same integrator as a plain C++ program over Embree, in turn and on the same number of threads. sundog is
// charged from the first launch until the picture is on the host, in the tiles that `sundog render` takes;
// the C++ program for its threads' work. Building kernels and trees counts for neither. A time counts only if
// the pictures agree; both count their rays.
#include <fmt/format.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/environment.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "bench/frames/frame_runner.h"
#include "bench/plain/whitted.h"
#include "bench_scenes.h"
#include "device/devices.h"
#include "embree_finder.h"
#include "peer_program.h"

using namespace sundog;

namespace {

struct Options : PeerOptions {
  std::vector<unsigned> threads{1, 2};
  std::string device = "cpu", pictures;
  int size = 640, depth = 8;
  bool filtered = false;
};

/// The C++ program: threads take tiles of 16x16 pixels from a counter.
class PlainProgram {
 public:
  PlainProgram(const SceneDescription& description, const CompiledScene& scene)
      : finder_(description, scene),
        frame_(scene, finder_),
        tiles_(cut_tiles(description.image.width, description.image.height, 16)),
        image_(description.image.width, description.image.height, 4) {}

  void run(unsigned threads) {
    std::atomic<std::size_t> next{0};
    counts_.fill(0);
    std::vector<std::thread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back([&] { take_tiles(next); });
    take_tiles(next);
    for (std::thread& other : others) other.join();
  }
  const Image& image() const { return image_; }
  const RayCounts& counts() const { return counts_; }

 private:
  void take_tiles(std::atomic<std::size_t>& next) {
    const unsigned mode = _mm_getcsr();  // denormals as zero, as Embree wants it
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    RayCounts counts{};
    for (std::size_t i; (i = next++) < tiles_.size();) frame_.render(tiles_[i], image_, counts);
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < COUNTERS; ++i) counts_[i] += counts[i];
    _mm_setcsr(mode);
  }

  EmbreeFinder finder_;
  PlainFrame frame_;
  std::vector<Tile> tiles_;
  Image image_;
  RayCounts counts_{};
  std::mutex mutex_;
};

nlohmann::json rays_of(const RayCounts& counts) {
  return {{"primary", counts[COUNT_PRIMARY]},
          {"reflection", counts[COUNT_REFLECTION]},
          {"refraction", counts[COUNT_REFRACTION]},
          {"shadow", counts[COUNT_SHADOW]}};
}

void print_rays(const char* who, const RayCounts& counts) {
  const auto million = [&](int kind) {
    return static_cast<double>(counts[static_cast<std::size_t>(kind)]) * 1e-6;
  };
  fmt::print("  {:<10} {:.4f} M primary, {:.4f} M reflected, {:.4f} M refracted, {:.4f} M shadow rays\n", who,
             million(COUNT_PRIMARY), million(COUNT_REFLECTION), million(COUNT_REFRACTION),
             million(COUNT_SHADOW));
}

/// Throws when the pictures are not the same but for rounding.
ImageDifference check_pictures(const Options& options, const std::string& model, const Image& ours,
                               const Image& theirs) {
  if (!options.pictures.empty()) {
    const std::filesystem::path folder = options.pictures, name = std::filesystem::path(model).stem();
    write_image(ours, folder / (name.string() + "_sundog.png"));
    write_image(theirs, folder / (name.string() + "_embree.png"));
  }
  const ImageDifference difference = compare_images(theirs, ours, 0.02);
  if (difference.mean > 0.005)
    throw std::runtime_error(
        fmt::format("{}: the pictures differ by {:.4f} in the mean: no time counts", model, difference.mean));
  return difference;
}

nlohmann::json compare_times(const Options& options, unsigned threads, FrameRunner& ours,
                             PlainProgram& theirs) {
  std::vector<double> a, b, ratio;
  for (unsigned i = 0; i < options.repeats; ++i) {
    a.push_back(1e3 * elapsed([&] { ours.run(); }).of_thread(threads, options.wall));
    b.push_back(1e3 * elapsed([&] { theirs.run(threads); }).of_thread(threads, options.wall));
    ratio.push_back(b.back() / a.back());
  }
  const Spread r = spread(ratio);
  fmt::print("  {:>7}{:>12.1f}{:>12.1f}{:>8.2f} ({:.2f}..{:.2f})\n", threads, spread(a).median,
             spread(b).median, r.median, r.min, r.max);
  std::fflush(stdout);
  return {{"threads", threads},
          {"sundog_ms", to_json(spread(a))},
          {"embree_ms", to_json(spread(b))},
          {"ratio", to_json(r)}};
}

SceneDescription frame_scene(const Options& options, const std::string& model) {
  SceneDescription scene = glass_scene(
      model, {fmt::format("/image/width={}", options.size), fmt::format("/image/height={}", options.size),
              fmt::format("/render/max_depth={}", options.depth),
              fmt::format("/render/spatial_splits={}", options.spatial_splits)});
  for (MaterialDescription& material : scene.materials)
    if (options.filtered) material.shadow_opaque = false;
  return scene;
}

nlohmann::json compare_frames(const Options& options, const std::string& model) {
  const SceneDescription description = frame_scene(options, model);
  const CompiledScene scene = compile(description);
  const DeviceInfo whole = select_devices(enumerate_devices(plain_environment()), {options.device}).at(0);
  PlainProgram theirs(description, scene);
  fmt::print("{}: {} triangles, {}x{}, depth {}, {} shadows, {}, {} clock\n", model, scene.figures.triangles,
             options.size, options.size, options.depth, options.filtered ? "filtered" : "opaque",
             whole.label(), options.wall ? "wall" : "processor's");
  nlohmann::json result{{"model", model},
                        {"triangles", scene.figures.triangles},
                        {"size", options.size},
                        {"depth", options.depth},
                        {"device", whole.label()},
                        {"driver", whole.driver},
                        {"clock", options.wall ? "wall" : "processor"},
                        {"frames", nlohmann::json::array()}};
  for (const unsigned threads : options.threads) {
    DeviceInfo part = whole;
    part.sub_units = threads < whole.compute_units ? threads : 0;
    FrameRunner ours(part, scene);
    ours.run();
    if (result["frames"].empty()) {
      theirs.run(threads);
      const ImageDifference d = check_pictures(options, model, ours.image(), theirs.image());
      print_rays("sundog", ours.counts());
      print_rays("C++ Embree", theirs.counts());
      fmt::print(
          "  pictures differ by {:.5f} in the mean, {} pixels of {} by more than 0.02\n  "
          "{:>7}{:>12}{:>12}{:>8}\n",
          d.mean, d.over_tolerance, d.pixels, "threads", "sundog ms", "Embree ms", "ratio");
      result["difference"] = {{"mean", d.mean}, {"over_0.02", d.over_tolerance}};
      result["rays"] = {{"sundog", rays_of(ours.counts())}, {"embree", rays_of(theirs.counts())}};
    }
    result["frames"].push_back(compare_times(options, threads, ours, theirs));
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Arguments app{"A whole Whitted frame by sundog and by plain C++ over Embree, in turn"};
  add_peer_options(app, options);
  app.add_option("--threads", options.threads, "numbers of threads to try");
  app.add_option("--size", options.size, "pixels along each side of the image")->positive();
  app.add_option("--depth", options.depth, "surfaces along a path")->positive();
  app.add_option("--device", options.device, "SPEC of the device");
  app.add_option("--pictures", options.pictures, "folder for both pictures");
  app.add_flag("--filtered", options.filtered, "glass filters light; else it casts shadows");
  return run_peer_program(app, argc, argv, options,
                          [&](const std::string& model) { return compare_frames(options, model); });
}
