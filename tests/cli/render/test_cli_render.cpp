// `sundog render`: every exit status, what is written and what is said.
#include <base/file.h>
#include <base/image_io.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

TEST_CASE("a render writes its image in every format, and the formats agree") {
  const CliFolder folder;
  std::map<std::string, Image> images;
  for (const std::string name : {"a.png", "a.exr", "a.hdr", "a.pfm"}) {
    const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file(name)});
    CAPTURE(name, result.err);
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    CHECK(result.out.starts_with(folder.file(name) + ": 32x24, "));
    images[name] = read_image(folder / name);
    REQUIRE(images[name].width == 32);
    REQUIRE(images[name].height == 24);
  }
  CHECK(folder.entries() == 5);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) {
        const float wanted = images["a.pfm"].pixel(x, y)[c];
        CHECK(images["a.exr"].pixel(x, y)[c] == Approx(wanted).epsilon(1e-3));
        CHECK(images["a.hdr"].pixel(x, y)[c] == Approx(wanted).margin(0.01));
        CHECK(images["a.png"].pixel(x, y)[c] == Approx(std::min(wanted, 1.0f)).margin(0.01));
      }
  CHECK(images["a.png"].pixel(0, 0)[2] == Approx(0.8).margin(0.01));  // the background, not a hole
  CHECK(images["a.png"].pixel(0, 0)[3] == 1);
}

TEST_CASE("--quiet says nothing") {
  const CliFolder folder;
  CommandOptions options;
  options.terminal = true;
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--quiet"}, options);
  CHECK(result.status == 0);
  CHECK(result.out.empty());
  CHECK(result.err.empty());
}

TEST_CASE("a picture that is black for want of light says so") {
  const CliFolder folder;
  const auto warned = [&](const std::string& background) {
    const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--set",
                                             "/lights=[]", "--set", "/image/background=" + background});
    CHECK(result.status == 0);
    return result.err.find("nothing in the scene shines") != std::string::npos;
  };
  CHECK(warned("[0,0,0]"));
  CHECK_FALSE(warned("[0,0,0.1]"));
}

TEST_CASE("an image from a folder with spaces, with relative names") {
  const CliFolder folder;
  std::filesystem::create_directory(folder / "a folder");
  CommandOptions options;
  options.folder = folder / "a folder";
  CHECK(run_sundog({"render", "../scene.json", "-o", "an image.png"}, options).status == 0);
  CHECK(std::filesystem::exists(folder / "a folder/an image.png"));
}

TEST_CASE("--size, --samples and --max-depth change the scene, and --set does it too") {
  const CliFolder folder;
  const std::vector<std::string> start = {"render",  folder.scene,         "-o", folder.file("a.png"),
                                          "--stats", folder.file("a.json")};
  const auto stats_with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), start.begin(), start.end());
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    return json::parse(read_file(folder / "a.json"));
  };
  const json plain = stats_with({});
  CHECK(plain["rays"]["primary"] == 32 * 24);
  CHECK(plain["rays"]["refraction"] > 0);
  const json changed = stats_with({"--size", "40x30", "--samples", "3", "--max-depth", "1"});
  CHECK(changed["image"]["width"] == 40);
  CHECK(changed["image"]["height"] == 30);
  CHECK(changed["rays"]["primary"] == 40 * 30 * 3);
  CHECK(changed["rays"]["refraction"] == 0);
  CHECK(changed["counters"]["depth_limit"] > 0);
  CHECK(stats_with({"--set", "/image/width=8", "--set", "/image/height=4"})["rays"]["primary"] == 8 * 4);
}

TEST_CASE("the image is the same for every work-group size and tile") {
  const CliFolder folder;
  const auto image_with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", folder.scene, "-o", folder.file("a.pfm"), "--samples", "2"});
    const CommandResult result = run_sundog(more);
    CAPTURE(more, result.err);
    REQUIRE(result.status == 0);
    return read_file(folder / "a.pfm");
  };
  const std::string plain = image_with({});
  CHECK(image_with({"--work-group", "1"}) == plain);
  CHECK(image_with({"--work-group", "8x8"}) == plain);
  CHECK(image_with({"--work-group", "driver"}) == plain);
  CHECK(image_with({"--tile", "4"}) == plain);
  CHECK(image_with({"--tile", "12"}) == plain);
}

