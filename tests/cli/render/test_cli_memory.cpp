// A frame that does not fit into memory is refused before the work begins; what one takes is stated.
#include <base/file.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

namespace {

/// With no more address space than so many KiB, and a denoiser to load.
CommandResult limited(const CliFolder& folder, const char* kibibytes, const char* size, const char* out,
                      const char* more = "") {
  CommandOptions options;
  options.environment = {{"SUNDOG_OIDN", std::filesystem::path(SUNDOG_FAKE_DRIVER).parent_path().string()}};
  return run_command({"sh", "-c", "ulimit -v $1; exec \"$0\" render \"$2\" -o \"$3\" --size $4 $5",
                      SUNDOG_BINARY, kibibytes, folder.scene, folder.file(out), size, more},
                     options);
}

/// The number before `word` in the message.
double number_before(const std::string& text, const std::string& word) {
  const std::size_t end = text.find(word);
  if (end == std::string::npos || end < 2) return -1;
  return std::stod(text.substr(text.find_last_of(" (", end - 1) + 1));
}

}  // namespace

TEST_CASE("a frame that does not fit into memory is refused with the figures, before the work begins") {
  const CliFolder folder;
  const CommandResult result = limited(folder, "4000000", "16384x16384", "a.exr");
  CAPTURE(result.err);
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
  CHECK(
      result.err.find("a frame of 16384x16384 pixels takes 15.8 GiB of memory (63 bytes a pixel), and 3.") !=
      std::string::npos);
  CHECK(result.err.find("GiB are available") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_CASE("the denoiser's memory counts: second pictures, its own, and at most 1 GiB that it is given") {
  const CliFolder folder;
  for (const char* more : {"--aov albedo --aov normal", "--aov albedo --aov normal --denoise"}) {
    const CommandResult result = limited(folder, "4000000", "16384x16384", "a.exr", more);
    CAPTURE(result.err);
    CHECK(result.status == 1);
    const bool denoise = std::string(more).ends_with("denoise");
    const double bytes = number_before(result.err, " bytes a pixel"),
                 whole = number_before(result.err, " GiB of memory");
    CHECK(bytes == (denoise ? 299 : 159));
    CHECK(std::abs(whole - (bytes / 4 + (denoise ? 1 : 0))) < 0.06);
  }
}

TEST_CASE("a frame takes no more memory than is said") {
  const CliFolder folder;
  const std::string scene = folder.write("least.json", least_scene).string();
  const auto peak = [&](const std::string& out, const char* size, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", scene, "-o", folder.file(out), "--size", size, "--stats",
                               folder.file("stats.json"), "--verbose", "--device", "0:0", "--tile", "128"});
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const auto stats = nlohmann::json::parse(sundog::read_file(folder / "stats.json"));
    return std::pair(stats["peak_memory"].get<double>(), number_before(result.out, " bytes a pixel"));
  };
  const std::vector<std::string> aovs = {"--aov", "depth", "--aov", "crypto_object"};
  for (const char* out : {"a.png", "a.jpg", "a.pfm", "a.exr", "aovs.exr"}) {
    const std::vector<std::string> more = out[1] == '.' ? std::vector<std::string>() : aovs;
    peak(out, "256x256", more);  // its kernels are in the cache then
    const auto [small, same] = peak(out, "256x256", more);
    const auto [large, said] = peak(out, "2048x2048", more);
    CAPTURE(out, said);
    CHECK((large - small) / (2048 * 2048 - 256 * 256) <= said);
  }
}

TEST_CASE("--verbose states the memory of the frame") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"), "--size", "512x512", "--verbose"});
  REQUIRE(result.status == 0);
  CHECK(result.out.find("memory of the frame") != std::string::npos);
  CHECK(result.out.find("13.8 MiB, 55 bytes a pixel") != std::string::npos);
}
