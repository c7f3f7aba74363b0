// `sundog tune`: what is found is kept, shown, used, taken along and forgotten.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/cache_folder.h"
#include "base/environment.h"
#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A cache of its own for results, with the kernels of the user's.
struct TuneFolder : CliFolder {
  TuneFolder() {
    const fs::path kernels = sundog::plain_environment()->cache / "kernels";
    sundog::make_cache_folder(kernels);
    sundog::make_cache_folder(*this / "cache/sundog/tuning");  // the user's alone at every umask
    fs::create_directory_symlink(kernels, *this / "cache/sundog/kernels");
  }
  CommandResult run(std::vector<std::string> arguments, CommandOptions options = {}) const {
    options.environment["XDG_CACHE_HOME"] = (*this / "cache").string();
    arguments.insert(arguments.begin(), "tune");
    return run_sundog(arguments, options);
  }
  CommandResult render(const std::string& name) const {
    CommandOptions options;
    options.environment["XDG_CACHE_HOME"] = (*this / "cache").string();
    return run_sundog({"render", scene, "-o", file(name), "--device", "portable", "--stats", file("s.json"),
                       "--aov", "depth"},
                      options);
  }
};

}  // namespace

TEST_CASE("what tune finds is kept in one file a device, and a render with it gives the same bits") {
  const TuneFolder folder;
  REQUIRE(folder.render("before.exr").status == 0);
  const CommandResult tuned = folder.run({folder.scene, "--device", "portable", "--budget", "3"});
  CAPTURE(tuned.out, tuned.err);
  REQUIRE(tuned.status == 0);
  CHECK_THAT(tuned.out, ContainsSubstring("solids+rays (scene)") && ContainsSubstring("tried"));
  CHECK_THAT(tuned.out, ContainsSubstring(": took ") && ContainsSubstring(" of 3 s"));
  CHECK_THAT(folder.run({"--export", folder.file("kept.json")}).out, ContainsSubstring(" of 1 device\n"));
  json kept = json::parse(sundog::read_file(folder.file("kept.json")));
  REQUIRE(kept.size() == 1);
  if (kept[0].at("entries").size() == 1) {  // there was no time for the AOVs
    CHECK_THAT(tuned.out, ContainsSubstring("not tuned for lack of time: first_surfaces of scene"));
    kept[0]["entries"].push_back(kept[0].at("entries")[0]);
    kept[0]["entries"][1]["kernel"] = "first_surfaces";
    kept[0]["entries"][1]["work_group"] = "default";
  }
  json &entry = kept[0].at("entries")[0], &surfaces = kept[0].at("entries")[1];
  for (const json& one : {entry, surfaces})
    CHECK(one.at("tuned_ms") <= one.at("default_ms"));  // the default is among the candidates
  CHECK(entry.at("kernel") == "render_whitted");
  CHECK(surfaces.at("kernel") == "first_surfaces");

  entry["work_group"] = "2x2";
  entry["launch_ms"] = 10;
  entry["tile_ms"] = 5;
  entry["options"] = "-DNODE_LOOP=1 !-DDEVICE_INLINES_ALL";
  surfaces["surfaces_group"] = "8";
  folder.write("kept.json", kept.dump());
  CHECK_THAT(folder.run({"--forget"}).out, ContainsSubstring("1 file removed"));
  CHECK_THAT(folder.run({"--show"}).out, ContainsSubstring("There are no results in "));
  CHECK_THAT(folder.run({"--import", folder.file("kept.json")}).out, ContainsSubstring("imported"));
  CHECK_THAT(folder.run({"--show"}).out,
             ContainsSubstring("work-group 2x2, launches of 10 ms, tiles of 5 ms, compiled with "
                               "-DNODE_LOOP=1 !-DDEVICE_INLINES_ALL"));
  REQUIRE(folder.render("after.exr").status == 0);
  const json stats = json::parse(sundog::read_file(folder.file("s.json")));
  CHECK(stats["devices"][0]["kernels"]["render_whitted"]["work_group"] == json({2, 2}));
  CHECK(stats["devices"][0]["kernels"]["first_surfaces"]["work_group"] == json({8, 1}));
  CHECK(sundog::read_file(folder.file("before.exr")) == sundog::read_file(folder.file("after.exr")));

  // A device and a part of it are two.
  kept.push_back(kept[0]);
  kept[1]["units"] = 1;
  kept[1]["entries"][0]["work_group"] = "8";
  folder.write("kept.json", kept.dump());
  CHECK(folder.run({"--import", folder.file("kept.json")}).status == 0);
  CHECK_THAT(folder.run({"--show"}).out, ContainsSubstring("work-group 2x2") &&
                                             ContainsSubstring("/1, driver") &&
                                             ContainsSubstring("work-group 8,"));

  kept[0]["kernels"] = "of other sources";
  folder.write("kept.json", kept.dump());
  CHECK_THAT(folder.run({"--import", folder.file("kept.json")}).out,
             ContainsSubstring("skipped: it was measured with other kernels"));
}

