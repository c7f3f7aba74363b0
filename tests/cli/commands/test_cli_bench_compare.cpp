// `sundog bench compare`: reports that say what they measured, and which differ in nothing or in one thing.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;

namespace {

json way(const std::string& name, std::vector<double> seconds) {
  json runs = json::array();
  for (const double each : seconds)
    runs.push_back({{"seconds", each}, {"cores", 1}, {"others", nullptr}, {"at", 0}, {"left_out", nullptr}});
  return {{"name", name}, {"problem", nullptr}, {"noisy", false}, {"runs", runs}};
}

/// A report of `devices`, each with one row of one kind of rays.
std::string report(const std::vector<std::string>& devices, const std::vector<double>& seconds,
                   int width = 64) {
  json all{{"schema", 2},
           {"bench", "rays"},
           {"facts", {{"revision", "r"}}},
           {"scenes", json::array({{{"name", "ice"}, {"width_pixels", width}, {"hash", "x"}}})},
           {"devices", json::array()},
           {"ways", json::array()}};
  double factor = 1;
  for (const std::string& device : devices) {
    all["devices"].push_back({{"label", device}, {"name", "x"}});
    std::vector<double> own = seconds;
    for (double& each : own) each *= factor;
    factor *= 2;
    all["ways"].push_back(way("ice on " + device + ", primary rays", own));
  }
  return all.dump();
}

const std::vector<double> times{1, 1.01, 1.02, 1, 1.03, 1.01};

}  // namespace

TEST_CASE("bench compare names a winner between reports of two machines, and none between equal ones") {
  const CliFolder folder;
  folder.write("a.json", report({"0:0 P / first"}, times));
  folder.write("b.json", report({"0:1 Q / second"}, {2, 2.01, 2.02, 2, 2.01, 2.03}));
  const CommandResult result =
      run_sundog({"bench", "compare", folder.file("a.json"), folder.file("b.json"), folder.file("a.json"),
                  "--json", folder.file("c.json"), "--html", folder.file("c.html")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json rows = json::parse(sundog::read_file(folder.file("c.json"))).at("measurements");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].at("measured") == "ice on the device, primary rays");
  CHECK(rows[0].at("verdict") == "slower");
  CHECK((rows[0].at("ratio").at("low") > 1.8 && rows[0].at("ratio").at("high") < 2.2));
  CHECK(rows[1].at("verdict") == "not told apart");
  CHECK_THAT(result.out, ContainsSubstring("●") && ContainsSubstring("slower in 1") &&
                             ContainsSubstring("Fewer than six calls"));
  CHECK_THAT(sundog::read_file(folder.file("c.html")), ContainsSubstring("<svg xmlns"));
}

TEST_CASE("bench compare knows a device by each of the names that rows may have for it") {
  const CliFolder folder;
  json titled = json::parse(report({"0:0 P / x (LLVM 15)"}, times));
  titled["devices"][0]["name"] = "x (LLVM 15)";
  for (const char* name : {"0:0 P / x (LLVM 15)", "0:0 x (LLVM 15)", "0:0 x", "0:0"}) {
    titled["ways"][0]["name"] = fmt::format("ice on {}, primary rays", name);
    folder.write("b.json", titled.dump());
    if (name == std::string("0:0 P / x (LLVM 15)")) folder.write("a.json", titled.dump());
    const CommandResult result = run_sundog(
        {"bench", "compare", folder.file("a.json"), folder.file("b.json"), "--json", folder.file("c.json")});
    CAPTURE(name, result.out, result.err);
    REQUIRE(result.status == 0);
    CHECK(json::parse(sundog::read_file(folder.file("c.json"))).at("measurements")[0].at("measured") ==
          "ice on 0:0 x, primary rays");
  }
}

TEST_CASE("bench compare takes the calls in folders, and the devices of one report in turn") {
  const CliFolder folder;
  for (int call = 0; call < 6; ++call)
    for (const bool other : {false, true})
      folder.write((other ? "after/" : "before/") + std::to_string(call) + ".json",
                   report({"0:0 P / first"}, {1 + 0.02 * call - (other ? 0.3 : 0)}));
  CommandResult result = run_sundog({"bench", "compare", folder.file("before"), folder.file("after")});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("faster in 1 of 1 rows") && ContainsSubstring("by bootstrap"));
  for (const char* bench : {"rays", "devices"}) {  // the devices of the second alone took turns
    json two = json::parse(report({"0:0 P / first", "0:0/1 P / first"}, times));
    two["bench"] = bench;
    folder.write("two.json", two.dump());
    result = run_sundog({"bench", "compare", folder.file("two.json"), "--json", folder.file("c.json")});
    CAPTURE(result.out, result.err);
    REQUIRE(result.status == 0);
    const json rows = json::parse(sundog::read_file(folder.file("c.json"))).at("measurements");
    REQUIRE(rows.size() == 1);
    CHECK(rows[0].at("other") == "0:0/1 x");
    CHECK(rows[0].at("ratio").at("median") == Approx(2));
    CHECK(rows[0].at("verdict") == "slower");
    CHECK((result.out.find("The devices took turns") != std::string::npos) == (bench[0] == 'd'));
  }
}

TEST_CASE("bench compare refuses what does not match, and says what differs") {
  const CliFolder folder;
  folder.write("a.json", report({"0:0 P / first"}, times));
  folder.write("b.json", report({"0:0 P / first"}, times, 32));
  folder.write("c.json", "{}");
  const auto error = [&](std::vector<std::string> files, int status = 2) {
    std::vector<std::string> arguments{"bench", "compare"};
    for (const std::string& file : files) arguments.push_back(folder.file(file));
    const CommandResult result = run_sundog(arguments);
    CHECK(result.status == status);
    CHECK(is_one_error_line(result.err));
    return result.err;
  };
  CHECK_THAT(error({"a.json", "b.json"}),
             ContainsSubstring("scene ice") && ContainsSubstring("width_pixels 32"));
  CHECK_THAT(error({"a.json", "c.json"}, 3), ContainsSubstring("no report of sundog bench"));
  CHECK_THAT(error({"a.json", "none.json"}, 3), ContainsSubstring("none.json: cannot be read"));
  CHECK_THAT(error({"a.json"}), ContainsSubstring("one device"));
}
