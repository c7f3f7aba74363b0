// A --device SPEC selects devices, from made-up rows; and the default device.
#include "base/error.h"
#include "catch.h"
#include "device/choice.h"
#include "device/devices.h"
#include "device/estimate.h"

using namespace sundog;

namespace {

DeviceInfo row(int platform, int device, const char* platform_name, const char* name, const char* type,
               double estimate, unsigned units = 8, unsigned max_sub_devices = 0) {
  DeviceInfo info;
  info.platform = platform;
  info.device = device;
  info.platform_name = platform_name;
  info.name = name;
  info.type = type;
  info.estimate = estimate;
  info.compute_units = units;
  info.max_sub_devices = max_sub_devices;
  return info;
}

std::vector<DeviceInfo> machine() {
  std::vector<DeviceInfo> rows = {
      row(0, 0, "Portable Computing Language", "basic-skylake", "cpu", 100),
      row(0, 1, "Portable Computing Language", "pthread-skylake", "cpu", 800, 8, 8),
      row(1, -1, "Clover", "", "", 0),
      row(2, 0, "NVIDIA CUDA", "GeForce 4090/D", "gpu", 90000, 128),
      row(2, 1, "NVIDIA CUDA", "Broken GPU", "gpu", 95000, 128),
      row(3, 0, "Xilinx", "U250", "accelerator", 50),
  };
  rows[2].problem = "the platform has no device";
  rows[4].problem = "its driver has no compiler";
  return rows;
}

/// "0:1 2:0/4": the indices of what the specs select.
std::string selected(const std::vector<std::string>& specs) {
  std::string text;
  for (const DeviceInfo& device : select_devices(machine(), specs)) {
    const std::string label = device.label();
    if (!text.empty()) text += " ";
    text += label.substr(0, label.find(' '));
  }
  return text;
}

}  // namespace

TEST_CASE("a SPEC selects every usable device that it matches") {
  CHECK(selected({"0:1"}) == "0:1");
  CHECK(selected({"cpu"}) == "0:0 0:1");
  CHECK(selected({"gpu"}) == "2:0");
  CHECK(selected({"GPU"}) == "2:0");
  CHECK(selected({"accelerator"}) == "3:0");
  CHECK(selected({"all"}) == "0:0 0:1 2:0 3:0");
  CHECK(selected({"PTHREAD"}) == "0:1");
  CHECK(selected({"portable"}) == "0:0 0:1");
  CHECK(selected({"language/basic"}) == "0:0");
  CHECK(selected({"4090/d"}) == "2:0");
}

TEST_CASE("SPECs add up in their order, without doubles") {
  CHECK(selected({"gpu", "cpu"}) == "2:0 0:0 0:1");
  CHECK(selected({"0:1", "cpu"}) == "0:1 0:0");
  CHECK(selected({"0:1", "0:1"}) == "0:1");
  CHECK(selected({"0:1/2", "cpu"}) == "0:1/2 0:0");  // the first to name a device says how much of it
}

TEST_CASE("!SPEC takes away, wherever it stands; alone, from all") {
  CHECK(selected({"cpu", "!basic"}) == "0:1");
  CHECK(selected({"!basic", "cpu"}) == "0:1");
  CHECK(selected({"!cpu"}) == "2:0 3:0");
  CHECK(selected({"!0:0", "!gpu"}) == "0:1 3:0");
  CHECK_THROWS_AS(selected({"cpu", "!all"}), DeviceError);
}

TEST_CASE("/N asks for a sub-device of N compute units, whose estimate shrinks with it") {
  CHECK(selected({"0:1/4"}) == "0:1/4");
  const auto chosen = select_devices(machine(), {"pthread/2"});
  REQUIRE(chosen.size() == 1);
  CHECK(chosen[0].sub_units == 2);
  CHECK(chosen[0].estimate == Approx(200));
  CHECK_THROWS_WITH(selected({"0:1/9"}), ContainsSubstring("8 compute units"));
  CHECK_THROWS_WITH(selected({"2:0/4"}), ContainsSubstring("cannot be split"));
  CHECK_THROWS_AS(selected({"0:1/0"}), UsageError);
  CHECK_THROWS_AS(selected({"!0:1/2"}), UsageError);
}