TEST_CASE("tune names what it rejects, with the reason") {
  const TuneFolder folder;
  REQUIRE(folder.render("before.exr").status == 0);
  CommandOptions options;
  options.environment["SUNDOG_FAULTS"] = "build@0:0#4";  // a small frame and the defaults come before
  const CommandResult tuned = folder.run({folder.scene, "--device", "0:0", "--budget", "5"}, options);
  CAPTURE(tuned.out, tuned.err);
  CHECK(tuned.status == 0);
  // With time left, other shapes of tiles are rejected as well: they add up a ray tree in another order.
  CHECK_THAT(tuned.out, ContainsSubstring(" tried, ") && ContainsSubstring("\n  rejected: work-group ") &&
                            ContainsSubstring(" did not build on 0:0 "));
}

TEST_CASE("a scene whose name is no UTF-8 is tuned and its result kept") {
  const TuneFolder folder;
  const std::string named = folder.file("sc\xe9ne.json");
  fs::copy(folder.scene, named);
  CHECK(folder.run({named, "--device", "portable", "--budget", "2"}).status == 0);
  CHECK_THAT(folder.run({"--show"}).out, ContainsSubstring("render_whitted"));
}

TEST_CASE("settings at which the driver crashes are rejected, and the others tuned") {
  const TuneFolder folder;
  REQUIRE(folder.render("before.exr").status == 0);
  CommandOptions options;
  options.environment["SUNDOG_FAULTS"] = "crash@0:0#25";
  const CommandResult tuned = folder.run({folder.scene, "--device", "0:0", "--budget", "20"}, options);
  CAPTURE(tuned.out, tuned.err);
  // Where other programs take the machine, the time may be over before there is a result.
  CHECK((tuned.status == 0 || tuned.status == 4));
  if (tuned.status == 0)
    CHECK_THAT(tuned.out,
               ContainsSubstring("\n  rejected: work-group ") && ContainsSubstring(": the driver crashed"));
  options.environment["SUNDOG_FAULTS"] = "crash@0:0";
  const CommandResult always = folder.run({folder.scene, "--device", "0:0", "--budget", "6"}, options);
  CAPTURE(always.out, always.err);
  CHECK(always.status == 4);
  CHECK_THAT(always.err, ContainsSubstring("its driver crashed (signal 6, scene, render_whitted: "));
}

TEST_CASE("tune keeps its budget where one frame takes longer: it measures on smaller ones") {
  const TuneFolder folder;
  REQUIRE(folder.render("before.exr").status == 0);  // its kernels are in the cache then
  CommandOptions options;
  options.timeout = 60;  // a frame as it is takes minutes
  const CommandResult tuned =
      folder.run({folder.scene, "--device", "portable", "--budget", "5", "--set", "/image/width=1600",
                  "--set", "/image/height=1200", "--set", "/render/samples=4096"},
                 options);
  CAPTURE(tuned.out, tuned.err);
  REQUIRE(tuned.status == 0);
  CHECK_THAT(tuned.out, ContainsSubstring("frames of ") && ContainsSubstring(" and 1 sample a pixel"));
  CHECK_THAT(folder.run({"--show"}).out, ContainsSubstring("render_whitted"));
}

