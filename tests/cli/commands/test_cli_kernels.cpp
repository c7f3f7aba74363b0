// sundog kernels: plain kernel files, in lanes.
#include "base/file.h"
#include "catch.h"
#include "run_command.h"
#include "temporary_folder.h"

TEST_CASE("kernels lists the plain files, and prints one in lanes or what varies in it") {
  const CommandResult list = run_sundog({"kernels"});
  CHECK(list.status == 0);
  CHECK_THAT(list.out, ContainsSubstring("plain/pathtracer/roulette.cl\n"));
  const CommandResult made = run_sundog({"kernels", "plain/pathtracer/bounce.cl", "--lanes", "16"});
  CHECK(made.status == 0);
  CHECK_THAT(made.out,
             Catch::Matchers::StartsWith("#define LANES 16\n") && ContainsSubstring("MASK survives("));
  const CommandResult told = run_sundog({"kernels", "plain/pathtracer/bounce.cl", "--explain"});
  CHECK_THAT(told.out, ContainsSubstring("worth varies: line "));
  // A lobe's file has helpers alone.
  const CommandResult helper = run_sundog({"kernels", "plain/shade/lobes/highlight.cl"});
  CHECK_THAT(helper.out, ContainsSubstring("share_highlight("));
}

TEST_CASE("kernels takes a file of one's own, and refuses it at its place") {
  const TemporaryFolder folder;
  folder.write("mine.cl", "ENTRY static float f(float x) {\n  return x * 2.0;\n}\n");
  const CommandResult refused = run_sundog({"kernels", (folder / "mine.cl").string()});
  CHECK(refused.status == 5);
  CHECK_THAT(refused.err, ContainsSubstring("mine.cl:2:14: 2.0 is a double: write 2.0f"));
  folder.write("mine.cl", "ENTRY static float f(float x) {\n  return x * 2.0f;\n}\n");
  const CommandResult made = run_sundog({"kernels", (folder / "mine.cl").string()});
  CHECK(made.status == 0);
  CHECK_THAT(made.out, ContainsSubstring("return (x * 2.0f);"));
  CHECK(run_sundog({"kernels", "plain/none.cl"}).status != 0);
  CHECK(run_sundog({"kernels", (folder / "none.cl").string()}).status == 3);
  CHECK(run_sundog({"kernels", "--lanes", "3"}).status == 2);
}

TEST_CASE("kernels writes a scene's programs as a GPU of a maker gets them, without a device") {
  const TemporaryFolder folder;
  const std::string out = (folder / "programs").string();
  const CommandResult made = run_sundog(
      {"kernels", "--scene", SUNDOG_SOURCE_DIR "/scenes/cornell_path.json", "--gpu", "nvidia", "--out", out});
  CHECK(made.status == 0);
  CHECK_THAT(made.out, ContainsSubstring(out + "/render_path.cl -cl-std=CL1.2") &&
                           ContainsSubstring(out + "/trace_rays.cl "));
  const std::string text = sundog::read_file(out + "/render_path.cl");
  CHECK_THAT(text, ContainsSubstring("#define DEVICE_HAS_FMA 1\n") &&
                       ContainsSubstring("#define LANES 1\n") &&
                       ContainsSubstring("__kernel FOR_WAVES(0) void render_path("));
  const CommandResult unknown = run_sundog(
      {"kernels", "--scene", SUNDOG_SOURCE_DIR "/scenes/cornell_path.json", "--gpu", "acme", "--out", out});
  CHECK(unknown.status == 2);
  CHECK_THAT(unknown.err, ContainsSubstring("acme: wanted nvidia, amd or intel"));
  CHECK(run_sundog({"kernels", "--gpu", "nvidia"}).status == 2);
}

TEST_CASE("a GPU's tracer alone gets fewer registers than its render kernels, each option once") {
  const TemporaryFolder folder;
  const auto options_of = [&](const std::string& gpu, const std::string& program) {
    const std::string out = (folder / gpu).string();
    const CommandResult made = run_sundog(
        {"kernels", "--scene", SUNDOG_SOURCE_DIR "/scenes/spheres.json", "--gpu", gpu, "--out", out});
    REQUIRE(made.status == 0);
    const std::size_t line = made.out.find(program);
    REQUIRE(line != std::string::npos);
    return made.out.substr(line, made.out.find('\n', line) - line);
  };
  CHECK_THAT(options_of("nvidia", "trace_rays.cl"), ContainsSubstring("=64") && !ContainsSubstring("=128"));
  CHECK_THAT(options_of("nvidia", "render_whitted.cl"),
             ContainsSubstring("=128") && !ContainsSubstring("=64"));
  CHECK_THAT(options_of("amd", "render_whitted.cl"), ContainsSubstring("-DDEVICE_WAVES=10"));
  CHECK_THAT(sundog::read_file((folder / "amd/render_whitted.cl").string()),
             ContainsSubstring("__kernel FOR_WAVES(0) void render_whitted(") &&
                 ContainsSubstring("amdgpu_waves_per_eu(DEVICE_WAVES + more)"));
}
