// Programs that are hard to come by: a cache that is damaged, a compiler's process that fails, a driver that
// builds without result.
#include <base/cache_folder.h>
#include <base/file.h>
#include <sched.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "catch.h"
#include "faulty_folder.h"

using namespace sundog;

namespace {

/// Where PoCL keeps for all of these tests what it has compiled: sundog's own cache is another.
const std::string& pocl_cache() {
  static const TemporaryFolder folder;
  static const std::string path = folder.path().string();
  return path;
}

struct BuildFolder : FaultyFolder {
  BuildFolder() {
    scene = write("least.json", least_scene).string();
    options.environment["POCL_CACHE_DIR"] = pocl_cache();
  }
};

}  // namespace

TEST_CASE("a kernel cache that is corrupt or cannot be written costs time only") {
  BuildFolder folder;
  const std::string plain = folder.plain();
  folder.options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  const std::vector<std::string> one = {"--device", "!0:0"};
  SECTION("corrupt") {
    REQUIRE(folder.render("", one).status == 0);
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "cache/sundog"))
      if (file.is_regular_file()) std::ofstream(file.path(), std::ios::in | std::ios::out).seekp(300) << "xx";
    REQUIRE(folder.render("", one).status == 0);
    CHECK(folder.stats()["kernels_cached"] == false);
    CHECK(read_file(folder / "a.pfm") == plain);
    REQUIRE(folder.render("", one).status == 0);
    CHECK(folder.stats()["kernels_cached"] == true);
  }
  SECTION("PoCL's own, at which it would abort") {
    folder.options.environment["POCL_CACHE_DIR"] = "";
    // A killed process's leftovers, in PoCL's own folder and in sundog's.
    for (const char* place : {"cache/pocl/kcache", "cache/sundog/pocl/killed"}) {
      CommandOptions user = folder.options;
      user.environment["POCL_CACHE_DIR"] = folder.file(place);
      make_cache_folder(folder / "cache/sundog/pocl");  // the user's alone at every umask
      std::filesystem::create_directories(folder / place);
      REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("b.pfm")}, user).status == 0);
      int files = 0;
      for (const auto& file : std::filesystem::recursive_directory_iterator(folder / place))
        if (file.path().extension() == ".bc" || file.path().extension() == ".so")
          std::ofstream(file.path(), std::ios::in | std::ios::out).seekp(20) << "xxxxxxxxxxxx", ++files;
      REQUIRE(files > 0);
    }
    folder.write("cache/sundog/pocl/killed/lock", "");
    for (const char* kernels : {"", "off"}) {
      folder.options.environment["SUNDOG_KERNEL_CACHE"] = kernels;
      CHECK(folder.render("", one).status == 0);
      CHECK(read_file(folder / "a.pfm") == plain);
    }
    CHECK(std::filesystem::is_empty(folder / "cache/sundog/pocl"));
  }
  SECTION("a file where the folder should be") {
    folder.write("cache", "");
    const CommandResult result = folder.render("", {"--device", "!0:0", "--verbose"});
    CHECK(result.status == 0);
    CHECK(contains(result.err, "warning: no kernel cache: "));
    CHECK(contains(result.err, "set XDG_CACHE_HOME"));
    CHECK_FALSE(contains(result.out, "no kernel cache: "));  // which has been reported
    CHECK(contains(folder.stats()["devices"][0]["notes"].at(0), "no kernel cache: "));
  }
  SECTION("a file where the folder should be that PoCL has no device without") {
    folder.write("cache", "");
    std::filesystem::create_directories(folder / "temporary");
    folder.options.environment["POCL_CACHE_DIR"] = "";
    folder.options.environment["TMPDIR"] = folder.file("temporary");
    CHECK(folder.render("", one).status == 0);
    CHECK(std::filesystem::is_empty(folder / "temporary"));
  }
  CHECK(read_file(folder / "a.pfm") == plain);
}