TEST_CASE("tune ends a device that takes longer than its budget, and keeps what was found before") {
  const TuneFolder folder;
  CommandOptions options;
  options.timeout = 60;
  const std::vector<std::string> arguments{folder.scene, "--device", "portable", "--budget", "2"};
  options.environment["SUNDOG_FAULTS"] = "hang@0:0#1";
  const CommandResult nothing = folder.run(arguments, options);
  CAPTURE(nothing.out, nothing.err);
  CHECK(nothing.status == 4);
  CHECK(is_one_error_line(nothing.err));
  CHECK_THAT(nothing.err, ContainsSubstring("was ended after ") &&
                              ContainsSubstring("(scene, render_whitted: the first small frame)") &&
                              ContainsSubstring("--budget"));
  CHECK_THAT(folder.run({"--show"}).out, ContainsSubstring("There are no results"));
}

TEST_CASE(
    "a tuning result with a wrong value is refused with its place, what was wanted and what was found") {
  const TuneFolder folder;
  const json good = json::parse(R"([{"schema": 1, "platform": "P", "device": "D", "driver": "1", "units": 0,
    "kernels": "of other sources", "entries": [{"kernel": "render_whitted", "class": "solids+wide+rays",
    "scene": "s", "work_group": "64", "surfaces_group": "default", "tile_w": 0, "tile_h": 0, "packet_least": 0,
    "launch_ms": 0, "tile_ms": 0, "default_ms": 2, "tuned_ms": 1}]}])");
  folder.write("good.json", good.dump());
  CHECK(folder.run({"--import", folder.file("good.json")}).status == 0);
  struct Case {
    const char *place, *value, *says;
  };
  for (const Case& c :
       {Case{"/0/entries/0/class", "\"solids+fast\"", "wanted a class of scenes: solids"},
        Case{"/0/entries/0/kernel", "\"k\"", "wanted \"render_whitted\" or"},
        Case{"/0/entries/0/work_group", "\"8x\"", "wanted a size such as"},
        Case{"/0/entries/0/tile_w", "\"two\"", "wanted an integer from 0 to 16, found"},
        Case{"/0/entries/0/launch_ms", "-1", "wanted a number"},
        Case{"/0/entries/0/options", "\"-I/tmp\"", "wanted options that sundog tune tries"},
        Case{"/0/entries/0/options", "\"-DA=1;x\"", "wanted options that sundog tune tries"},
        Case{"/0/entries/0/gamma", "1", "unknown key"}, Case{"/0/entries", "3", "wanted an array"},
        Case{"/0/driver", "null", "wanted"}, Case{"/0", "[]", "wanted an object"}}) {
    json bad = good;
    bad[json::json_pointer(c.place)] = json::parse(c.value);
    folder.write("bad.json", bad.dump());
    const CommandResult result = folder.run({"--import", folder.file("bad.json")});
    CAPTURE(c.place, result.err);
    CHECK(result.status == 3);
    CHECK(is_one_error_line(result.err));
    CHECK_THAT(result.err,
               ContainsSubstring("bad.json: " + std::string(c.place)) && ContainsSubstring(c.says));
    CHECK_THAT(result.err, !ContainsSubstring("json.exception"));
  }
  for (const auto& [width, height] : {std::pair(3, 5), {0, 4}, {16, 16}, {2, 1}}) {
    json bad = good;
    bad[0]["entries"][0]["tile_w"] = width, bad[0]["entries"][0]["tile_h"] = height;
    folder.write("bad.json", bad.dump());
    const CommandResult result = folder.run({"--import", folder.file("bad.json")});
    CAPTURE(width, height, result.err);
    CHECK(result.status == 3);
    CHECK_THAT(result.err,
               ContainsSubstring("/0/entries/0: wanted tile_w and tile_h both 0, or with a product of"));
  }
}

TEST_CASE("tuning results that are none are refused, and a damaged file is as none") {
  const TuneFolder folder;
  for (const char* text : {"", "{}", "[{}]", "[{\"schema\": 2}]", "[1]"}) {
    folder.write("bad.json", text);
    const CommandResult result = folder.run({"--import", folder.file("bad.json")});
    CAPTURE(text, result.err);
    CHECK(result.status == 3);
    CHECK(is_one_error_line(result.err));
  }
  CHECK(folder.run({"--import", folder.file("missing.json")}).status == 3);
  CHECK(folder.run({folder.scene, "--device", "nowhere"}).status == 4);
}
