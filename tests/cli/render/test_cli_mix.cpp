// `sundog mix`: the light groups of a picture, balanced anew.
#include <cmath>

#include "base/file.h"
#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

constexpr const char* two_lamps = R"({
  "camera": {"position": [0, 1, 5], "target": [0, 0.5, 0]}, "image": {"width": 24, "height": 16},
  "render": {"integrator": "path", "samples": 4},
  "lights": [{"type": "point", "position": [-2, 3, 2], "intensity": 0.5, "group": "key"},
    {"type": "point", "position": [2, 3, 2], "intensity": 0.3, "group": "fill"}],
  "materials": {"m": {"color": [0.8, 0.8, 0.8]}},
  "objects": [{"type": "plane", "material": "m"}, {"type": "sphere", "center": [0, 0.5, 0], "radius": 0.5, "material": "m"}]
})";

struct MixFolder : CliFolder {
  MixFolder() {
    write("lamps.json", two_lamps);
    run({"render", file("lamps.json"), "-o", file("all.exr"), "--float", "--aov", "light_groups", "--device",
         "0:0"});
  }
  void run(const std::vector<std::string>& words) const {
    const CommandResult result = run_sundog(words);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
  }
  Image mixed(const std::string& out, std::vector<std::string> more) const {
    more.insert(more.begin(), {"mix", file("all.exr"), "-o", file(out), "--float"});
    run(more);
    return read_image(*this / out);
  }
};

}  // namespace

TEST_CASE("mix adds the light of groups, each times its factor and colour") {
  const MixFolder folder;
  const AovImages aovs = read_aovs(folder / "all.exr");
  CHECK(aovs.size() == 3);
  const Image all = read_image(folder / "all.exr"), same = folder.mixed("same.exr", {}),
              mixed = folder.mixed("mixed.exr", {"--light", "key=2,#ff8000", "--light", "fill=0"});
  const double half = double(linear_from_srgb(128 / 255.0f));
  for (std::size_t i = 0; i < aovs.at("light_key").data.size(); ++i) {
    const std::size_t at = i / 3 * 4 + i % 3;
    const double factor[] = {2, 2 * half, 0};
    CHECK(same.data[at] == Approx(all.data[at]).margin(1e-6));
    CHECK(double(mixed.data[at]) ==
          Approx(factor[i % 3] * double(aovs.at("light_key").data[i])).margin(1e-6));
  }
  // A picture for screens has the tone map of render.
  folder.run(
      {"mix", folder.file("all.exr"), "-o", folder.file("a.png"), "--exposure", "-1", "--tone-map", "agx"});
  folder.run({"render", folder.file("lamps.json"), "-o", folder.file("b.png"), "--exposure", "-1",
              "--tone-map", "agx", "--device", "0:0"});
  const Image a = read_image(folder / "a.png"), b = read_image(folder / "b.png");
  for (std::size_t i = 0; i < a.data.size(); ++i) CHECK(std::abs(a.data[i] - b.data[i]) < 0.02f);
}

TEST_CASE("parts of a frame merge to the same light groups") {
  const MixFolder folder;
  for (const char* part : {"1", "2"})
    folder.run({"render", folder.file("lamps.json"), "-o", folder.file(std::string(part) + ".part"),
                "--tiles", std::string(part) + "/2", "--aov", "light_groups", "--device", "0:0"});
  folder.run(
      {"merge", folder.file("1.part"), folder.file("2.part"), "-o", folder.file("merged.exr"), "--float"});
  const AovImages whole = read_aovs(folder / "all.exr"), merged = read_aovs(folder / "merged.exr");
  for (const char* name : {"light_key", "light_fill", "light_rest"})
    CHECK(merged.at(name).data == whole.at(name).data);
}

TEST_CASE("light groups of a frame whose shutter is open are those of all its times") {
  const CliFolder folder;
  std::string text = two_lamps;
  text.insert(text.rfind('}'), R"(, "animate": [{"type": "linear", "value": "/lights/0/intensity",
    "keys": [{"frame": 0, "value": 0.5}, {"frame": 1, "value": 5}]}])");
  text.replace(text.find("\"camera\": {"), 11, R"("camera": {"shutter": 1, "shutter_steps": 4, )");
  folder.write("film.json", text);
  const auto run = [&](const std::vector<std::string>& words) {
    const CommandResult result = run_sundog(words);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
  };
  run({"render", folder.file("film.json"), "-o", folder.file("film.exr"), "--frames", "0", "--float", "--aov",
       "light_groups", "--device", "0:0"});
  run({"mix", folder.file("film_0000.exr"), "-o", folder.file("mixed.exr"), "--float"});
  run({"render", folder.file("film.json"), "-o", folder.file("plain.exr"), "--frames", "0", "--float",
       "--device", "0:0"});
  const Image film = read_image(folder / "film_0000.exr"), mixed = read_image(folder / "mixed.exr"),
              plain = read_image(folder / "plain_0000.exr");
  for (std::size_t i = 0; i < film.data.size(); ++i) {
    CHECK(mixed.data[i] == Approx(film.data[i]).margin(1e-6));
    CHECK(film.data[i] == Approx(plain.data[i]).margin(1e-6));
  }
  // The lamp that brightens has its mean: 1 of the 4 steps 0.5, 1.625, 2.75 and 3.875 is 2.19.
  run({"render", folder.file("film.json"), "-o", folder.file("dark.exr"), "--aov", "light_groups", "--device",
       "0:0", "--float"});
  const Image bright = read_aovs(folder / "film_0000.exr").at("light_key"),
              dark = read_aovs(folder / "dark.exr").at("light_key");
  double sums[2] = {};
  for (std::size_t i = 0; i < dark.data.size(); ++i)
    sums[0] += double(dark.data[i]), sums[1] += double(bright.data[i]);
  CHECK(sums[1] / sums[0] > 3);
}

TEST_CASE("what mix cannot do is refused in one line") {
  const MixFolder folder;
  folder.run({"render", folder.file("lamps.json"), "-o", folder.file("none.exr"), "--device", "0:0"});
  folder.run({"render", folder.file("lamps.json"), "-o", folder.file("one.exr"), "--aov", "light_key",
              "--device", "0:0"});
  const auto refused = [&](const std::string& picture, const std::string& light, const std::string& reason) {
    const CommandResult result =
        run_sundog({"mix", folder.file(picture), "-o", folder.file("x.png"), "--light", light});
    CAPTURE(result.err);
    CHECK(result.status == 2);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.find(reason) != std::string::npos);
  };
  refused("all.exr", "kye=2", "did you mean key?");
  refused("all.exr", "key", "NAME=FACTOR");
  refused("all.exr", "key=-1", "wanted a number from 0");
  refused("all.exr", "key=2,#12345", "NAME=FACTOR");
  refused("none.exr", "key=2", "has no light groups");
  refused("one.exr", "key=2", "is not the sum of its light groups");
  for (const auto& [aov, reason] :
       {std::pair("light_kye", "it has fill, key"), std::pair("sky", "same place")}) {
    const CommandResult result = run_sundog({"render", folder.file("lamps.json"), "-o", folder.file("x.exr"),
                                             "--aov", aov, "--aov", "light_key"});
    CHECK(result.status == 2);
    CHECK(result.err.find(reason) != std::string::npos);
  }
}
