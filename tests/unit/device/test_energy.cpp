// Joules by counters of the system's files, as they lie on machines that have them.
#include "device/energy.h"

#include <dlfcn.h>

#include <array>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

DeviceInfo device_of(const char* type, const char* vendor = "x") {
  DeviceInfo device;
  device.type = type;
  device.vendor = vendor;
  device.name = "made up";
  device.device = 0;
  return device;
}

const std::array processor{device_of("cpu")};

}  // namespace

TEST_CASE("RAPL's packages are added up without their parts, and their counters wrap") {
  const TemporaryFolder system;
  const auto zone = [&](const std::string& folder, const char* name, const char* microjoules) {
    system.write("class/powercap/" + folder + "/name", name);
    system.write("class/powercap/" + folder + "/max_energy_range_uj", "262143328850\n");
    system.write("class/powercap/" + folder + "/energy_uj", microjoules);
  };
  zone("intel-rapl:0", "package-0\n", "262143000000\n");
  zone("intel-rapl:0:0", "core\n", "1000000\n");
  zone("intel-rapl:1", "package-1\n", "5000000\n");
  zone("intel-rapl:2", "psys\n", "9000000\n");
  system.write("class/powercap/intel-rapl/enabled", "1\n");
  EnergyMeter meter(processor, system.path().string());
  CHECK(meter.source() == "RAPL package-0, RAPL package-1");
  CHECK(meter.joules() == 0);
  zone("intel-rapl:0", "package-0\n", "1671150\n");  // 2 J later
  zone("intel-rapl:0:0", "core\n", "9000000\n");
  zone("intel-rapl:1", "package-1\n", "5500000\n");
  const nlohmann::json stats = energy_json(meter.joules(), 0.5, meter.source());
  CHECK(stats.at("joules") == Approx(2.5));
  CHECK(stats.at("watts") == Approx(5));
  CHECK(stats.at("counted_by") == "RAPL package-0, RAPL package-1");
  std::filesystem::remove(system / "class/powercap/intel-rapl:1/energy_uj");
  CHECK(meter.joules() == -1);
  const nlohmann::json unknown = energy_json(meter.joules(), 0.5, "not known: gone");
  CHECK((unknown.at("joules").is_null() && unknown.at("watts").is_null()));
}

TEST_CASE("where there is no RAPL the sockets of hwmon's amd_energy count") {
  const TemporaryFolder system;
  system.write("class/hwmon/hwmon0/name", "nvme\n");
  system.write("class/hwmon/hwmon3/name", "amd_energy\n");
  system.write("class/hwmon/hwmon3/energy1_label", "Ecore000\n");
  system.write("class/hwmon/hwmon3/energy1_input", "70000000\n");
  system.write("class/hwmon/hwmon3/energy17_label", "Esocket0\n");
  system.write("class/hwmon/hwmon3/energy17_input", "1000000\n");
  EnergyMeter meter(processor, system.path().string());
  CHECK(meter.source() == "hwmon amd_energy Esocket0");
  system.write("class/hwmon/hwmon3/energy17_input", "4000000\n");
  CHECK(meter.joules() == Approx(3));
}

TEST_CASE("what is not counted has a reason: a virtual machine, a file of root's, a GPU without a counter") {
  const TemporaryFolder system;
  EnergyMeter none(processor, system.path().string());
  CHECK(none.joules() == -1);
  CHECK_THAT(none.source(), ContainsSubstring("not known: no counter under") && ContainsSubstring("virtual"));
  system.write("class/powercap/intel-rapl:0/name", "package-0\n");  // without a number to read
  CHECK_THAT(EnergyMeter(processor, system.path().string()).source(),
             ContainsSubstring("energy_uj") && ContainsSubstring("chmod a+r"));
  const std::array gpu{device_of("gpu", "Advanced Micro Devices")};
  CHECK_THAT(EnergyMeter(gpu).source(), ContainsSubstring("nothing here counts that of"));
  DeviceInfo remote = device_of("cpu");
  remote.host = "node7";
  CHECK_THAT(EnergyMeter(std::array{remote}).source(), ContainsSubstring("another process"));
}

TEST_CASE("an NVIDIA GPU's joules and clock come from NVML") {
  REQUIRE(::dlopen(SUNDOG_FAKE_NVML, RTLD_NOW) != nullptr);
  const std::array gpu{device_of("gpu", "NVIDIA Corporation")};
  EnergyMeter meter(gpu);
  CHECK(meter.source() == "NVML made up");
  CHECK(meter.clock() == 1980);
  CHECK(meter.joules() == Approx(2));
  CHECK(meter.joules() == Approx(5));
}
