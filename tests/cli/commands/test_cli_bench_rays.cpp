// `sundog bench rays` and `bench roofline`, on tiny settings.
#include <nlohmann/json.hpp>
#include <set>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;

TEST_CASE("bench rays times every kind of ray and checks the hits") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"bench", "rays", SUNDOG_SOURCE_DIR "/scenes/spheres.json", "--device", "portable", "--rays",
                  "32", "--repeat", "2", "--json", folder.file("r.json"), "--t4", folder.file("r.t4")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json report = json::parse(sundog::read_file(folder.file("r.json")));
  CHECK_THAT(report.at("facts").at("spheres").get<std::string>(), ContainsSubstring("SAH cost"));
  std::vector<std::string> kinds;
  for (const json& row : report.at("measurements")) {
    CAPTURE(row.dump());
    kinds.push_back(row.at("kind"));
    CHECK(row.at("rate_Mrays/s").at("median") > 0);
    CHECK(row.at("hits") > 0);
    CHECK(row.at("checked") == row.at("rays"));  // each
    CHECK(row.at("rounded") <= 0.01 * row.at("rays").get<double>());
    CHECK(row.at("differ") == 0);
    CHECK(row.at("tracer") == "wide");
    // The kernel's time is part of what the host waits for. PoCL's clock may start with the launch.
    CHECK(row.at("kernel_Mrays/s").at("median") >= 0.99 * row.at("rate_Mrays/s").at("median").get<double>());
  }
  CHECK(kinds == std::vector<std::string>{"primary", "shadow", "bounce", "shuffled", "reflection", "glass"});
  for (const json& result : json::parse(sundog::read_file(folder.file("r.t4"))).at("results")) {
    CAPTURE(result.dump());
    std::set<std::string> names;
    for (const auto& [name, value] : result.at("configuration").items()) names.insert(name);
    CHECK(names == std::set<std::string>{"scene", "device", "tracer", "kind"});
    names.clear();
    for (const json& measured : result.at("measurements")) names.insert(measured.at("name"));
    for (const char* name : {"hits", "checked", "rate", "rays"}) CHECK(names.count(name) == 1);
  }
}

TEST_CASE("bench rays takes the kinds that are asked for, and checks alone without times") {
  const CliFolder folder;
  const std::string scene = SUNDOG_SOURCE_DIR "/tests/support/mesh_and_solids.json";
  for (const char* tracer : {"wide", "compact"}) {
    const CommandResult result = run_sundog(
        {"bench", "rays", scene, "--device", "portable", "--rays", "16", "--no-times", "--kinds",
         "glass,primary", "--set", std::string("/render/tracer=") + tracer, "--json", folder.file("k.json")});
    CAPTURE(result.out, result.err);
    REQUIRE(result.status == 0);
    const json rows = json::parse(sundog::read_file(folder.file("k.json"))).at("measurements");
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].at("kind") == "primary");
    CHECK(rows[1].at("kind") == "glass");
    CHECK(rows[1].at("checked") == rows[1].at("rays"));
    CHECK(rows[1].at("rate_Mrays/s").is_null());
  }
  const CommandResult wrong = run_sundog({"bench", "rays", scene, "--kinds", "primary,glas"});
  CHECK(wrong.status == 2);
  CHECK(is_one_error_line(wrong.err));
  CHECK_THAT(wrong.err, ContainsSubstring("shuffled"));
}

TEST_CASE("bench rays fails where a kernel tells wrong distances") {
  const CliFolder folder;
  const std::filesystem::path kernels = folder / "kernels";
  std::filesystem::copy(SUNDOG_SOURCE_DIR "/kernels", kernels, std::filesystem::copy_options::recursive);
  const std::filesystem::path file = kernels / "entry" / "trace_rays.cl";
  std::string text = sundog::read_file(file);
  const std::string call = "coherent != 0u);";
  REQUIRE(text.find(call) != std::string::npos);
  text.replace(text.find(call), call.size(), call + "\n  found.t *= 1.01f;");
  sundog::write_file(file, text);
  CommandOptions options;
  options.environment["SUNDOG_KERNEL_DIR"] = kernels.string();
  const CommandResult result = run_sundog(
      {"bench", "rays", folder.scene, "--device", "portable", "--rays", "32", "--repeat", "1"}, options);
  CAPTURE(result.out, result.err);
  CHECK(result.status == 4);
  CHECK_THAT(result.err, ContainsSubstring("wrong answers"));
  CHECK(is_one_error_line(result.err));
}

