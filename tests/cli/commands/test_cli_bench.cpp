// `sundog bench`: tiny runs; what the reports hold, never how long anything took.
#include <nlohmann/json.hpp>
#include <set>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;

TEST_CASE("bench threads times every size and count on sub-devices, more than there are cores too") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"bench", "threads", folder.scene, "--device", "portable", "--sizes", "24,16", "--counts",
                  "1,2,5", "--repeat", "2", "--json", folder.file("t.json"), "--csv", folder.file("t.csv"),
                  "--html", folder.file("t.html")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("scene: time of a frame") &&
                             ContainsSubstring("scene: speed-up") && ContainsSubstring("scene: efficiency") &&
                             ContainsSubstring("5 threads [ms]"));
  const json report = json::parse(sundog::read_file(folder.file("t.json")));
  CHECK(report.at("bench") == "threads");
  CHECK_THAT(report.at("facts").at("device").get<std::string>(), ContainsSubstring("Portable Computing"));
  CHECK_THAT(report.at("facts").at("PoCL").get<std::string>(),
             ContainsSubstring("POCL_WORK_GROUP_SPECIALIZATION=0"));
  CHECK_FALSE(report.at("facts").at("revision").get<std::string>().empty());
  CHECK_THAT(report.at("facts").at("command").get<std::string>(),
             ContainsSubstring("sundog bench ") && ContainsSubstring(" --repeat "));
  const json& rows = report.at("measurements");
  REQUIRE(rows.size() == 8);  // with plain C++
  for (const json& row : rows) {
    CAPTURE(row.dump());
    CHECK(row.at("problem").is_null());
    CHECK(row.at("time_ms").at("median") > 0);
    CHECK(row.at("runs") == (row.at("device") == "plain C++" ? 1 : 2));  // plain C++ once
  }
  CHECK_THAT(result.err, ContainsSubstring("sundog: this will take about "));
  CHECK(rows[0].at("size_pixels") == 16);  // ascending, whatever the order that was asked for
  CHECK(rows[0].at("speed-up") == 1);
  CHECK(rows[3].at("device") == "plain C++");
  CHECK(rows[6].at("threads") == 5);
  CHECK(sundog::read_file(folder.file("t.csv")).starts_with("scene,device,size_pixels,threads,time_ms,"));
  CHECK(sundog::read_file(folder.file("t.html")).starts_with("<!DOCTYPE html>"));
}

TEST_CASE("bench threads refuses what it cannot measure") {
  const CliFolder folder;
  CommandResult result = run_sundog({"bench", "threads", folder.scene, "--device", "nowhere"});
  CHECK(result.status == 4);
  result = run_sundog({"bench", "threads", folder.file("missing.json"), "--quiet"});
  CHECK(result.status == 3);
  result = run_sundog({"bench", "threads", folder.scene, "--json", folder.file("no/such/folder.json")});
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
}

// PoCL's threads crash when the sub-device of their last event goes under them, most often while the host is
// busy with the next scene.
TEST_CASE("bench threads continues with further sizes after sub-devices were closed") {
  const CliFolder folder;
  json scene = json::parse(small_scene);
  // Nothing has this mesh, so that the kernels stay those of the small scene; the host makes it for each
  // size.
  scene["meshes"]["block"]["generate"] = {{"type", "ice_block"}, {"subdivision", 240}};
  const std::string file = folder.write("busy.json", scene.dump()).string();
  const CommandResult result = run_sundog({"bench", "threads", file, "--sizes", "8,12,16", "--counts", "1,2",
                                           "--repeat", "1", "--no-plain", "--device", "portable"});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
}

TEST_CASE(
    "bench workgroup times each kernel with every size that the device takes, and the driver's choice") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"bench", "workgroup", folder.scene, "--device", "portable", "--rays", "16", "--repeat", "1",
                  "--json", folder.file("w.json"), "--html", folder.file("w.html"), "--quiet"});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK(result.out.empty());
  const json report = json::parse(sundog::read_file(folder.file("w.json")));
  std::set<std::string> kernels, sizes;
  for (const json& row : report.at("measurements")) {
    CHECK(row.at("problem").is_null());
    CHECK(row.at("time_ms").at("median") > 0);
    kernels.insert(row.at("kernel"));
    sizes.insert(row.at("work-group"));
  }
  CHECK(kernels == std::set<std::string>{"render_whitted", "trace_rays", "occluded_rays"});
  for (const char* size : {"driver's choice", "1", "64", "61", "8x8"}) CHECK(sizes.count(size) == 1);
  CHECK(sizes.lower_bound("default (")->ends_with(')'));
  CHECK_THAT(sundog::read_file(folder.file("w.html")), ContainsSubstring("class=\"cell"));
}

