// The list of devices: nothing that a driver does hides the others. Each environment needs a process of its
// own, so the real binary is asked.
#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/environment.h"
#include "catch.h"
#include "devices.h"
#include "temporary_folder.h"

using namespace sundog;
using nlohmann::json;

namespace {

struct Answer {
  int status;
  std::string text;  // stdout and stderr
};

/// `command` after `environment` ("A=1 B='2 3'"), in a shell.
Answer run_sundog(const std::string& environment, const std::string& arguments) {
  const std::string command = "env " + environment + " '" SUNDOG_BINARY "' " + arguments + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe);
  Answer answer{};
  for (char part[4096]; const std::size_t count = std::fread(part, 1, sizeof part, pipe);)
    answer.text.append(part, count);
  const int status = ::pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

json device_list(const std::string& environment) {
  const Answer answer = run_sundog(environment, "devices --json");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const json list = json::parse(answer.text);
  CHECK(list.at("schema") == 1);
  return list.at("devices");
}

/// The rows of the platforms whose names contain `part`.
std::vector<json> rows_of(const json& list, const std::string& part) {
  std::vector<json> rows;
  for (const json& row : list)
    if (row.at("platform_name").get<std::string>().find(part) != std::string::npos) rows.push_back(row);
  return rows;
}

}  // namespace

TEST_CASE("a row is usable and complete, or says what is wrong") {
  const auto rows = enumerate_devices(plain_environment());
  REQUIRE(!rows.empty());
  for (const DeviceInfo& row : rows) {
    INFO(row.label());
    CHECK(row.usable() == row.problem.empty());
    CHECK(!row.platform_name.empty());
    if (!row.usable()) continue;
    CHECK((row.compute_units > 0 && row.max_work_group > 0 && row.max_allocation > 0 && row.estimate > 0));
    CHECK((!row.name.empty() && !row.driver.empty() && row.handle));
  }
}

TEST_CASE("drivers that fail, lie or have nothing are rows with their problem, and hide nobody") {
  const TemporaryFolder vendors;
  vendors.write("fake.icd", SUNDOG_FAKE_DRIVER "\n");
  vendors.write("missing.icd", "/nowhere/libmissing.so\n");
  vendors.write("pocl.icd", "libpocl.so.2\n");
  const json list = device_list("OCL_ICD_VENDORS=" + vendors.path().string() + "/");
  const auto problem = [&](const std::string& platform, std::size_t device) {
    const auto rows = rows_of(list, platform);
    REQUIRE(rows.size() > device);
    return rows[device].at("problem").get<std::string>();
  };
  CHECK(problem("Fake failing", 0) == "clGetDeviceIDs: CL_OUT_OF_HOST_MEMORY");
  CHECK(problem("Fake mute", 0) == "CL_DEVICE_NAME: CL_OUT_OF_RESOURCES");
  CHECK(problem("Fake mute", 1) == "its driver has no compiler");
  CHECK(problem("Fake old", 0) == "speaks \"OpenCL C 1.1\", wanted OpenCL C 1.2 or later");
  CHECK(problem("Fake old", 1) == "it is big-endian");
  CHECK(problem("Fake empty", 0) == "the platform has no device");
  const auto pocl = rows_of(list, "Portable Computing Language");
  REQUIRE(pocl.size() == 1);
  CHECK(pocl[0].at("usable") == true);
  CHECK(pocl[0].at("default") == true);
  const Answer table = run_sundog("OCL_ICD_VENDORS=" + vendors.path().string() + "/", "devices");
  CHECK(table.status == 0);
  CHECK_THAT(table.text, ContainsSubstring("clGetDeviceIDs: CL_OUT_OF_HOST_MEMORY") &&
                             ContainsSubstring("Portable Computing Language") &&
                             ContainsSubstring("[the default]"));
}

TEST_CASE("Intel's driver is loaded with its vectorizer off, unless the user sets it") {
  const TemporaryFolder vendors;
  vendors.write("fake.icd", SUNDOG_FAKE_DRIVER "\n");
  const auto version = [&](const std::string& setting) {
    const json list = device_list(setting + " OCL_ICD_VENDORS=" + vendors.path().string() + "/");
    const auto rows = rows_of(list, "Fake empty");
    REQUIRE(rows.size() == 1);
    return rows[0].at("platform_version").get<std::string>();
  };
  CHECK(version("-u CL_CONFIG_USE_VECTORIZER") == "OpenCL 1.2 fake, vectorizer False");
  CHECK(version("CL_CONFIG_USE_VECTORIZER=True") == "OpenCL 1.2 fake, vectorizer True");
}

