// Frames in passes from the command line: what ends them early, and that they continue to the same bits.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"
#include "same_bits.h"

using namespace sundog;

namespace {

std::vector<std::string> passes(const CliFolder& folder, const std::string& out, int samples,
                                const std::vector<std::string>& more) {
  std::vector<std::string> all = {
      "render",   folder.scene, "-o",    folder.file(out),          "--samples", std::to_string(samples),
      "--device", "0:0",        "--set", "/render/progressive=true"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

nlohmann::json sampling_of(const CliFolder& folder, const std::string& stats) {
  return nlohmann::json::parse(read_file(folder / stats)).at("sampling");
}

}  // namespace

TEST_CASE("a frame that its time limit ended continues to the bits of one that had time") {
  const CliFolder folder;
  // No machine finishes 64 samples in a microsecond.
  const CommandResult ended = run_sundog(
      passes(folder, "a.pfm", 64,
             {"--time-limit", "1e-6", "--resume", folder.file("c"), "--stats", folder.file("a.json")}));
  CAPTURE(ended.out, ended.err);
  REQUIRE(ended.status == 0);
  CHECK(ended.out.find("the time limit of 1e-06 s ended it, passed by ") != std::string::npos);
  CHECK(ended.out.find("interpolated") == std::string::npos);
  const nlohmann::json sampling = sampling_of(folder, "a.json");
  CHECK(sampling.at("time_limited") == true);
  CHECK(sampling.at("interpolated") == 0);
  CHECK(sampling.at("samples_a_pixel").get<double>() < 64);
  REQUIRE(std::filesystem::exists(folder / "c"));

  const CommandResult resumed = run_sundog(passes(folder, "a.pfm", 64, {"--resume", folder.file("c")}));
  CAPTURE(resumed.err);
  REQUIRE(resumed.status == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "c"));
  REQUIRE(run_sundog(passes(folder, "whole.pfm", 64, {})).status == 0);
  CHECK(read_file(folder / "a.pfm") == read_file(folder / "whole.pfm"));
}

TEST_CASE("a checkpoint of a frame with a time limit asks for one") {
  const CliFolder folder;
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = {"render", folder.scene, "-o",  folder.file("a.pfm"), "--samples",
                                    "64",     "--device",   "0:0", "--resume",           folder.file("c")};
    all.insert(all.end(), more.begin(), more.end());
    return run_sundog(all);
  };
  REQUIRE(render({"--time-limit", "1e-6"}).status == 0);
  REQUIRE(std::filesystem::exists(folder / "c"));
  const CommandResult without = render({}), other = render({"--time-limit", "1e-6", "--size", "20x10"});
  CHECK(without.status == 2);
  CHECK(without.err ==
        "sundog: " + folder.file("c") +
            ": is a checkpoint of a frame in passes: give the --time-limit, --noise-threshold, "
            "--adaptive or --subsample that it was made with, or remove it to start anew\n");
  CHECK(other.status == 2);
  CHECK(other.err.find("pixels, and the frame has 20x10") != std::string::npos);
}

TEST_CASE("a time limit below a compiler's time waits for it and for a pass, and each call gets further") {
  CliFolder folder;
  folder.scene = folder.write("least.json", least_scene).string();
  CommandOptions cold;
  cold.environment["XDG_CACHE_HOME"] = folder.file("cold");
  const auto call = [&] {
    return run_sundog(passes(folder, "a.pfm", 4,
                             {"--time-limit", "1e-6", "--resume", folder.file("c"), "--stats",
                              folder.file("a.json"), "--write-every", "0.01"}),
                      cold);
  };
  const CommandResult first = call();
  CAPTURE(first.out, first.err);
  REQUIRE(first.status == 0);
  CHECK(first.out.find("the time limit of 1e-06 s ended it, passed by ") != std::string::npos);
  CHECK(first.out.find("100 % of the pixels are in ") != std::string::npos);
  CHECK(sampling_of(folder, "a.json").at("samples_a_pixel") == 1);
  int calls = 1;
  constexpr int enough = 40;  // a call makes a tile, or several
  for (; std::filesystem::exists(folder / "c") && calls < enough; ++calls) REQUIRE(call().status == 0);
  CHECK(calls < enough);
  CHECK(nlohmann::json::parse(read_file(folder / "a.json")).at("kernels_cached") == true);
  REQUIRE(run_sundog(passes(folder, "whole.pfm", 4, {})).status == 0);
  CHECK(read_file(folder / "a.pfm") == read_file(folder / "whole.pfm"));
}

TEST_CASE("a noise threshold ends a frame at a pass, with its bits, and the error is below it") {
  const CliFolder folder;
  const double threshold = 0.01;
  REQUIRE(
      run_sundog(passes(folder, "a.pfm", 4096,
                        {"--noise-threshold", std::to_string(threshold), "--stats", folder.file("a.json")}))
          .status == 0);
  const nlohmann::json sampling = sampling_of(folder, "a.json");
  const int samples = sampling.at("most");
  CHECK(samples >= 2);
  CHECK(samples <= 1024);
  CHECK((samples & (samples - 1)) == 0);  // passes double them
  CHECK(sampling.at("samples_a_pixel") == samples);
  CHECK(sampling.at("camera_rays_saved").get<double>() == Approx(1 - samples / 4096.0));
  REQUIRE(run_sundog(passes(folder, "same.pfm", samples, {})).status == 0);
  CHECK(read_file(folder / "a.pfm") == read_file(folder / "same.pfm"));
  // The estimate stands for the error: it may be wrong by a factor, not by an order.
  REQUIRE(run_sundog(passes(folder, "many.pfm", 1024, {})).status == 0);
  CHECK(compare_images(read_image(folder / "a.pfm"), read_image(folder / "many.pfm"), 0).mean <
        3 * threshold);
}

TEST_CASE("--write-every writes the picture so far, which becomes the whole one") {
  const CliFolder folder;
  // Killed as soon as there is a picture: only --write-every can have written it.
  CommandOptions options;
  options.folder = folder.path();
  std::vector<std::string> command = {
      "sh", "-c", R"("$0" "$@" & until [ -s a.pfm ]; do sleep 0.02; done; kill -KILL $!; wait $!)",
      SUNDOG_BINARY};
  const std::vector<std::string> render = passes(folder, "a.pfm", 65536, {"--write-every", "0.01"});
  command.insert(command.end(), render.begin(), render.end());
  const CommandResult killed = run_command(command, options);
  CAPTURE(killed.err);
  REQUIRE(killed.status == 128 + SIGKILL);
  const Image image = read_image(folder / "a.pfm");
  CHECK(image.width == 32);
  CHECK(*std::ranges::max_element(image.data) > 0.1f);

  REQUIRE(run_sundog(passes(folder, "b.pfm", 16, {"--write-every", "0.001"})).status == 0);
  REQUIRE(run_sundog(passes(folder, "whole.pfm", 16, {})).status == 0);
  CHECK(read_file(folder / "b.pfm") == read_file(folder / "whole.pfm"));
}
