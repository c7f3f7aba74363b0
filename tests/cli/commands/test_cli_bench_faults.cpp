// `sundog bench` where something goes wrong: spoiled results, devices that fail, interrupts; and what its
// reports hold for whoever continues or recomputes them.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;

namespace {

/// Options of a small run of each bench that times a device's results.
std::vector<std::vector<std::string>> small_benches(const CliFolder& folder) {
  return {{"devices", folder.scene, "--device", "0:0/1", "--device", "0:0/1", "--size", "96x64"},
          {"threads", folder.scene, "--device", "0:0", "--sizes", "64", "--counts", "1,2", "--no-plain"},
          {"workgroup", folder.scene, "--device", "0:0", "--sizes", "2,4", "--rays", "32", "--kernel",
           "trace_rays", "--kernel", "render_whitted"},
          {"samples", folder.scene, "--device", "0:0", "--counts", "1,2", "--adaptive", "0.05", "--size",
           "96x64"},
          {"rays", folder.scene, "--device", "0:0", "--rays", "48", "--kinds", "primary,shadow"},
          {"textures", SUNDOG_SOURCE_DIR "/scenes/textures.json", "--device", "0:0", "--size", "64x48"}};
}

constexpr double patient = 600;  // seconds: beside other tests, runs are disturbed and repeated

CommandResult run_bench(std::vector<std::string> arguments, const std::vector<std::string>& more,
                        const std::string& faults = "") {
  CommandOptions options;
  options.timeout = patient;
  options.environment["POCL_DEVICES"] = "pthread";
  if (!faults.empty()) options.environment["SUNDOG_FAULTS"] = faults;
  arguments.insert(arguments.begin(), "bench");
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_sundog(arguments, options);
}

}  // namespace

TEST_CASE("each bench compares every timed result: one that was spoiled later is a row with a problem") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  for (const auto& bench : small_benches(folder)) {
    const CommandResult result =
        run_bench(bench, {"--repeat", "30", "--json", file, "--quiet"}, "spoil>2500@0:0#20+");
    CAPTURE(bench[0], result.out, result.err);
    CHECK((result.status == 0 || result.status == 4));
    const json report = json::parse(sundog::read_file(file));
    std::size_t problems = 0;
    for (const json& way : report.at("ways")) {
      if (way.at("problem").is_null()) continue;
      ++problems;
      CHECK_THAT(way.at("problem").get<std::string>(),
                 ContainsSubstring(" not ") || ContainsSubstring("differ"));
    }
    CHECK(problems > 0);
    for (const json& row : report.at("measurements"))
      if (row.contains("problem") && !row.at("problem").is_null() && row.contains("time_ms"))
        CHECK(row.at("time_ms").is_null());
    std::filesystem::remove(file);
  }
}

TEST_CASE("one spoiled run that others are compared with marks none of them as wrong") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  for (const auto& bench : {small_benches(folder)[0], small_benches(folder)[2]}) {
    const CommandResult result =
        run_bench(bench, {"--repeat", "1", "--json", file, "--quiet"}, "spoil>2500@0:0#1");
    CAPTURE(bench[0], result.out, result.err);
    CHECK(result.status == 0);
    const json report = json::parse(sundog::read_file(file));
    for (const json& way : report.at("ways")) CHECK(way.at("problem").is_null());
  }
}

TEST_CASE("a device that fails in timed runs is a row with its error, beside the runs that it had made") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  for (const auto& bench : small_benches(folder)) {
    const CommandResult result =
        run_bench(bench, {"--repeat", "30", "--json", file, "--quiet"}, "launch=-36@0:0#60+");
    CAPTURE(bench[0], result.out, result.err);
    CHECK((result.status == 0 || result.status == 4));
    const json report = json::parse(sundog::read_file(file));
    std::size_t failed = 0;
    for (const json& way : report.at("ways")) {
      if (way.at("problem").is_null()) continue;
      ++failed;
      CHECK_THAT(way.at("problem").get<std::string>(), ContainsSubstring("CL_INVALID_COMMAND_QUEUE"));
    }
    CHECK(failed > 0);
    std::filesystem::remove(file);
  }
}

