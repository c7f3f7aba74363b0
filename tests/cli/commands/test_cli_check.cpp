// `sundog check`: sound devices pass, wrong pictures and crashing drivers are found and never end it.
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// The report with these drivers alone, and the exit status.
json check(const std::vector<std::string>& libraries, int& status, const std::string& kernels = "",
           const std::map<std::string, std::string>& environment = {}) {
  const TemporaryFolder vendors;
  for (std::size_t i = 0; i < libraries.size(); ++i)
    vendors.write("driver" + std::to_string(i) + ".icd", libraries[i] + "\n");
  CommandOptions options;
  options.environment = environment;
  options.environment["OCL_ICD_VENDORS"] = vendors.path().string() + "/";
  options.environment["SUNDOG_KERNEL_DIR"] = kernels;
  const CommandResult result = run_sundog({"check", "--json"}, options);
  CAPTURE(result.out, result.err);
  status = result.status;
  const json report = json::parse(result.out, nullptr, false);
  REQUIRE(report.is_object());
  CHECK(report.at("schema") == 1);
  return report;
}

json row_of(const json& report, const std::string& part) {
  for (const json& row : report.at("devices"))
    if (row.at("platform").get<std::string>().find(part) != std::string::npos) return row;
  return {};
}

constexpr const char* pocl = "libpocl.so.2";

}  // namespace

TEST_CASE("a driver whose exit handler never comes back does not keep the program from its end") {
  const TemporaryFolder vendors;
  vendors.write("fake.icd", SUNDOG_FAKE_DRIVER "\n");
  CommandOptions options;
  options.environment = {{"OCL_ICD_VENDORS", vendors.path().string() + "/"}, {"FAKE_DRIVER_NEVER_ENDS", "1"}};
  const CommandResult result = run_sundog({"devices"}, options);
  CHECK_FALSE(result.timed_out);
  CHECK(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("Fake crashing"));
}

TEST_CASE("check passes a sound device, and a driver that crashes is a line beside it") {
  int status = -1;
  const json report = check({pocl, SUNDOG_FAKE_DRIVER, "/nowhere/libmissing.so"}, status);
  INFO(report.dump(2));
  CHECK(status == 4);
  const json sound = row_of(report, "Portable");
  CHECK(sound.at("status") == "ok");
  CHECK(sound.at("kernels") >= 4);
  CHECK(sound.at("pixels") == 64 * 48);
  CHECK(sound.at("problem").is_null());
  const json crashed = row_of(report, "Fake crashing");
  CHECK(crashed.at("status") == "failed");
  CHECK_THAT(crashed.at("problem").get<std::string>(), ContainsSubstring("crashed (signal "));
  CHECK_THAT(crashed.at("problem").get<std::string>(), ContainsSubstring("while opening the device"));
  CHECK_THAT(crashed.at("advice").get<std::string>(), ContainsSubstring("leave it out"));
  CHECK(row_of(report, "Fake empty").at("status") == "not usable");
  REQUIRE(report.at("drivers").size() == 3);
  CHECK(report.at("drivers")[0].at("devices") == 1);
  CHECK_THAT(report.at("drivers")[2].at("problem").get<std::string>(), ContainsSubstring("cannot be loaded"));
}

TEST_CASE("check finds a device whose picture is wrong, and one whose kernels do not build") {
  const TemporaryFolder folder;
  copy_frame_kernels(folder.path());
  int status = -1;
  SECTION("wrong") {
    const fs::path file = folder / "plain/path/optics.cl";
    std::string bent = sundog::read_file(file);
    const std::size_t at = bent.find("cos_i / eta - cos_t");
    REQUIRE(at != std::string::npos);
    bent.replace(at, 19, "cos_i / eta - 0.9f * cos_t");
    sundog::write_file(file, bent);
    const json row = row_of(check({pocl}, status, folder.path().string()), "Portable");
    CHECK(status == 6);
    CHECK(row.at("status") == "differs");
    CHECK(row.at("differing") > 20);
  }
  SECTION("broken") {
    const fs::path file = folder / "lib/core/transform.cl";
    sundog::write_file(file, sundog::read_file(file) + "\nthis is no kernel\n");
    const json row = row_of(check({pocl}, status, folder.path().string()), "Portable");
    CHECK(status == 4);
    CHECK(row.at("status") == "failed");
    CHECK_THAT(row.at("problem").get<std::string>(), ContainsSubstring("did not build"));
    CHECK(row.at("log").is_string());
  }
}

TEST_CASE("check reports what it looks at when it begins and ends, and its advice knows what was not asked") {
  const TemporaryFolder vendors;
  vendors.write("a.icd", SUNDOG_FAKE_DRIVER "\n");
  vendors.write("b.icd", std::string(pocl) + "\n");
  CommandOptions options;
  options.environment["OCL_ICD_VENDORS"] = vendors.path().string() + "/";
  const CommandResult result = run_sundog({"check", "--json", "--device", "fake crashing"}, options);
  CAPTURE(result.out, result.err);
  CHECK(result.status == 4);
  for (const char* line : {"checking the driver a.icd\n", "  the driver b.icd: listed, after "})
    CHECK_THAT(result.err, ContainsSubstring(line));
  CHECK_THAT(result.err, ContainsSubstring(": failed, after "));
  const json rows = json::parse(result.out).at("devices");
  REQUIRE(rows.size() == 1);
  CHECK_THAT(
      rows[0].at("advice").get<std::string>(),
      ContainsSubstring("if one of those that were not asked for is sound: `sundog check` looks at all"));
}

TEST_CASE("check does not advise to leave out the only driver or device") {
  int status = -1;
  SECTION("a device that crashes when it is used") {
    const json crashed = row_of(check({SUNDOG_FAKE_DRIVER}, status), "Fake crashing");
    CHECK(status == 4);
    const std::string advice = crashed.at("advice");
    CHECK_THAT(advice, !ContainsSubstring("leave it out"));
    CHECK_THAT(advice, ContainsSubstring("install another driver"));
  }
  SECTION("a driver that ends the process when it is loaded") {
    const json report = check({SUNDOG_FAKE_DRIVER}, status, "", {{"FAKE_DRIVER_ABORTS", "1"}});
    CHECK(status == 4);
    const json driver = report.at("drivers").at(0);
    CHECK_THAT(driver.at("problem").get<std::string>(), ContainsSubstring("crashed (signal 6"));
    const std::string advice = driver.at("advice");
    CHECK_THAT(advice, !ContainsSubstring("leave it out"));
    CHECK_THAT(advice, ContainsSubstring("install another driver"));
  }
  SECTION("the same beside one that works") {
    const json report = check({SUNDOG_FAKE_DRIVER, pocl}, status, "", {{"FAKE_DRIVER_ABORTS", "1"}});
    CHECK_THAT(report.at("drivers").at(0).at("advice").get<std::string>(),
               ContainsSubstring("OCL_ICD_VENDORS"));
    CHECK(report.at("drivers").at(1).at("advice").is_null());
  }
}