TEST_CASE("AOVs are further channels of the EXR, --float keeps its colours whole") {
  const CliFolder folder;
  const std::string out = folder.file("a.exr");
  CHECK(run_sundog({"render", folder.scene, "-o", out, "--float", "--aov", "depth", "--aov", "normal"})
            .status == 0);
  const AovImages aovs = read_aovs(out);
  REQUIRE(aovs.size() == 2);
  CHECK(aovs.at("depth").pixel(16, 12)[0] == Approx(4.1).margin(0.2));  // the sphere, seen from (0, 1, 5)
  CHECK(aovs.at("normal").pixel(16, 12)[2] > 0.9f);
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("a.pfm")}).status == 0);
  CHECK(run_sundog({"compare", out, folder.file("a.pfm")}).status == 0);
}

TEST_CASE("a bad scene is status 3 and leaves no image") {
  const CliFolder folder;
  const std::string bad = folder.write("bad.json", R"({"camera": {"fov": "wide"}})").string();
  CommandResult result = run_sundog({"render", bad, "-o", folder.file("a.png")});
  CHECK(result.status == 3);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.starts_with("sundog: " + bad + ": /camera"));
  result = run_sundog({"render", folder.file("none.json"), "-o", folder.file("a.png")});
  CHECK(result.status == 3);
  CHECK(result.err.starts_with("sundog: " + folder.file("none.json") + ": "));
  CHECK(run_sundog({"info", bad}).status == 3);
  CHECK(folder.entries() == 2);
}

TEST_CASE("an error of the scene stays the scene's when an option changes something else") {
  const CliFolder folder;
  std::string text = small_scene;
  text.replace(text.find("1.5"), 3, "0.0");
  const std::string bad = folder.write("bad.json", text).string();
  CHECK(run_sundog({"render", bad, "-o", folder.file("a.png"), "--size", "8x8"}).status == 3);
}

TEST_CASE("a device that is not there is status 4, with those that are") {
  const CliFolder folder;
  CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--device", "nonesuch"});
  CHECK(result.status == 4);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("0:0") != std::string::npos);
  CommandOptions options;
  options.environment["SUNDOG_DEVICE"] = "nonesuch";
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("a.png")}, options).status == 4);
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--device", "cpu"}, options).status ==
        0);
  options.environment["SUNDOG_DEVICE"] = "cpu, !nonesuch";
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("b.png")}, options).status == 4);
  options.environment["SUNDOG_DEVICE"] = "cpu, !nonesuch?";
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("b.png")}, options).status == 0);
}

TEST_CASE("a kernel that does not build is status 5, and the compiler's log follows") {
  const CliFolder folder;
  CommandOptions options;
  options.file_limit = 2000;  // too little for what PoCL's compiler writes
  options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  options.environment["POCL_CACHE_DIR"] = folder.file("pocl");
  const CommandResult result = run_sundog(
      {"render", folder.scene, "-o", folder.file("a.png"), "--device", "portable computing"}, options);
  CAPTURE(result.err);
  CHECK(result.status == 5);
  CHECK(result.err.starts_with("sundog: "));
  CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("an output that cannot be written is status 1, before the render") {
  const CliFolder folder;
  for (const std::string out : {"none/a.png", "scene.json/a.png"}) {
    const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file(out)});
    CAPTURE(out, result.err);
    CHECK(result.status == 1);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.starts_with("sundog: " + folder.file(out) + ": cannot be written: "));
  }
  std::filesystem::create_directory(folder / "folder.png");
  CHECK(run_sundog({"render", folder.scene, "-o", folder.file("folder.png")}).status == 1);
  CHECK(
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--stats", folder.file("none/a.json")})
          .status == 1);
  CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("a full disk is status 1, the old image stays and no other file is left") {
  const CliFolder folder;
  const std::string out = folder.write("a.pfm", "old").string();
  CommandOptions options;
  options.file_limit = 8 << 20;  // room for what the drivers write, not for 1024x768 pixels of 12 bytes
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", out, "--size", "1024x768", "--max-depth", "1"}, options);
  CAPTURE(result.err);
  CHECK(result.status == 1);
  CHECK(result.err.find(out + ": cannot be written: ") != std::string::npos);
  CHECK(read_file(out) == "old");
  CHECK(folder.entries() == 2);
}