namespace {

/// Gives started processes one core: of two kernels that are compiled at once, one is in the compiler when
/// the other fails.
class OneCore {
 public:
  OneCore() {
    ::sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (std::size_t i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
      if (CPU_ISSET(i, &before_)) CPU_SET(i, &one);
    ::sched_setaffinity(0, sizeof one, &one);
  }
  ~OneCore() { ::sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_;
};

}  // namespace

TEST_CASE("where PoCL has no room to write, the message tells the folder and the mend") {
  const OneCore one_core;
  BuildFolder folder;
  std::filesystem::create_directories(folder / "temporary");
  folder.options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  folder.options.environment["POCL_CACHE_DIR"] = "";
  folder.options.environment["TMPDIR"] = folder.file("temporary");
  const std::vector<std::string> one = {"--device", "!0:0"};
  CommandResult result = folder.render("room=100@pocl", one);
  CAPTURE(result.err);
  CHECK(result.status == 5);
  CHECK(is_one_error_line(result.err));
  CHECK(contains(result.err, folder.file("temporary/sundog-pocl-")));
  CHECK(contains(result.err,
                 "has room for 100 KiB, and 3072 are needed: make room, or name another folder by "
                 "XDG_CACHE_HOME or TMPDIR"));
  CHECK(std::filesystem::is_empty(folder / "temporary"));

  folder.options.environment["POCL_CACHE_DIR"] = folder.file("temporary");
  result = folder.render("room=100@pocl", one);
  CHECK(result.status == 5);
  CHECK(contains(result.err, folder.file("temporary") + ", where PoCL writes"));
  CHECK(contains(result.err, "by POCL_CACHE_DIR"));

  folder.options.environment["POCL_CACHE_DIR"] = "";
  for (const char* name : {"XDG_CACHE_HOME", "TMPDIR"})
    folder.options.environment[name] = "/proc";  // where even root makes no folder
  result = folder.render("", one);
  CHECK(result.status == 4);
  CHECK(contains(result.err, "name one that can be written by XDG_CACHE_HOME or TMPDIR"));
}

TEST_CASE("where the cache cannot be written, Mesa keeps kernels among the temporary files") {
  // Without a folder Mesa says so, and compiles a kernel anew for each launch.
  CommandOptions options;
  options.environment["HOME"] = options.environment["XDG_CACHE_HOME"] = "/proc/nobody";
  options.environment["RUSTICL_ENABLE"] = "llvmpipe";
  const CommandResult result = run_sundog({"devices"}, options);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK_FALSE(contains(result.err, "shader cache"));
}

TEST_CASE(
    "a program of which the driver makes no kernels is built again without optimisation, and both logs are "
    "kept") {
  BuildFolder folder;
  folder.size = "32x24";
  folder.options.environment["SUNDOG_BUILD_LOG"] = folder.file("logs");
  const std::vector<std::string> one = {"--device", "!0:0"};
  CommandResult result = folder.render("kernels@0:1#1", one);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  std::vector<std::string> options;
  for (const auto& file : std::filesystem::directory_iterator(folder / "logs")) {
    std::istringstream lines(read_file(file.path()));
    for (std::string line; std::getline(lines, line) && !line.empty();)
      if (line.starts_with("options  ")) options.push_back(line);
  }
  REQUIRE(options.size() == 2);
  std::ranges::sort(options, {}, &std::string::size);
  CHECK(options[1] == options[0] + " -cl-opt-disable");

  result = folder.render("kernels@0:1", one);
  CHECK(result.status == 5);
  CHECK(contains(result.err, "the driver built it but makes no kernels of it"));
}

TEST_CASE("a program that was built without optimisation is not kept for the next run") {
  BuildFolder folder;
  folder.size = "32x24";
  folder.options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  const std::vector<std::string> one = {"--device", "!0:0"};
  REQUIRE(folder.render("compile@0:1,kernels@0:1#1", one).status == 0);
  CHECK(contains(folder.stats()["devices"][0]["notes"].at(0), "without optimisation"));
  for (const bool cached : {false, true}) {
    REQUIRE(folder.render("", one).status == 0);
    CHECK(folder.stats()["kernels_cached"] == cached);
  }
}

TEST_CASE(
    "a process that compiles beside the renderer, and one that fails at it, make no difference to the "
    "picture") {
  const CliFolder folder;
  CommandOptions options;
  std::vector<std::string> pictures;
  for (const std::string faults : {"", "compile@0:0"}) {
    options.environment["SUNDOG_FAULTS"] = faults;
    options.environment["XDG_CACHE_HOME"] = folder.file("cache" + faults);  // nothing is compiled yet
    const CommandResult result =
        run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"), "--device", "0:0"}, options);
    CAPTURE(faults, result.err);
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    pictures.push_back(read_file(folder / "a.pfm"));
  }
  CHECK(pictures[0] == pictures[1]);
}

TEST_CASE("a process that builds the kernel of photons, and one that is killed at it, make no difference") {
  const CliFolder folder;
  const std::string scene = folder.write("photons.json", R"({
    "camera": {"position": [0, 1, 5], "target": [0, 0, 0], "fov": 40},
    "image": {"width": 16, "height": 12},
    "render": {"integrator": "path", "caustics": true, "samples": 1},
    "lights": [{"type": "point", "position": [-3, 5, 4]}],
    "materials": {"floor": {"color": [0.8, 0.8, 0.8]}, "glass": {"type": "dielectric", "ior": 1.5}},
    "objects": [{"type": "plane", "point": [0, -1, 0], "material": "floor"},
                {"type": "sphere", "material": "glass"}]
  })");
  CommandOptions options;
  std::vector<std::string> pictures;
  const auto render = [&](const std::string& faults) {
    options.environment["SUNDOG_FAULTS"] = faults;
    const CommandResult result = run_sundog({"render", scene, "-o", folder.file("a.pfm"), "--device", "0:0",
                                             "--stats", folder.file("stats.json")},
                                            options);
    CAPTURE(faults, result.err);
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    pictures.push_back(read_file(folder / "a.pfm"));
    return nlohmann::json::parse(read_file(folder / "stats.json"));
  };
  options.environment["XDG_CACHE_HOME"] = folder.file("killed");
  render("kill@compile");
  options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  CHECK(render("")["kernels_cached"] == false);
  CHECK(render("")["kernels_cached"] == true);
  const std::filesystem::directory_iterator kernels(folder / "cache/sundog/kernels");
  CHECK(std::distance(begin(kernels), end(kernels)) == 2);
  CHECK(pictures[0] == pictures[1]);
  CHECK(pictures[0] == pictures[2]);
}
