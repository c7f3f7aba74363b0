// The slim bundle (cmake/make_bundle.sh): a program with its libraries that runs from any folder.
#include <cstdio>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"
#include "occurrences.h"

namespace fs = std::filesystem;

namespace {

bool can_make_bundles() {
  if (run_command({"sh", "-c", "command -v patchelf && command -v zstd && command -v objdump"}).status == 0)
    return true;
  std::printf(
      "no patchelf, zstd or objdump here: the bundle is NOT tested (apt-get install binutils patchelf "
      "zstd)\n");
  return false;
}

struct Bundle : TemporaryFolder {
  fs::path archive = *this / "tried-slim.tar.zst", root = *this / "a folder/tried-slim",
           vendors = *this / "vendors";

  CommandResult make(std::map<std::string, std::string> environment) const {
    CommandOptions fast;
    environment.insert({{"BUNDLE_LEVEL", "1"},
                        {"BUNDLE_PICTURES", "none"},
                        {"BUNDLE_MEGABYTES", "100"},
                        {"BUNDLE_GLIBC", "9"}});
    fast.environment = std::move(environment);
    return run_command({SUNDOG_SOURCE_DIR "/cmake/make_bundle.sh", SUNDOG_BINARY, archive.string()}, fast);
  }
  void unpack() const {
    fs::create_directories(root.parent_path());
    REQUIRE(
        run_command({"tar", "-C", root.parent_path().string(), "--zstd", "-xf", archive.string()}).status ==
        0);
  }
  /// Runs the program without variables.
  CommandResult run(const fs::path& program, const std::vector<std::string>& arguments,
                    const std::string& more = "NOTHING=") const {
    std::vector<std::string> command{
        "env", "-i", "PATH=/usr/bin:/bin", "HOME=" + path().string(), more, program.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_command(command);
  }
  /// The platforms and devices with these drivers instead of the machine's.
  std::string devices(const std::vector<std::string>& drivers, const std::string& more = "NOTHING=") const {
    fs::remove_all(vendors);
    fs::create_directory(vendors);
    for (const std::string& driver : drivers)
      write("vendors/" + fs::path(driver).stem().string() + ".icd", driver + "\n");
    const CommandResult result = run(root / "sundog", {"devices"}, more);
    CHECK(result.status == 0);
    return result.out;
  }
};

}  // namespace

TEST_CASE("a bundle runs from another folder, from a link and without any setting") {
  if (!can_make_bundles()) return;
  const Bundle bundle;
  const CommandResult made = bundle.make({});
  CAPTURE(made.err);
  REQUIRE(made.status == 0);
  bundle.unpack();
  const std::string scene = (bundle.root / "scenes/spheres.json").string();
  fs::create_symlink(bundle.root / "sundog", bundle / "link");
  for (const fs::path& start : {bundle.root / "sundog", bundle / "link"}) {
    const CommandResult info = bundle.run(start, {"info", scene});
    CAPTURE(start, info.err);
    CHECK(info.status == 0);
    CHECK_THAT(info.out, ContainsSubstring("instances"));
  }
  const std::string picture = (bundle / "bundle.png").string(), expected = (bundle / "expected.png").string();
  const CommandResult drawn =
      bundle.run(bundle.root / "sundog", {"render", scene, "--size", "16x12", "-q", "-o", picture});
  CAPTURE(drawn.err);
  CHECK(drawn.status == 0);
  CHECK(bundle.run(SUNDOG_BINARY, {"render", scene, "--size", "16x12", "-q", "-o", expected}).status == 0);
  CHECK(sundog::read_file(picture) == sundog::read_file(expected));
  for (const char* file : {"bench/gpu.sh", "examples/report.ipynb"}) CHECK(fs::exists(bundle.root / file));
  CHECK_FALSE(fs::exists(bundle.root / "libexec"));
}

TEST_CASE("a bundle uses the machine's drivers, and its PoCL beside them if they have none") {
  if (!can_make_bundles()) return;
  const Bundle bundle;
  REQUIRE(bundle.make({}).status == 0);
  bundle.unpack();
  // The launcher of a bundle with PoCL, with other drivers than this machine's.
  fs::create_directories(bundle.root / "drivers");
  sundog::write_file(bundle.root / "drivers/pocl.icd", "libpocl.so.2\n");
  REQUIRE(run_command({"sed", "-i", "s|/etc/OpenCL/vendors|'" + bundle.vendors.string() + "'|",
                       (bundle.root / "sundog").string()})
              .status == 0);

  const std::string alone = bundle.devices({});
  CHECK(occurrences(alone, "Portable Computing Language") == 1);
  CHECK(occurrences(alone, "Fake") == 0);
  const std::string machines_pocl = bundle.devices({"libpocl.so.2", SUNDOG_FAKE_DRIVER});
  CHECK(occurrences(machines_pocl, "Portable Computing Language") == 1);
  CHECK(occurrences(machines_pocl, "Fake old") == 1);
  const std::string beside = bundle.devices({SUNDOG_FAKE_DRIVER});
  CHECK(occurrences(beside, "Fake old") == 1);
  CHECK_THAT(beside, ContainsSubstring("pthread-") && ContainsSubstring("[the default]"));
  CHECK(beside.find("Fake old") < beside.find("Portable Computing Language"));
  CHECK(beside == bundle.devices({SUNDOG_FAKE_DRIVER}));  // the folder of both is there already
  CHECK_THAT(bundle.devices({SUNDOG_FAKE_DRIVER}, "FAKE_DRIVER_GPU=1"),
             ContainsSubstring("large GPU  [the default]"));
}

TEST_CASE("a bundle's C++ library is used only where the machine's is older, as drivers may need that") {
  if (!can_make_bundles()) return;
  const Bundle bundle;
  REQUIRE(bundle.make({}).status == 0);
  bundle.unpack();
  sundog::write_file(bundle.root / "bin/sundog", "#!/bin/sh\necho \"libraries: $LD_LIBRARY_PATH\"\n");
  fs::permissions(bundle.root / "bin/sundog", fs::perms::owner_all);
  const fs::path folder = bundle.root / "lib/x86_64-linux-gnu/common/libstdc++.so.6";
  for (const std::string version : {"0.1", "0.9999"}) {
    fs::remove_all(folder);
    fs::create_directory(folder);
    sundog::write_file(folder / ("libstdc++.so.6." + version), "");
    fs::create_symlink("libstdc++.so.6." + version, folder / "libstdc++.so.6");
    CAPTURE(version);
    const std::string libraries = bundle.run(bundle.root / "sundog", {}).out;
    CHECK_THAT(libraries, ContainsSubstring("libraries: "));
    CHECK(occurrences(libraries, "/libstdc++.so.6") == (version == "0.1" ? 0 : 1));
  }
}

TEST_CASE("a bundle that is too large or needs too new a system is not made") {
  if (!can_make_bundles()) return;
  const Bundle bundle;
  const CommandResult large = bundle.make({{"BUNDLE_MEGABYTES", "1"}});
  CAPTURE(large.err);
  CHECK(large.status == 1);
  CHECK_THAT(large.err,
             ContainsSubstring("larger than 1 MB. The largest files: ") && ContainsSubstring(" bin/sundog"));
  const CommandResult recent = bundle.make({{"BUNDLE_GLIBC", "2.2.5"}});
  CAPTURE(recent.err);
  CHECK(recent.status == 1);
  CHECK_THAT(recent.err, ContainsSubstring("needs glibc 2.") && ContainsSubstring("wanted 2.2.5 or older"));
  CHECK_FALSE(fs::exists(bundle.archive));
}
