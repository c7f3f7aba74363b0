// `sundog halo`: pictures of the sky, figures, and what it refuses.
#include <base/file.h>
#include <base/image_io.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "run_command.h"
#include "temporary_folder.h"

using namespace sundog;
using nlohmann::json;

namespace {

const char* const scene =
    R"({"environment": {"type": "halo", "crystals": [{"shape": "plate", "ratio": 0.3}], "cells": 128, "rays": 50000,
  "sun": {"altitude": 20}}, "objects": []})";

}  // namespace

TEST_CASE("halo writes the sky in both views, the same bits again, with figures that add up") {
  TemporaryFolder folder;
  folder.write("sky.json", scene);
  const std::string file = (folder / "sky.json").string(), out = (folder / "sky.exr").string();
  const CommandResult result = run_sundog({"halo", file, "-o", out, "--size", "64", "--float", "--json"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json figures = json::parse(result.out);
  CHECK(figures["schema"] == 1);
  CHECK(figures["rays"].get<double>() == Approx(50000).epsilon(0.01));
  CHECK(figures["rays_per_second"].get<double>() > 0);
  CHECK(figures["passed"].get<double>() + figures["turned"].get<double>() + figures["kept"].get<double>() ==
        Approx(1).epsilon(1e-4));
  const Image image = read_image(out);
  REQUIRE(image.width == 128);
  REQUIRE(image.height == 64);
  // The sundog: 20 degrees high, 25.5 beside the middle.
  CHECK(image.pixel(73, 24)[1] > 10 * image.pixel(90, 10)[1]);
  const std::string again = (folder / "again.exr").string();
  REQUIRE(run_sundog({"halo", file, "-o", again, "--size", "64", "--float", "-q"}).status == 0);
  CHECK(read_file(again) == read_file(out));
  const std::string eye = (folder / "eye.png").string();
  REQUIRE(
      run_sundog({"halo", "-o", eye, "--view", "fisheye", "--sky", "--size", "48", "--rays", "20000", "-q"})
          .status == 0);
  const Image fisheye = read_image(eye);
  CHECK(fisheye.width == 48);
  CHECK(fisheye.pixel(0, 0)[2] == 0);
  CHECK(fisheye.pixel(24, 24)[2] > fisheye.pixel(24, 24)[0]);  // the zenith is blue
}

TEST_CASE("halo refuses what it cannot do, with a mend") {
  TemporaryFolder folder;
  folder.write("sky.json", scene);
  folder.write("dull.json", R"({"environment": {"type": "sky"}, "objects": []})");
  const std::string file = (folder / "sky.json").string(), out = (folder / "sky.exr").string();
  const auto refused = [&](std::vector<std::string> arguments, int status, const std::string& words) {
    arguments.insert(arguments.begin(), "halo");
    const CommandResult result = run_sundog(arguments);
    INFO(result.err);
    CHECK(result.status == status);
    CHECK(result.err.find(words) != std::string::npos);
  };
  refused({file}, 2, "--out");
  refused({file, "-o", out, "--view", "fishey"}, 2, "did you mean fisheye");
  refused({file, "-o", out, "--veiw", "fisheye"}, 2, "--view");
  refused({file, "-o", out, "--size", "0"}, 2, "--size");
  refused({file, "-o", out, "--altitude", "91"}, 2, "0 to 90");
  refused({file, "-o", out, "--altitude", "-5"}, 2, "--altitude -5");
  refused({file, "-o", out, "--altitude", "nan"}, 2, "--altitude nan");
  refused({"-o", out, "--set", "/environment/rays=2000"}, 2, "SCENE");
  refused({(folder / "dull.json").string(), "-o", out}, 3, "halo");
  refused({file, "-o", (folder / "sky.txt").string()}, 2, "sky.txt");
  refused({file, "-o", file}, 2, "sky.json");
  refused({file, "-o", out, "--device", "no such device"}, 4, "no such device");
}
