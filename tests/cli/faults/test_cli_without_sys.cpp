// Where /sys is not mounted, as in a minimal chroot: PoCL would find no memory and end the process.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;

namespace {

const std::string hide = "mount -t tmpfs none /sys && eval \"$MORE\" && exec \"$@\"";

/// `unshare` with what it takes to hide /sys from a command: root's own right, else a user's own namespace.
/// Empty: this machine grants neither.
std::vector<std::string> hider() {
  for (const std::string flags : {"-m", "-Urm"}) {
    const std::vector<std::string> command = {"unshare", flags, "sh", "-c", hide, "sh"};
    std::vector<std::string> probe = command;
    probe.push_back("true");
    if (run_command(probe).status == 0) return command;
  }
  return {};
}

/// PoCL alone, without /sys.
struct Hidden {
  std::vector<std::string> command = hider();
  TemporaryFolder vendors;
  CommandOptions options;

  Hidden() {
    vendors.write("pocl.icd", "libpocl.so.2\n");
    options.environment["OCL_ICD_VENDORS"] = vendors.path().string() + "/";
    if (command.empty())
      std::printf("/sys cannot be hidden here (unshare -m, -Urm): not tested without it\n");
  }
  CommandResult run(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all = command;
    all.emplace_back(SUNDOG_BINARY);
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_command(all, options);
  }
};

}  // namespace

TEST_CASE("without /sys PoCL has its device, with the machine's processors and memory") {
  const Hidden hidden;
  if (hidden.command.empty()) return;
  const CommandResult result = hidden.run({"devices", "--json"});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json list = json::parse(result.out).at("devices");
  REQUIRE(list.size() == 1);
  CHECK(list[0].at("usable") == true);
  CHECK(list[0].at("compute_units") == std::thread::hardware_concurrency());
  const CommandResult beside = run_sundog({"devices", "--json"}, hidden.options);
  const json usual = json::parse(beside.out).at("devices").at(0);
  CHECK(list[0].at("compute_units") == usual.at("compute_units"));
  // PoCL leaves some to the system. Not what it has with /sys: a node there may lack memory that came later.
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  CHECK(list[0].at("global_memory").get<double>() <= memory);
  CHECK(list[0].at("global_memory").get<double>() > 0.6 * memory);
}

TEST_CASE("without /sys a picture has the bits that it has with it, and check names the mend") {
  Hidden hidden;
  if (hidden.command.empty()) return;
  const CliFolder folder;
  const CommandResult result = hidden.run({"render", folder.scene, "-o", folder.file("hidden.pfm")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("usual.pfm")}, hidden.options).status == 0);
  CHECK(sundog::read_file(folder / "hidden.pfm") == sundog::read_file(folder / "usual.pfm"));
  copy_frame_kernels(folder / "kernels");
  hidden.options.environment["SUNDOG_KERNEL_DIR"] = folder.file("kernels");
  const CommandResult check = hidden.run({"check"});
  CAPTURE(check.out);
  CHECK(check.status == 0);
  CHECK_THAT(check.out, ContainsSubstring("mount -t sysfs sysfs /sys"));
}

TEST_CASE("render --stats has the joules and watts that a processor's counter tells") {
  Hidden hidden;
  if (hidden.command.empty()) return;
  const CliFolder folder;
  // A counter as RAPL's, which goes up by a joule each time that a loop has written it.
  hidden.options.environment["MORE"] =
      "zone=/sys/class/powercap/intel-rapl:0; mkdir -p $zone; echo package-0 >$zone/name; "
      "echo 262143328850 >$zone/max_energy_range_uj; echo 0 >$zone/energy_uj; "
      "(i=0; while kill -0 $$ 2>/dev/null; do i=$((i + 1)); echo ${i}000000 >$zone/next; "
      "mv $zone/next $zone/energy_uj; sleep 0.01; done) >/dev/null 2>&1 &";
  const CommandResult result =
      hidden.run({"render", folder.scene, "-o", folder.file("a.png"), "--stats", folder.file("a.json")});
  CAPTURE(result.out, result.err);
  REQUIRE(result.status == 0);
  const json stats = json::parse(sundog::read_file(folder / "a.json")), &energy = stats.at("energy");
  CAPTURE(energy.dump());
  CHECK(energy.at("counted_by") == "RAPL package-0");
  const double joules = energy.at("joules"), seconds = joules / energy.at("watts").get<double>();
  CHECK((joules >= 1 && joules == std::floor(joules)));
  CHECK((seconds > 0 && seconds <= stats.at("seconds").at("total")));
}