TEST_CASE("where there is no platform the list says so, and a render ends with the mend") {
  const TemporaryFolder nothing;
  const std::string environment = "OCL_ICD_VENDORS=" + nothing.path().string() + "/";
  const Answer list = run_sundog(environment, "devices");
  CHECK(list.status == 0);
  CHECK_THAT(list.text, ContainsSubstring("no OpenCL platform"));
  CHECK(device_list(environment).empty());
  const Answer render = run_sundog(
      environment, "render '" SUNDOG_SOURCE_DIR "/scenes/spheres.json' -o " + (nothing / "out.png").string());
  CHECK(render.status == 4);
  CHECK_THAT(render.text, ContainsSubstring("pocl-opencl-icd"));
}

TEST_CASE("all the devices of one driver are listed, and several drivers live together") {
  const json list = device_list("POCL_DEVICES='basic pthread' RUSTICL_ENABLE=llvmpipe");
  const auto pocl = rows_of(list, "Portable Computing Language");
  REQUIRE(pocl.size() == 2);
  const Answer table = run_sundog("POCL_DEVICES='basic pthread'", "devices");
  CHECK_THAT(table.text, !ContainsSubstring(" 1 sub-devices"));  // one unit is no part of anything
  CHECK(pocl[0].at("device") == 0);
  CHECK(pocl[1].at("device") == 1);
  CHECK((pocl[0].at("usable") == true && pocl[1].at("usable") == true));
  for (const json& row : rows_of(list, "rusticl"))  // where Mesa is installed
    if (row.at("usable") == true) CHECK(row.at("estimate") < pocl[0].at("estimate"));
  std::size_t defaults = 0;
  for (const json& row : list) defaults += row.value("default", false);
  CHECK(defaults == 1);
}

TEST_CASE("PoCL's two devices, llvmpipe, Oclgrind and Clover, which has none, stand in one list") {
  struct Driver {
    const char *library, *platform;
    std::size_t devices;
    const char* tracer;
  };
  const TemporaryFolder vendors;
  std::vector<Driver> installed;
  for (const Driver& driver : {Driver{"libpocl.so.2", "Portable Computing Language", 2, "wide"},
                               Driver{"libRusticlOpenCL.so.1", "rusticl", 1, "compact"},
                               Driver{"libMesaOpenCL.so.1", "Clover", 0, ""},
                               Driver{"/usr/lib/oclgrind/liboclgrind-rt-icd.so", "Oclgrind", 1, "compact"}}) {
    if (void* library = ::dlopen(driver.library, RTLD_LAZY | RTLD_LOCAL)) {
      ::dlclose(library);
      vendors.write(std::string(driver.platform) + ".icd", std::string(driver.library) + "\n");
      installed.push_back(driver);
    }
  }
  REQUIRE(installed.size() >= 1);  // PoCL; the others where they are installed
  CHECK(std::string(installed.front().platform) == "Portable Computing Language");
  const std::string environment = "OCL_ICD_VENDORS='" + vendors.path().string() +
                                  "/' POCL_DEVICES='basic pthread' RUSTICL_ENABLE=llvmpipe";
  const json list = device_list(environment);
  CAPTURE(list.dump(2));
  for (const Driver& driver : installed) {
    CAPTURE(driver.platform);
    const auto rows = rows_of(list, driver.platform);
    REQUIRE(rows.size() == std::max<std::size_t>(driver.devices, 1));
    for (const json& row : rows) {
      CHECK(row.at("usable") == (driver.devices > 0));
      CHECK(row.at("problem").is_null() == (driver.devices > 0));
      if (driver.devices > 0) CHECK(row.at("tracer") == driver.tracer);
    }
  }
  const auto pocl = rows_of(list, "Portable Computing Language");
  CHECK(std::ranges::count_if(list, [](const json& row) { return row.value("default", false); }) == 1);
  CHECK((pocl[0].at("default") == true || pocl[1].at("default") == true));
}