TEST_CASE("/N again takes the next units of the device while it has them") {
  CHECK(selected({"0:1/3", "0:1/3"}) == "0:1/3 0:1/3@3");
  const auto chosen = select_devices(machine(), {"0:1/1", "0:1/5", "0:1/2"});
  REQUIRE(chosen.size() == 3);
  CHECK(chosen[1].first_unit == 1);
  CHECK_FALSE(chosen[1].shares_cores());
  CHECK(chosen[2].first_unit == 6);
  CHECK_THROWS_WITH(selected({"0:1/5", "0:1/4"}), ContainsSubstring("of which 5 are already taken"));
  CHECK_THROWS_WITH(selected({"0:1", "0:1/4"}), ContainsSubstring("already taken as a whole"));
}

TEST_CASE("/N takes the devices that can give N units, and warns of the others") {
  std::vector<std::string> warnings;
  const auto labels = [&](const std::vector<std::string>& specs) {
    std::string text;
    for (const DeviceInfo& device : select_devices(machine(), specs, &warnings))
      text += device.label().substr(0, device.label().find(' ')) + " ";
    return text;
  };
  CHECK(labels({"cpu/1"}) == "0:1/1 ");
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], ContainsSubstring("the device spec cpu/1: 0:0 Portable") &&
                              ContainsSubstring("cannot be split: drop the /1; it is left out"));
  CHECK(labels({"cpu/1", "!basic"}) == "0:1/1 ");
  CHECK(warnings.empty());
  CHECK(labels({"cpu/8"}) == "0:0 0:1/8 ");  // all of what cannot be split is the device itself
  CHECK(warnings.empty());
  CHECK_THROWS_WITH(labels({"cpu/9"}), ContainsSubstring("0:0 Portable") && ContainsSubstring("; ") &&
                                           ContainsSubstring("0:1 Portable"));
}

TEST_CASE("a SPEC that means nothing is refused with the candidates and what is wrong with them") {
  CHECK_THROWS_AS(selected({""}), UsageError);
  CHECK_THROWS_AS(selected({"!"}), UsageError);
  CHECK_THROWS_AS(selected({"/2"}), UsageError);
  CHECK_THROWS_AS(selected({"9:0"}), DeviceError);
  CHECK_THROWS_AS(selected({"0:99999999999999999999"}), DeviceError);
  CHECK_THROWS_AS(selected({"1:0"}), DeviceError);
  CHECK_THROWS_WITH(selected({"radeon"}), ContainsSubstring("radeon") && ContainsSubstring("0:1 Portable") &&
                                              ContainsSubstring("no compiler"));
  CHECK_THROWS_WITH(selected({"0:0,0:1"}), ContainsSubstring("several are chosen by several specs"));
  CHECK_THROWS_WITH(selected({"radeon"}), !ContainsSubstring("several"));
  CHECK_THROWS_AS(selected({"2:1"}), DeviceError);            // found, but of no use
  CHECK_THROWS_AS(selected({"cpu", "radeon"}), DeviceError);  // one of several
  CHECK_THROWS_WITH(select_devices({}, {}), ContainsSubstring("no OpenCL platform"));
}

TEST_CASE("rows that are not usable match as the others do") {
  const auto unusable = [](const std::vector<std::string>& specs) {
    std::string text;
    for (const DeviceInfo& device : unusable_devices(machine(), specs)) text += device.place() + " ";
    return text;
  };
  CHECK(unusable({"all"}) == "1:-1 2:1 ");
  CHECK(unusable({"gpu"}) == "2:1 ");
  CHECK(unusable({"all", "!clover"}) == "2:1 ");
  CHECK(unusable({"cpu"}).empty());
  CHECK(unusable({}).empty());
}

TEST_CASE("the default is the usable device estimated fastest") { CHECK(selected({}) == "2:0"); }

TEST_CASE("an emulated device is never estimated faster than a native one") {
  DeviceInfo pocl = row(0, 0, "", "", "cpu", 0, 2);
  pocl.clock_mhz = 2600;
  pocl.native_vector_width = 4;
  pocl.cache = 32 << 20;
  DeviceInfo llvmpipe =
      row(0, 0, "", "", "cpu", 0, 64);  // what rusticl reports: units without end, one lane, no cache
  llvmpipe.clock_mhz = 300;
  llvmpipe.native_vector_width = 1;
  DeviceInfo scalar = pocl;  // an honest CPU without vectors
  scalar.native_vector_width = 1;
  for (const unsigned threads : {1u, 2u, 64u, 256u}) {
    pocl.compute_units = scalar.compute_units = threads;
    CHECK(estimate_speed(pocl, threads) > 100 * estimate_speed(llvmpipe, threads));
    CHECK(estimate_speed(scalar, threads) > 100 * estimate_speed(llvmpipe, threads));
  }
  pocl.clock_mhz = 0;  // as in many virtual machines
  CHECK(estimate_speed(pocl, 2) > estimate_speed(llvmpipe, 2));
  DeviceInfo gpu = row(0, 0, "", "", "gpu", 0, 128);
  gpu.clock_mhz = 2000;
  gpu.native_vector_width = 1;
  CHECK(estimate_speed(gpu, 2) > estimate_speed(pocl, 2));
}