TEST_CASE("the times of --stats add up to the total") {
  const CliFolder folder;
  REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--stats", folder.file("a.json")})
              .status == 0);
  const json stats = json::parse(read_file(folder / "a.json"));
  CHECK(stats["schema"] == 1);
  double sum = 0;
  for (const char* step :
       {"load", "compile_scene", "build_kernels", "upload", "render", "readback", "write", "other"}) {
    CAPTURE(step);
    const double seconds = stats["seconds"][step];
    CHECK(seconds >= 0);
    sum += seconds;
  }
  CHECK(sum == Approx(stats["seconds"]["total"].get<double>()));
  CHECK(stats["kernels_cached"].is_boolean());
  CHECK(stats["peak_memory"].get<std::uint64_t>() > (1u << 20));
  // Joules, or why there are none.
  const json& energy = stats["energy"];
  CHECK(energy["joules"].is_null() == energy["counted_by"].get<std::string>().starts_with("not known: "));
  REQUIRE(stats["devices"].size() == 1);
  const json& device = stats["devices"][0];
  CHECK(device["tiles"] > 0);
  REQUIRE_FALSE(device["kernels"].empty());
  for (const auto& kernel : device["kernels"]) {
    CHECK(kernel["launches"] > 0);
    CHECK(kernel["host_ms"] > 0);
    CHECK(kernel["first_ms"] <= kernel["host_ms"]);
    CHECK(kernel["work_group"].size() == 2);
  }
  CHECK(stats["scene"]["objects"]["sphere"] == 1);
  CHECK(stats["image"]["complete"] == true);
}

TEST_CASE("--verbose tells times, rays and kernels") {
  const CliFolder folder;
  const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--verbose"});
  CHECK(result.status == 0);
  for (const char* word : {"compile_scene", "refraction", "launches", "total"})
    CHECK(result.out.find(word) != std::string::npos);
}

TEST_CASE("info counts what the scene holds") {
  const CliFolder folder;
  const json info = json::parse(run_sundog({"info", folder.scene, "--json"}).out);
  CHECK(info["schema"] == 1);
  CHECK(info["objects"]["plane"] == 1);
  CHECK(info["objects"]["sphere"] == 1);
  CHECK(info["unbounded"] == 1);
  CHECK(info["lights"]["point"] == 1);
  CHECK(info["triangles"] == 0);
  CHECK(info["bounds"]["max"][0].get<double>() == Approx(1).margin(1e-5));
  CHECK(info["bounds"]["min"][1].get<double>() == Approx(-1).margin(1e-5));
  const CommandResult text = run_sundog({"info", folder.scene});
  CHECK(text.status == 0);
  CHECK(text.out.find("1 plane, 1 sphere") != std::string::npos);
}

TEST_CASE("info shows the scene as --set changes it, and says what its BVH figures are") {
  const CliFolder folder;
  std::string triangles;  // small ones, and needles through the scene, which are cheaper when they are cut
  for (int i = 1; i <= 2000; ++i) {
    const double x = std::sin(12.9 * i), y = std::sin(78.2 * i), z = std::sin(37.7 * i);
    const int k = i % 40 == 0 ? -1 : 1;
    triangles += fmt::format("v {} {} {}\nv {} {} {}\nv {} {} {}\nf {} {} {}\n", x, y, z, x + 0.01, y, z,
                             k * x, k * y + 0.01, k * z, 3 * i - 2, 3 * i - 1, 3 * i);
  }
  const std::string model = folder.write("needles.obj", triangles).string();
  const json whole = json::parse(run_sundog({"info", model, "--json"}).out).at("bvh");
  const json cut =
      json::parse(run_sundog({"info", model, "--set", "/render/spatial_splits=true", "--json"}).out)
          .at("bvh");
  CHECK(cut.at("sah_cost") < whole.at("sah_cost"));
  CHECK_THAT(cut.at("sah_cost_unit").get<std::string>(), ContainsSubstring("visits"));
  CHECK_THAT(cut.at("build_seconds_unit").get<std::string>(), ContainsSubstring("seconds"));
  const CommandResult text = run_sundog({"info", folder.scene, "--set", "/objects/1/type=\"box\""});
  CHECK(text.status == 0);
  CHECK_THAT(text.out, ContainsSubstring("1 box, 1 plane") && ContainsSubstring("SAH cost") &&
                           ContainsSubstring("visits") && ContainsSubstring("built in"));
  const CommandResult wrong = run_sundog({"info", folder.scene, "--set", "camera"});
  CHECK(wrong.status == 2);
  CHECK(is_one_error_line(wrong.err));
}
