// bench/gpu.sh on a small model and PoCL: what it leaves behind, how it compares pictures, and that a part
// that fails or hangs does not stop it.
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/file.h"
#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

namespace fs = std::filesystem;
using nlohmann::json;
using sundog::read_file;

namespace {

constexpr const char* octahedron =
    "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

CommandResult gpu_script(const std::vector<std::string>& arguments, const CommandOptions& more = {}) {
  CommandOptions options = more;
  options.environment.insert({"SUNDOG_BUILD", fs::path(SUNDOG_BINARY).parent_path().string()});
  options.timeout = 1800;
  std::vector<std::string> command{SUNDOG_SOURCE_DIR "/bench/gpu.sh"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_command(command, options);
}

void write_program(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  sundog::write_file(file, "#!/bin/bash\n" + text + "\n");
  fs::permissions(file, fs::perms::owner_all);
}

}  // namespace

TEST_CASE("gpu.sh leaves tables, figures and build logs of every part, and says what is missing") {
  const TemporaryFolder folder;
  const std::string model = folder.write("ball.obj", octahedron).string();
  const CommandResult result =
      gpu_script({"--device", "portable", "--quick", "--seconds", "1800", (folder / "out").string(), model});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  for (const char* part : {"devices", "pictures", "spheres-whitted-frames", "spheres-path-frames",
                           "cornell_path-whitted-frames", "registers"}) {
    CAPTURE(part);
    CHECK_THAT(result.out, ContainsSubstring(std::string("there:   ") + part + "\n"));
    CHECK_FALSE(read_file(folder / "out" / (std::string(part) + ".txt")).empty());
  }
  for (const char* part : {"ball-rays-0", "ball-rays-1", "ball-rays-2", "ball-rays-wide", "workgroup",
                           "roofline", "spheres-builds", "cornell_path-builds"}) {
    CAPTURE(part);
    CHECK_THAT(result.out, ContainsSubstring(std::string("there:   ") + part + "\n"));
    const json report = json::parse(read_file(folder / "out" / (std::string(part) + ".json")));
    CHECK_FALSE(report.at("measurements").empty());
  }
  for (const std::string way : {"0", "1", "2", "wide"}) {
    const json report = json::parse(read_file(folder / "out" / ("ball-rays-" + way + ".json")));
    for (const json& row : report.at("measurements"))
      CHECK(row.at("tracer") == (way == "wide" ? "wide" : "compact"));
  }
  const json kernels = json::parse(read_file(folder / "out" / "spheres-builds.json"));
  for (const json& row : kernels.at("measurements"))  // logs are kept, and the cache is used all the same
    CHECK((row.at("time_ms").at("median") > 0 && row.at("build_warm_ms").at("median") > 0));
  CHECK_THAT(read_file(folder / "out" / "registers.txt"),
             ContainsSubstring("spheres trace_rays: registers "));
  CHECK_THAT(read_file(folder / "out" / "spheres-path-frames.txt"), ContainsSubstring(" Msamples/s\n"));
  CHECK_THAT(result.out, ContainsSubstring("embree") && ContainsSubstring("tinybvh"));
  CHECK(result.out == read_file(folder / "out" / "summary.txt"));
  std::size_t logs = 0;
  for (const auto& file : fs::directory_iterator(folder / "out" / "build_logs"))
    logs += read_file(file.path()).find("== log ==") != std::string::npos;
  CHECK(logs >= 6);  // frames, AOVs and rays, of both integrators
}

TEST_CASE("gpu.sh continues when parts fail, and names them") {
  const TemporaryFolder folder;
  const CommandResult result = gpu_script(
      {"--device", "no such device", "--quick", (folder / "out").string(), (folder / "none.obj").string()});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 1);
  CHECK_THAT(result.out, ContainsSubstring("there:   devices\n") &&
                             ContainsSubstring("failed:  none-rays-0 (status 4)") &&
                             ContainsSubstring("failed:  workgroup (status 4)"));
}

TEST_CASE("gpu.sh leaves out what would begin after its time, and says so") {
  const TemporaryFolder folder;
  const CommandResult result =
      gpu_script({"--device", "portable", "--quick", "--seconds", "0", (folder / "out").string()});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("missing: devices: its share of the 0 seconds was over"));
}

TEST_CASE("gpu.sh ends in its time though every program hangs and ignores SIGTERM, and gets to the rays") {
  const TemporaryFolder folder;
  write_program(folder / "build/sundog", "[[ $1 == devices ]] && exit\necho $$ >>'" + folder.path().string() +
                                             "/processes'\ntrap '' TERM\nsleep 1000\nsleep 1000");
  CommandOptions options;
  options.environment["SUNDOG_BUILD"] = (folder / "build").string();
  const CommandResult result =
      gpu_script({"--seconds", "60", (folder / "out").string(), "ball.obj"}, options);
  CAPTURE(result.out, result.err);
  CHECK(result.status == 1);
  CHECK(result.seconds < 61);
  CHECK_THAT(result.out, ContainsSubstring("there:   devices\n") &&
                             ContainsSubstring("failed:  check (status 137): took longer than 10 s\n") &&
                             ContainsSubstring("failed:  ball-rays-0 (status 137): took longer than ") &&
                             ContainsSubstring("missing: roofline: its share of the 60 seconds was over"));
  std::istringstream processes(read_file(folder / "processes"));
  for (pid_t process = 0; processes >> process;) CHECK(::kill(process, 0) != 0);
}

TEST_CASE("gpu.sh counts the pixels that differ from the bundle's pictures") {
  const TemporaryFolder bundle;
  fs::create_directories(bundle / "bench");
  fs::create_directories(bundle / "pictures");
  fs::copy(SUNDOG_SOURCE_DIR "/bench/gpu.sh", bundle / "bench");
  fs::copy(SUNDOG_SOURCE_DIR "/scenes", bundle / "scenes", fs::copy_options::recursive);
  write_program(bundle / "bin/sundog", "");
  write_program(bundle / "sundog",  // what times nothing, to save time
                "case \"$*\" in *--stats*) exit 3 ;; devices*|render*|compare*) exec " SUNDOG_BINARY
                " \"$@\" ;; esac\nexit 3");
  const std::string cornell = (bundle / "pictures/cornell_path.png").string();
  for (const std::string scene : {"cornell_path", "spheres"})
    REQUIRE(run_sundog({"render", (bundle / ("scenes/" + scene + ".json")).string(), "--device", "portable",
                        "--size", "64x64", "-q", "-o", (bundle / ("pictures/" + scene + ".png")).string()})
                .status == 0);
  sundog::Image other = sundog::read_image_in_file(cornell).image;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 5; ++x)
      for (int c = 0; c < 3; ++c) other.pixel(x, y)[c] = other.pixel(x, y)[c] > 0.5f ? 0.0f : 1.0f;
  sundog::write_image(other, cornell);
  const CommandResult result = run_command(
      {(bundle / "bench/gpu.sh").string(), "--device", "portable", "--quick", (bundle / "out").string()});
  CAPTURE(result.out, result.err);
  CHECK_THAT(result.out, ContainsSubstring("there:   pictures\n"));
  const std::string table = read_file(bundle / "out/pictures.txt");
  CHECK_THAT(table, ContainsSubstring("spheres: pixels over 0.02  0 of 4096 (0 %)\n") &&
                        ContainsSubstring("cornell_path: pixels over 0.02  40 of 4096 "));
}

TEST_CASE("gpu.sh says how it is called") {
  CHECK(gpu_script({}).status == 2);
  CHECK(gpu_script({"--fast", "a", "b"}).status == 2);
}
