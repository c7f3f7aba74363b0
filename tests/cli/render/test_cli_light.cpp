// AOVs of light sum to the picture, whatever makes its pixels.
#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"
#include "light_boards.h"

using namespace sundog;

namespace {

struct LightFolder : CliFolder {
  std::string scene_file = write("boards.json", light_boards).string();

  std::vector<std::string> command(const std::vector<std::string>& more, const std::string& out) const {
    std::vector<std::string> all = {"render", scene_file, "-o", file(out), "--quiet", "--device", "0:0"};
    for (const std::string& part : light_part_names) all.insert(all.end(), {"--aov", part});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void render(std::vector<std::string> more) const {
    more.emplace_back("--float");
    const CommandResult result = run_sundog(command(more, "a.exr"));
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
  }
  bool sums_to_picture() const {
    const AovImages aovs = read_aovs(*this / "a.exr");
    const Image picture = read_image(*this / "a.exr");
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        for (int c = 0; c < 3; ++c) {
          float sum = 0;
          for (const std::string& part : light_part_names) sum += aovs.at(part).pixel(x, y)[c];
          if (sum != picture.pixel(x, y)[c]) return false;
        }
    return true;
  }
};

}  // namespace

TEST_CASE("parts of light sum to the picture in passes, with filters, limits and without a background") {
  const LightFolder folder;
  const std::vector<std::string> ways[] = {
      {},
      {"--filter", "gaussian", "--set", "/camera/lens={\"radius\":0.1,\"focus\":6}"},
      {"--filter", "mitchell", "--transparent"},
      {"--adaptive", "0.02", "--samples", "64", "--aov", "crypto_object"},
      {"--subsample"},
      {"--set", "/render/progressive=true", "--set", "/render/max_component=0.3"}};
  for (const auto& way : ways) {
    CAPTURE(way);
    folder.render(way);
    CHECK(folder.sums_to_picture());
  }
}

TEST_CASE("parts of light are the same of a frame in tiles") {
  const LightFolder folder;
  folder.render({});
  const std::string whole = read_file(folder / "a.exr");
  folder.render({"--tile", "7"});
  CHECK(read_file(folder / "a.exr") == whole);
  for (const char* which : {"1", "2"})
    REQUIRE(run_sundog(folder.command({"--tiles", std::string(which) + "/2"}, std::string(which) + ".part"))
                .status == 0);
  REQUIRE(run_sundog(
              {"merge", folder.file("1.part"), folder.file("2.part"), "-o", folder.file("a.exr"), "--float"})
              .status == 0);
  CHECK(read_file(folder / "a.exr") == whole);
}

TEST_CASE("parts of light are resumed, and not from a checkpoint of other AOVs that take as many bytes") {
  const LightFolder folder;
  const std::vector<std::string> passes = {"--float", "--set", "/render/progressive=true"};
  folder.render(passes);
  const std::string whole = read_file(folder / "a.exr");
  std::vector<std::string> first = passes;
  first.insert(first.end(), {"--time-limit", "1e-6", "--resume", folder.file("c")});
  REQUIRE(run_sundog(folder.command(first, "b.exr")).status == 0);
  REQUIRE(std::filesystem::exists(folder / "c"));
  const CommandResult other =
      run_sundog({"render", folder.scene_file, "-o", folder.file("b.exr"), "--quiet", "--device", "0:0",
                  "--set", "/render/progressive=true", "--aov", "denoise_albedo", "--aov", "crypto_object",
                  "--resume", folder.file("c")});
  CHECK(other.status == 2);
  CAPTURE(other.err);
  CHECK(other.err.find("a frame with other AOVs") != std::string::npos);
  std::vector<std::string> second = passes;
  second.insert(second.end(), {"--resume", folder.file("c")});
  REQUIRE(run_sundog(folder.command(second, "a.exr")).status == 0);
  CHECK(read_file(folder / "a.exr") == whole);
}

TEST_CASE("Whitted's integrator does not know parts of light, and says so") {
  const LightFolder folder;
  const CommandResult result = run_sundog(folder.command({"--integrator", "whitted"}, "a.exr"));
  CHECK(result.status == 2);
  CHECK(result.err.find("the AOV 'diffuse_direct' wants the integrator path") != std::string::npos);
}

TEST_CASE("the AOV light_parts is all parts of light") {
  const LightFolder folder;
  const CommandResult result =
      run_sundog({"render", folder.scene_file, "-o", folder.file("a.exr"), "--quiet", "--device", "0:0",
                  "--aov", "light_parts", "--aov", "sky", "--float"});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK(read_aovs(folder / "a.exr").size() == light_part_names.size());
  CHECK(folder.sums_to_picture());
}