TEST_CASE("bench kernels tells limits of each kernel and tracer, and builds from source as often as asked") {
  const CliFolder folder;
  CommandOptions patient;
  patient.timeout = 1800;  // beside other tests, builds are disturbed and repeated
  for (const std::string tracer : {"wide", "compact"}) {
    const int builds = tracer == "wide" ? 2 : 1;
    const CommandResult result = run_sundog(
        {"bench", "kernels", folder.scene, "--device", "portable", "--set", "/render/tracer=" + tracer,
         "--json", folder.file("k.json"), "--t4", folder.file("k.t4"), "--repeat", std::to_string(builds)},
        patient);
    CAPTURE(result.out, result.err);
    REQUIRE(result.status == 0);
    CHECK_THAT(result.out, ContainsSubstring(tracer + " tracer") && ContainsSubstring("occluded_rays"));
    std::set<std::string> kernels;
    const json report = json::parse(sundog::read_file(folder.file("k.json")));
    for (const json& row : report.at("measurements")) {
      CAPTURE(row.dump());
      kernels.insert(row.at("kernel"));
      CHECK(row.at("tracer") == tracer);
      CHECK(row.at("group_limit") >= row.at("group_given"));
      CHECK(row.at("group_given") > 0);
      CHECK(row.at("multiple") > 0);
      CHECK(row.at("registers").is_null());
      CHECK(row.at("spill_stores_B").is_null());
      CHECK(row.at("threads").is_null());
      CHECK(row.at("runs") == builds);
      CHECK(row.at("time_ms").at("min") > row.at("build_warm_ms").at("max"));
      CHECK(row.at("build_warm_ms").at("min") > 0);
    }
    CHECK(report.at("ways").size() == 3);  // frames, AOVs and rays: each program once
    for (const json& result : json::parse(sundog::read_file(folder.file("k.t4"))).at("results")) {
      CHECK(result.at("configuration").size() == 4);  // scene, device, tracer, kernel
      CHECK(result.at("times").at("runtimes").size() == static_cast<std::size_t>(builds));
    }
    const CommandResult compared =
        run_sundog({"bench", "compare", folder.file("k.json"), folder.file("k.json")});
    CHECK_THAT(compared.out, ContainsSubstring("faster in 0 of 3 rows"));
    CHECK(kernels ==
          std::set<std::string>{"render_whitted", "first_surfaces", "trace_rays", "occluded_rays"});
  }
}

TEST_CASE("bench workgroup tries no group that a kernel's own limit forbids") {
  const CliFolder folder;
  CommandOptions options;
  options.environment["SUNDOG_FAULTS"] = "limit=8@0:0";
  options.environment["POCL_DEVICES"] = "pthread";
  const CommandResult result =
      run_sundog({"bench", "workgroup", folder.scene, "--device", "0:0", "--rays", "16", "--repeat", "1",
                  "--kernel", "occluded_rays", "--json", folder.file("w.json")},
                 options);
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  std::set<std::string> sizes;
  const json report = json::parse(sundog::read_file(folder.file("w.json")));
  for (const json& row : report.at("measurements")) {
    CHECK(row.at("problem").is_null());
    sizes.insert(row.at("work-group"));
  }
  CHECK(sizes == std::set<std::string>{"default (8)", "driver's choice", "1", "2", "4", "7"});
}

TEST_CASE("bench workgroup names each of several devices in tables, rows and LaTeX") {
  const CliFolder folder;
  CommandOptions options;
  options.environment["POCL_DEVICES"] = "basic pthread";
  const CommandResult result =
      run_sundog({"bench", "workgroup", folder.scene, "--device", "all", "--device", "!rusticl?", "--rays",
                  "16", "--repeat", "1", "--kernel", "occluded_rays", "--sizes", "2", "--json",
                  folder.file("w.json"), "--latex", folder.file("w.tex")},
                 options);
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  std::set<std::string> devices;
  const json report = json::parse(sundog::read_file(folder.file("w.json")));
  for (const json& row : report.at("measurements")) devices.insert(row.at("device"));
  const std::string latex = sundog::read_file(folder.file("w.tex"));
  for (const std::string place : {"0:0 basic", "0:1 pthread"}) {
    CHECK(std::ranges::any_of(devices, [&](const auto& name) { return name.starts_with(place); }));
    CHECK_THAT(latex, ContainsSubstring("occluded\\_rays on " + place));
    CHECK_THAT(result.out, ContainsSubstring("occluded_rays on " + place));
  }
  CHECK_THAT(result.out, ContainsSubstring("Each row has 1 run. "));
}