TEST_CASE("bench rays says that it leaves distance fields out, and times nothing where nothing else is") {
  const CliFolder folder;
  const CommandResult result = run_sundog({"bench", "rays", SUNDOG_SOURCE_DIR "/scenes/mandelbulb.json",
                                           SUNDOG_SOURCE_DIR "/scenes/julia.json", "--device", "portable",
                                           "--rays", "16", "--repeat", "1", "--json", folder.file("r.json")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json report = json::parse(sundog::read_file(folder.file("r.json")));
  CHECK_THAT(report.at("facts").at("mandelbulb").get<std::string>(),
             ContainsSubstring("1 distance field left out: marched, not traced") &&
                 ContainsSubstring("nothing to time"));
  CHECK_THAT(
      report.at("facts").at("julia").get<std::string>(),
      ContainsSubstring("SAH cost") && ContainsSubstring("1 distance field left out: marched, not traced"));
  for (const json& row : report.at("measurements")) CHECK(row.at("scene") == "julia");
  CHECK(!report.at("measurements").empty());
}

TEST_CASE("bench roofline measures a device, and counts the work of rays below its roof") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"bench", "roofline", folder.scene, "--device", "portable", "--megabytes", "1", "--rays",
                  "32", "--repeat", "1", "--json", folder.file("r.json"), "--svg", folder.file("r.svg"),
                  "--t4", folder.file("r.t4")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("Peaks of ") && ContainsSubstring("read memory") &&
                             ContainsSubstring("work of a ray"));
  CHECK_THAT(sundog::read_file(folder.file("r.svg")), ContainsSubstring("operations a byte"));
  std::set<std::string> measured;
  std::size_t kinds = 0;
  const json report = json::parse(sundog::read_file(folder.file("r.json")));
  for (const json& row : report.at("measurements")) {
    CAPTURE(row.dump());
    CHECK(row.at("problem").is_null());
    if (!row.at("measured").is_null()) measured.insert(row.at("measured"));
    if (!row.contains("kind") || row.at("kind").is_null()) continue;
    ++kinds;
    CHECK(row.at("work_op") > 0);
    CHECK(row.at("at_least_B") <= row.at("asked_for_B"));
    CHECK(row.at("rate_Gop/s").at("median") > 0);
  }
  CHECK(kinds > 0);
  for (const json& result : json::parse(sundog::read_file(folder.file("r.t4"))).at("results")) {
    CAPTURE(result.dump());
    for (const auto& [name, value] : result.at("configuration").items())
      CHECK(std::set<std::string>{"scene", "device", "kind", "measured", "width", "chains"}.count(name) == 1);
    CHECK_FALSE(result.at("times").at("runtimes").empty());
  }
  for (const char* what : {"read memory", "read cache", "copy memory", "float", "int", "launch"})
    CHECK(measured.count(what) == 1);
  CHECK(run_sundog({"bench", "roofline", "--megabytes", "0"}).status == 2);
}

TEST_CASE("bench roofline continues an earlier run") {
  const CliFolder folder;
  const std::vector<std::string> arguments{"bench", "roofline", "--device", "portable", "--megabytes",
                                           "1",     "--repeat", "1",        "--quiet",  "--json"};
  auto first = arguments;
  first.push_back(folder.file("a.json"));
  REQUIRE(run_sundog(first).status == 0);
  auto second = arguments;
  second.insert(second.end(), {folder.file("b.json"), "--continue", folder.file("a.json")});
  const CommandResult result = run_sundog(second);
  CAPTURE(result.err);
  CHECK(result.status == 0);
}