TEST_CASE("a driver that ends the process costs the row that it was at, and the others are measured") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  for (const auto& bench : small_benches(folder)) {
    const CommandResult result =
        run_bench(bench, {"--repeat", "5", "--json", file, "--quiet"}, "crash@0:0#12");
    CAPTURE(bench[0], result.out, result.err);
    CHECK_THAT(result.err, ContainsSubstring("ended by signal 6 (Aborted)"));
    const json report = json::parse(sundog::read_file(file));
    CHECK(report.at("complete") == true);
    std::size_t crashed = 0, measured = 0;
    for (const json& way : report.at("ways"))
      if (way.at("problem").is_null())
        ++measured;
      else if (way.at("problem").get<std::string>().find("ended by signal 6") != std::string::npos)
        ++crashed;
    CHECK(crashed > 0);
    CHECK(crashed + measured == report.at("ways").size());
    CHECK(result.status == (measured > 0 ? 0 : 4));  // each process may crash at its 12th launch
    std::filesystem::remove(file);
  }
}

TEST_CASE("a driver that ends each process is a row, and its signal the error where there is no other") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  const auto workgroup = small_benches(folder)[2];
  const CommandResult result = run_bench(workgroup, {"--json", file}, "crash@0:0");
  CAPTURE(result.out, result.err);
  CHECK(result.status == 4);
  const json ways = json::parse(sundog::read_file(file)).at("ways");
  CHECK(ways.size() == 2);  // the default of each kernel
  for (const json& way : ways)
    CHECK_THAT(way.at("problem").get<std::string>(), ContainsSubstring("ended by signal 6"));
}

TEST_CASE("devices that crash or cannot be used are rows of --device all") {
  const CliFolder folder;
  folder.write("vendors/pocl.icd", "libpocl.so.2\n");
  folder.write("vendors/fake.icd", SUNDOG_FAKE_DRIVER "\n");
  CommandOptions options;
  options.environment = {{"OCL_ICD_VENDORS", folder.file("vendors") + "/"}};
  const std::string file = folder.file("b.json");
  for (const auto& bench : {small_benches(folder)[0], small_benches(folder)[2]}) {
    std::vector<std::string> command{"bench", bench[0], folder.scene, "--device", "all", "--repeat", "1"};
    command.insert(command.end(), {"--json", file, "--size", "32x24"});
    if (bench[0] == "workgroup") command.insert(command.end(), {"--sizes", "4"});
    const CommandResult result = run_sundog(command, options);
    CAPTURE(bench[0], result.out, result.err);
    CHECK(result.status == 0);
    for (const char* row : {"Fake crashing", "Fake empty", "Fake failing", "has no compiler"})
      CHECK_THAT(result.out, ContainsSubstring(row));
    std::set<std::string> crashed;
    std::size_t measured = 0;
    const json report = json::parse(sundog::read_file(file));
    for (const json& row : report.at("measurements")) {
      const std::string name = row.at(bench[0] == "devices" ? "devices" : "device");
      if (row.at("problem").is_null())
        ++measured;
      else if (row.at("problem").get<std::string>().starts_with("the process was ended by signal"))
        crashed.insert(name);
    }
    CHECK(measured >= 1);
    CHECK_FALSE(crashed.empty());
    for (const std::string& name : crashed) CHECK_THAT(name, ContainsSubstring("crashing"));
    std::filesystem::remove(file);
  }
}

TEST_CASE("bench kernels has a row for a device that crashes, cannot be used, or builds no program") {
  const CliFolder folder;
  folder.write("vendors/pocl.icd", "libpocl.so.2\n");
  folder.write("vendors/fake.icd", SUNDOG_FAKE_DRIVER "\n");
  CommandOptions options;
  options.environment = {{"OCL_ICD_VENDORS", folder.file("vendors") + "/"}};
  options.timeout = patient;
  const CommandResult all = run_sundog({"bench", "kernels", folder.scene, "--device", "all"}, options);
  CAPTURE(all.out, all.err);
  CHECK(all.status == 0);
  for (const char* word : {"ended by signal 11", "its driver has no compiler", "render_whitted"})
    CHECK_THAT(all.out, ContainsSubstring(word));
  CHECK(run_sundog({"bench", "kernels", folder.scene, "--device", "crashing", "-q"}, options).status == 4);
  const CommandResult unbuilt = run_bench({"kernels", folder.scene, "--device", "0:0"}, {}, "build@0:0#1");
  CAPTURE(unbuilt.out, unbuilt.err);
  CHECK(unbuilt.status == 0);
  CHECK_THAT(unbuilt.out, ContainsSubstring("problem") && ContainsSubstring("first_surfaces"));
}

