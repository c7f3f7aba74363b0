// bench/gpu.sh on a small model and PoCL: what it leaves behind, and that one part's failure does not stop
// it.
#include <nlohmann/json.hpp>

#include "base/file.h"
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
  options.environment["SUNDOG_BUILD"] = fs::path(SUNDOG_BINARY).parent_path().string();
  options.timeout = 1800;
  std::vector<std::string> command{SUNDOG_SOURCE_DIR "/bench/gpu.sh"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_command(command, options);
}

}  // namespace

TEST_CASE("gpu.sh leaves tables, figures and build logs of every part, and says what is missing") {
  const TemporaryFolder folder;
  const std::string model = folder.write("ball.obj", octahedron).string();
  const CommandResult result =
      gpu_script({"--device", "portable", "--quick", "--seconds", "1800", (folder / "out").string(), model});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  for (const char* part : {"devices", "pictures", "builds", "spheres-frames"}) {
    CAPTURE(part);
    CHECK_THAT(result.out, ContainsSubstring(std::string("there:   ") + part + "\n"));
    CHECK_FALSE(read_file(folder / "out" / (std::string(part) + ".txt")).empty());
  }
  for (const char* part : {"ball-rays-0", "ball-rays-1", "ball-rays-2", "ball-rays-wide", "workgroup",
                           "roofline", "spheres-kernels", "cornell_path-kernels"}) {
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
  const json kernels = json::parse(read_file(folder / "out" / "spheres-kernels.json"));
  for (const json& row : kernels.at("measurements"))  // logs are kept, and the cache is used all the same
    CHECK((row.at("time_ms").at("median") > 0 && row.at("build_warm_ms").at("median") > 0));
  CHECK_THAT(read_file(folder / "out" / "builds.txt"), ContainsSubstring("spheres warm: "));
  CHECK_THAT(read_file(folder / "out" / "spheres-frames.txt"), ContainsSubstring(" Msamples/s\n"));
  CHECK_THAT(result.out, ContainsSubstring("ball-embree") && ContainsSubstring("ball-tinybvh"));
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
  CHECK_THAT(result.out, ContainsSubstring("missing: devices: the 0 seconds were over\n"));
}

TEST_CASE("gpu.sh says how it is called") {
  CHECK(gpu_script({}).status == 2);
  CHECK(gpu_script({"--fast", "a", "b"}).status == 2);
}