TEST_CASE("a device is put in a class by its type and its vectors") {
  CHECK(device_class(row(0, 0, "", "", "cpu", 0)) == DeviceClass::cpu);
  CHECK(device_class(row(0, 0, "", "", "gpu", 0)) == DeviceClass::gpu);
  DeviceInfo vectors = row(0, 0, "", "", "accelerator", 0);
  CHECK(device_class(vectors) == DeviceClass::gpu);
  vectors.native_vector_width = 8;
  CHECK(device_class(vectors) == DeviceClass::cpu);
}

TEST_CASE("an exclusion that takes nothing away is refused with the devices that exist, unless it says ?") {
  CHECK(selected({"cpu", "gpu", "!0:0", "!geforce", "!broken"}) == "0:1");
  CHECK_THROWS_AS(selected({"all", "!7:0"}), DeviceError);
  CHECK_THROWS_WITH(selected({"all", "!radeon"}), ContainsSubstring("!radeon: takes nothing away") &&
                                                      ContainsSubstring("'!radeon?'") &&
                                                      ContainsSubstring("2:0 NVIDIA CUDA / GeForce 4090/D"));
  CHECK(selected({"gpu", "!radeon?"}) == "2:0");
  CHECK(selected({"cpu", "!basic?"}) == "0:1");
  CHECK_THROWS_AS(selected({"!?"}), UsageError);
}

TEST_CASE("devices are found by the names that people use for their drivers and makers") {
  std::vector<DeviceInfo> rows = {row(0, 0, "Portable Computing Language", "cpu-haswell", "cpu", 1),
                                  row(1, 0, "rusticl", "llvmpipe (LLVM 15.0.6, 256 bits)", "cpu", 1),
                                  row(2, 0, "NVIDIA CUDA", "Tesla T4", "gpu", 1),
                                  row(3, 0, "Some Platform", "UHD Graphics", "gpu", 1),
                                  row(4, 0, "Some Other", "gfx1100", "gpu", 1)};
  rows[3].vendor = "Intel(R) Corporation";
  rows[4].vendor = "Advanced Micro Devices, Inc.";
  const auto platforms = [&](const std::string& spec) {
    std::string text;
    for (const DeviceInfo& device : select_devices(rows, {spec})) text += std::to_string(device.platform);
    return text;
  };
  CHECK(platforms("pocl") == "0");
  CHECK(platforms("!PoCL") == "1234");
  CHECK(platforms("rusticl") == "1");
  CHECK(platforms("llvmpipe") == "1");
  CHECK(platforms("nvidia") == "2");
  CHECK(platforms("Intel") == "3");
  CHECK(platforms("amd") == "4");
}

TEST_CASE("a number alone is no device, whatever has it in its name: the error lists the indices") {
  for (const std::string spec : {"1", "0", "4090", "4090/2"}) {
    CAPTURE(spec);
    CHECK_THROWS_AS(selected({spec}), DeviceError);
    CHECK_THROWS_WITH(selected({spec}),
                      ContainsSubstring("a number alone means no device, an index P:D does") &&
                          ContainsSubstring("0:1 Portable"));
  }
  CHECK_THROWS_AS(selected({"all", "!1"}), DeviceError);
}

TEST_CASE("the default is reported with its estimate and those it was preferred to") {
  const auto rows = machine();
  const std::string text = choice_text(rows, select_devices(rows, {}).front());
  CHECK_THAT(text, ContainsSubstring("2:0 NVIDIA CUDA / GeForce 4090/D (estimate 90000), before 0:0"));
  CHECK_THAT(text, ContainsSubstring("pthread-skylake (800)") && !ContainsSubstring("Broken GPU"));
}

TEST_CASE("devices with vectors trace wide, all others a ray a lane") {
  DeviceInfo device;
  device.native_vector_width = 8;
  CHECK(wants_vectors(device));
  device.native_vector_width = 1;  // an emulated device
  CHECK_FALSE(wants_vectors(device));
  device.native_vector_width = 8;
  device.device_class = DeviceClass::gpu;
  CHECK_FALSE(wants_vectors(device));
}