TEST_CASE("a report named - goes to the standard output, and all else to the other stream") {
  const CliFolder folder;
  const CommandResult result = run_bench(small_benches(folder)[4], {"--repeat", "1", "--json", "-"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(json::parse(result.out).at("bench") == "rays");
  CHECK_THAT(result.err, ContainsSubstring("Rays a second by kind"));
}

TEST_CASE("a reader of messages who has left costs a bench no report") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  run_command({"sh", "-c",
               R"("$0" bench threads "$1" --device portable --sizes 32 --counts 1,2 --no-plain --repeat 2)"
               R"( --json "$2" 2>&1 >/dev/null | :)",
               SUNDOG_BINARY, folder.scene, file});
  CHECK(json::parse(sundog::read_file(file)).at("complete") == true);
}

TEST_CASE("a bench that is interrupted leaves its report, and another run continues it") {
  const CliFolder folder;
  const std::string file = folder.file("b.json");
  const std::vector<std::string> arguments = {"bench",    "threads", folder.scene, "--device", "portable",
                                              "--sizes",  "32",      "--counts",   "1,2",      "--no-plain",
                                              "--repeat", "10000",   "--json",     file};
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(file);
    CommandOptions options;
    options.signal_at = "this will take";
    options.signal = signal;
    const CommandResult result = run_sundog(arguments, options);
    CAPTURE(result.out, result.err);
    CHECK(result.status == 130);
    CHECK_THAT(result.err, ContainsSubstring("sundog: interrupted: --continue " + file));
    CHECK(json::parse(sundog::read_file(file)).at("complete") == false);
  }
  const auto first = run_bench(
      {"threads", folder.scene, "--device", "0:0", "--sizes", "32", "--counts", "1,2", "--no-plain"},
      {"--repeat", "2", "--json", file});
  REQUIRE(first.status == 0);
  const json before = json::parse(sundog::read_file(file));
  CHECK(before.at("complete") == true);
  const auto next = run_bench(
      {"threads", folder.scene, "--device", "0:0", "--sizes", "32", "--counts", "1,2", "--no-plain"},
      {"--repeat", "3", "--json", file, "--continue", file});
  CAPTURE(next.out, next.err);
  REQUIRE(next.status == 0);
  const json after = json::parse(sundog::read_file(file));
  for (std::size_t way = 0; way < 2; ++way) {
    const json &old = before.at("ways")[way].at("runs"), &all = after.at("ways")[way].at("runs");
    REQUIRE(all.size() >= old.size());
    for (std::size_t i = 0; i < old.size(); ++i) CHECK(all[i].at("seconds") == old[i].at("seconds"));
  }
  const auto other = run_bench({"threads", folder.scene, "--device", "0:0", "--sizes", "32", "--no-plain"},
                               {"--continue", file, "--set", "/camera/fov=30"});
  CHECK(other.status == 2);
  CHECK_THAT(other.err, ContainsSubstring("--continue " + file) && ContainsSubstring("measured another"));
  const auto wrong = run_bench({"devices", folder.scene, "--device", "0:0"}, {"--continue", file});
  CHECK(wrong.status == 2);
  CHECK_THAT(wrong.err, ContainsSubstring("it is of bench threads"));
}

TEST_CASE("a bench that compiles variants of a scene is continued with further ones") {
  const CliFolder folder;
  const std::string file = folder.file("s.json");
  const auto samples = [&](const std::string& counts, const std::vector<std::string>& more) {
    std::vector<std::string> all{"--repeat", "1", "--reference", "8", "--json", file};
    all.insert(all.end(), more.begin(), more.end());
    return run_bench({"samples", folder.scene, "--device", "0:0", "--size", "32x24", "--adaptive", "0.05",
                      "--counts", counts},
                     all);
  };
  REQUIRE(samples("1,2", {}).status == 0);
  const CommandResult further = samples("1,2,4", {"--continue", file});
  CAPTURE(further.err);
  CHECK(further.status == 0);
  CHECK(samples("1,2", {"--continue", file, "--set", "/render/max_depth=2"}).status == 2);
}