TEST_CASE("bench devices ranks devices and combinations, with shares that add up") {
  const CliFolder folder;
  CommandOptions options;
  options.environment["POCL_DEVICES"] = "basic pthread";
  const CommandResult result = run_sundog({"bench", "devices", folder.scene, "--device", "0:0", "--device",
                                           "0:1", "--repeat", "1", "--json", folder.file("d.json")},
                                          options);
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json rows = json::parse(sundog::read_file(folder.file("d.json"))).at("measurements");
  REQUIRE(rows.size() == 3);
  double last = 0;
  for (const json& row : rows) {
    CHECK(row.at("problem").is_null());
    CHECK(row.at("differing_pixels") == 0);
    CHECK(row.at("time_ms").at("median") >= last);  // fastest first
    last = row.at("time_ms").at("median");
    double sum = 0;
    std::string shares = row.at("shares");
    for (std::size_t at = shares.find(':'); at != std::string::npos; at = shares.find(':', at + 1))
      sum += std::stod(shares.substr(shares.find(' ', at) + 1));
    CHECK(std::abs(sum - 100) <= 1);
  }
}

TEST_CASE("bench samples tells time and error by samples, and the error falls") {
  const CliFolder folder;
  CommandResult result =
      run_sundog({"bench", "samples", folder.scene, "--device", "portable", "--counts", "8,1,2",
                  "--reference", "64", "--repeat", "2", "--json", folder.file("t.json"), "--html",
                  folder.file("t.html"), "--adaptive", "0.02", "--csv", folder.file("t.csv")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("time and error by samples a pixel"));
  const json report = json::parse(sundog::read_file(folder.file("t.json")));
  const json& rows = report.at("measurements");
  REQUIRE(rows.size() == 3 + 1 + 3);
  for (const json& row : rows) {
    CAPTURE(row.dump());
    CHECK(row.at("problem").is_null());
    CHECK(row.at("reference_samples") == 64);
    CHECK(row.at("time_ms").at("median") > 0);
    CHECK(row.at("rays_millions") > 0);
  }
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(
        (rows[i].at("way").get<std::string>().starts_with("even, ") && rows[i].at("of_even_rays_%") == 100));
  CHECK(rows[2].at("way") == "even, 8");
  CHECK(rows[3].at("way") == "adaptive, 0.02");
  CHECK(rows[3].at("samples") >= 2);
  CHECK(rows[6].at("way") == "subsampled, 8");
  CHECK(rows[6].at("rays_millions") < rows[2].at("rays_millions"));
  CHECK_THAT(sundog::read_file(folder.file("t.csv")), ContainsSubstring("\"adaptive, 0.02\""));
  CHECK(rows[0].at("samples") == 1);  // ascending
  CHECK(rows[1].at("rms_error") < rows[0].at("rms_error"));
  CHECK(rows[2].at("rms_error") < 0.5 * rows[0].at("rms_error").get<double>());
  CHECK(rows[2].at("rms_error") > 0);
  const std::string page = sundog::read_file(folder.file("t.html"));
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK_THAT(page, ContainsSubstring(": error by rays") && ContainsSubstring(": error by time"));

  result = run_sundog({"bench", "samples", folder.scene, "--counts", "4,8", "--reference", "8"});
  CHECK(result.status == 2);
  CHECK(is_one_error_line(result.err));
}

TEST_CASE("bench quality tells the error of each way by time, against a picture that is given") {
  const CliFolder folder;
  REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("r.exr"), "--samples", "64", "--device",
                      "portable", "--quiet"})
              .status == 0);
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"bench",    "quality",     folder.scene,         "--device",
                                          "portable", "--reference", folder.file("r.exr"), "--repeat",
                                          "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sundog(arguments);
  };
  CommandResult result =
      run({"--counts", "1,8", "--samplers", "auto,independent", "--integrators", "whitted", "--goal", "0.01",
           "--json", folder.file("t.json"), "--html", folder.file("t.html")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("error by time"));
  const json rows = json::parse(sundog::read_file(folder.file("t.json"))).at("measurements");
  REQUIRE(rows.size() == 4);
  for (std::size_t i = 0; i < 4; i += 2) {
    CHECK(rows[i].at("sampler") == (i == 0 ? "auto" : "independent"));
    CHECK(rows[i].at("problem").is_null());
    CHECK(rows[i + 1].at("samples") == 8);
    for (const char* error : {"rms_error", "perceived_difference"}) {
      CHECK(rows[i + 1].at(error) < rows[i].at(error));
      CHECK(rows[i + 1].at(error) > 0);
    }
  }
  CHECK_THAT(sundog::read_file(folder.file("t.html")), ContainsSubstring("rms error by time"));

  result = run({"--size", "5x4"});
  CHECK(result.status == 2);
  CHECK(is_one_error_line(result.err));
  CHECK_THAT(result.err, ContainsSubstring("5x4"));
  result = run({"--goal", "nan"});
  CHECK(result.status == 2);
  CHECK_THAT(result.err, ContainsSubstring("--goal nan"));
  const std::string reference = sundog::read_file(folder.file("r.exr"));
  CHECK(run({"--json", folder.file("r.exr")}).status == 2);
  CHECK(sundog::read_file(folder.file("r.exr")) == reference);
}

TEST_CASE("plots of bench samples and bench quality name their device, as the tables do") {
  const CliFolder folder;
  REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("r.exr"), "--quiet"}).status == 0);
  CommandOptions options;
  options.environment["POCL_DEVICES"] = "basic pthread";
  for (std::vector<std::string> bench :
       {std::vector<std::string>{"samples", "--adaptive", "0.05", "--reference", "4"},
        {"quality", "--samplers", "auto", "--reference", folder.file("r.exr")}}) {
    bench.insert(bench.begin(), {"bench"});
    bench.insert(bench.end(), {folder.scene, "--device", "0:0", "--device", "0:1", "--counts", "1,2",
                               "--repeat", "1", "--html", folder.file("t.html")});
    const CommandResult result = run_sundog(bench, options);
    CAPTURE(result.out, result.err);
    REQUIRE(result.status == 0);
    const std::string page = sundog::read_file(folder.file("t.html")), heading = "<h2>";
    std::set<std::string> headings;
    std::size_t count = 0;
    for (std::size_t at = page.find(heading); at != std::string::npos;
         at = page.find(heading, at + 1), ++count)
      headings.insert(page.substr(at, page.find("</h2>", at) - at));
    CHECK(headings.size() == count);
    for (const std::string place : {"0:0 basic", "0:1 pthread"})
      CHECK(std::ranges::any_of(headings, [&](const std::string& title) {
        return title.find("on " + place) != std::string::npos &&
               title.find(": error by ") != std::string::npos;
      }));
  }
}

TEST_CASE("bench textures times a frame with textures and without") {
  const CliFolder folder;
  sundog::write_file(folder.file("board.json"), R"({"camera": {"position": [0, 1, 3], "target": [0, 0, 0]},
    "textures": {"board": {"type": "checker", "colors": [[1, 1, 1], [0.2, 0.2, 0.2]]}},
    "lights": [{"type": "point", "position": [0, 3, 2]}], "materials": {"board": {"color": "board"}},
    "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "board"}]})");
  const CommandResult result =
      run_sundog({"bench", "textures", folder.file("board.json"), "--device", "portable", "--size", "24x16",
                  "--repeat", "6", "--json", folder.file("t.json"), "--svg", folder.file("t.svg")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json rows = json::parse(sundog::read_file(folder.file("t.json"))).at("measurements");
  REQUIRE(rows.size() == 2);
  CHECK((rows[0].at("textures") == "without" && rows[1].at("textures") == "with"));
  for (const json& row : rows) CHECK((row.at("scene") == "board" && row.at("time_ms").at("median") > 0));
  CHECK(rows[0].at("ratio").is_null());
  const json& ratio = rows[1].at("ratio");
  CHECK((ratio.at("low") > 0 && ratio.at("low") <= ratio.at("median") &&
         ratio.at("median") <= ratio.at("high")));
  CHECK(rows[0].at("rays") == rows[1].at("rays"));  // textures change colours alone
  CHECK_THAT(sundog::read_file(folder.file("t.svg")), ContainsSubstring(">with textures<"));
}