TEST_CASE("scenes in files of one name have their own rows in a bench") {
  const CliFolder folder;
  const std::string file = folder.file("d.json");
  std::filesystem::create_directory(folder.file("other"));
  const std::string other = folder.file("other/" + std::filesystem::path(folder.scene).filename().string());
  std::filesystem::copy_file(folder.scene, other);
  REQUIRE(run_bench({"devices", folder.scene, other, "--device", "0:0", "--size", "32x24"},
                    {"--repeat", "1", "--json", file})
              .status == 0);
  const json report = json::parse(sundog::read_file(file));
  CHECK(report.at("measurements").at(0).at("scene") == folder.scene);
  CHECK(report.at("measurements").at(1).at("scene") == other);
}

TEST_CASE("bench devices measures a device and its parts, told apart by their labels") {
  const CliFolder folder;
  const std::string file = folder.file("d.json");
  const CommandResult result =
      run_bench({"devices", folder.scene, "--device", "0:0/1", "--device", "0:0", "--device", "0:0/1"},
                {"--repeat", "1", "--json", file});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  std::set<std::string> names;
  const json report = json::parse(sundog::read_file(file));
  for (const json& row : report.at("measurements")) {
    const std::string name = row.at("devices");
    const std::size_t plus = name.find(" + ");
    const std::string first = name.substr(0, name.find(' '));
    names.insert(plus == std::string::npos ? first
                                           : first + name.substr(plus, name.find(' ', plus + 3) - plus));
    CHECK((row.at("efficiency").is_number() && row.at("efficiency") > 0));
  }
  CHECK(names == std::set<std::string>{"0:0", "0:0/1", "0:0/1@1", "0:0/1 + 0:0/1@1"});
  CHECK(report.at("devices").size() == 3);
  CHECK(report.at("devices")[1].at("compute_units") == 1);
  CHECK(report.at("scenes")[0].at("width_pixels") == 32);
  CHECK(report.at("scenes")[0].at("seed") == 0);
  CHECK(report.at("environment").at("POCL_DEVICES") == "pthread");
  CHECK(report.at("facts").contains("compiler"));
}

TEST_CASE("bench workgroup takes sizes of one's own and ends about when its budget is over") {
  const CliFolder folder;
  const std::string file = folder.file("w.json");
  const CommandResult result =
      run_bench({"workgroup", folder.scene, "--device", "0:0", "--rays", "16", "--kernel", "occluded_rays"},
                {"--sizes", "2,4x2", "--budget", "1", "--repeat", "10000", "--json", file});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json rows = json::parse(sundog::read_file(file)).at("measurements");
  REQUIRE(rows.size() >= 3);
  CHECK(rows[2].at("work-group") == "4x2");
  for (const json& row : rows)
    if (row.at("problem").is_null() && row.at("round") == "sweep") CHECK(row.at("runs") < 10000);
  const CommandResult wrong = run_bench({"workgroup", folder.scene}, {"--sizes", "2,big"});
  CHECK(wrong.status == 2);
  CHECK_THAT(wrong.err, ContainsSubstring("--sizes big"));
}

TEST_CASE("bench workgroup times a frame once, by whichever names it is asked for") {
  const CliFolder folder;
  const std::string file = folder.file("w.json");
  const CommandResult result =
      run_bench({"workgroup", folder.scene, "--device", "0:0", "--kernel", "render_path", "--kernel",
                 "render_whitted", "--kernel", "render_whitted"},
                {"--sizes", "2", "--repeat", "1", "--json", file});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  std::vector<std::string> swept;
  const json rows = json::parse(sundog::read_file(file)).at("measurements");
  for (const json& row : rows) {
    CHECK(row.at("kernel") == "render_whitted");
    if (row.at("round") == "sweep") swept.push_back(row.at("work-group"));
  }
  CHECK(std::ranges::count(swept, "2") == 1);
}

TEST_CASE("a bench whose rows are not as precise as asked says how many") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"bench", "samples", folder.scene, "--device", "portable", "--counts", "1", "--adaptive",
                  "0.05", "--repeat", "1", "--precision", "0.01%", "--budget", "1"});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("--precision 0.01% not reached: ") &&
                             ContainsSubstring(" rows. A row ends when "));
}
