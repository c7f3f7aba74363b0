// Bad command lines: exit status 2, one line on stderr that says what was wanted, nothing on stdout, no file.
#include <base/file.h>
#include <fmt/format.h>

#include <algorithm>

#include "catch.h"
#include "cli_scene.h"

namespace {

struct BadLine {
  std::vector<std::string> arguments;
  std::string says;
};

}  // namespace

TEST_CASE("a bad command line is one line on stderr and exit status 2") {
  const CliFolder folder;
  const std::string scene = folder.scene, out = folder.file("out.png");
  const std::vector<BadLine> lines = {
      {{""}, "found ''"},
      {{"frobnicate"}, "found 'frobnicate' (see sundog --help)"},
      {{"rendr", scene}, "found 'rendr': did you mean 'render'? (see sundog --help)"},
      {{"bench"},
       "wanted a benchmark (workgroup, threads, rays, samples, quality, textures, devices, kernels, "
       "roofline, compare), found none"},
      {{"bench", "speed"}, "found 'speed'"},
      {{"bench", "thraeds"}, "found 'thraeds': did you mean 'threads'? (see sundog bench --help)"},
      {{"bench", "threads"}, "SCENE is required (see sundog bench threads --help)"},
      {{"bench", "workgroup", scene, "--kernel", "magic"}, "--kernel magic: wanted one of render_whitted"},
      {{"bench", "workgroup", scene, "--kernel", "trace_ray"},
       "--kernel trace_ray: did you mean trace_rays?"},
      {{"bench", "threads", scene, "--counts", "0"}, "--counts 0: wanted a whole number from 1"},
      {{"bench", "threads", scene, "--sizes", "8,,9"}, "--sizes : wanted"},
      {{"bench", "devices", scene, "--size", "8"}, "--size 8: wanted WIDTHxHEIGHT"},
      {{"bench", "threads", scene, "--repeat", "0"}, "--repeat"},
      {{"bench", "threads", scene, "--set", "fov=3"}, "--set fov=3: wanted JSON_POINTER=VALUE"},
      {{"bench", "workgroup", scene, "--sizes", "99999x2"}, "each from 1 to 65536, auto or driver"},
      {{"bench", "rays", scene, "--svg", folder.file("a.pdf")},
       "a.pdf: wanted a file name that ends in .svg"},
      {{"tune", "--forget", "--show"}, "--forget, --show: one of them"},
      {{"halo", "-o", "-"}, "-o -: wanted the name of an image file"},
      {{"check", "--timeout", "0"}, "--timeout"},
      {{"render", "", "-o", out}, "a file's name is empty"},
      {{"render", scene, "-o", out, "--bits", "12"}, "--bits: 12 not in {8,16}"},
      {{"--frobnicate"}, "unknown option --frobnicate (see sundog --help)"},
      {{"--vresion"}, "unknown option --vresion: did you mean --version?"},
      {{"render"}, "SCENE is required (see sundog render --help)"},
      {{"render", scene}, "--out is required"},
      {{"render", scene, "-o"}, "--out"},
      {{"render", scene, "-o", out, "surplus"}, "unknown argument: surplus (see sundog render --help)"},
      {{"render", scene, "-o", out, "--spilt", "static"},
       "unknown option --spilt: did you mean --split? (see sundog render --help)"},
      {{"render", scene, "--ouput=x.png"}, "unknown option --ouput: did you mean --out?"},
      {{"render", scene, "-o", out, "-x"}, "unknown option -x (see sundog render --help)"},
      {{"render", scene, "-o", out, "-qx"}, "unknown option -x (see sundog render --help)"},
      {{"render", scene, "-o", out, "--split", "halves"}, "--split halves"},
      {{"render", scene, "-o", out, "--split", "1,-1"}, "--split 1,-1"},
      {{"render", scene, "-o", out, "--split", "0,0"}, "--split 0,0"},
      {{"render", scene, "-o", out, "--split", "1,2,3,4,5,6,7,8,9"}, "9 shares for "},
      {{"render", scene, "-o", folder.file("out")}, "no extension"},
      {{"render", scene, "-o", folder.file("out.gif")}, "found .gif"},
      {{"render", scene, "-o", out, "--format", "png"}, "--format is for -o -"},
      {{"render", scene, "-o", "-", "--format", "pgn"}, "--format pgn: did you mean png?"},
      {{"render", scene, "-o", "-", "--format", "gif"}, "--format gif: wanted one of png, jpg"},
      {{"render", scene, "-o", "-", "--aov", "depth"}, "only .exr files hold AOVs"},
      {{"render", scene, "-o", "-", "--stats", "-"}, "-: is the name of two outputs"},
      {{"render", scene, "-o", out, "--resume", "-"}, "--resume -: a checkpoint wants a file"},
      {{"render", scene, "-o", "-", "--frames", "1..2"}, "--frames writes numbered files"},
      {{"render", scene, "-o", out, "--aov", "depth"}, "only .exr files hold AOVs"},
      {{"render", scene, "-o", folder.file("out.exr"), "--aov", "beauty"},
       "--aov beauty: wanted one of diffuse_direct"},
      {{"render", scene, "-o", folder.file("out.exr"), "--aov", "nromal"},
       "--aov nromal: did you mean normal?"},
      {{"render", scene, "-o", out, "--size", "640"}, "--size 640: wanted WIDTHxHEIGHT"},
      {{"render", scene, "-o", out, "--size", "0x5"}, "--size 0x5"},
      {{"render", scene, "-o", out, "--size", "5x"}, "--size 5x"},
      {{"render", scene, "-o", out, "--size", "-5x5"}, "--size -5x5"},
      {{"render", scene, "-o", out, "--size", "99999x5"}, "to 65536"},
      {{"render", scene, "-o", out, "--size", "5x5x5"}, "--size 5x5x5"},
      {{"render", scene, "-o", out, "--samples", "0"}, "--samples 0: wanted a whole number from 1 to 65536"},
      {{"render", scene, "-o", out, "--samples", "1.5"}, "--samples 1.5"},
      {{"render", scene, "-o", out, "--samples", "many"}, "--samples many"},
      {{"render", scene, "-o", out, "--samples", "99999999999999999999"}, "--samples 9999"},
      {{"render", scene, "-o", out, "--max-depth", "65"}, "from 1 to 64"},
      {{"render", scene, "-o", out, "--max-depth", "-1"}, "--max-depth -1"},
      {{"render", scene, "-o", out, "--tile", "0"}, "--tile 0"},
      {{"render", scene, "-o", out, "--work-group", "0"}, "--work-group 0: wanted a size (64)"},
      {{"render", scene, "-o", out, "--work-group", "8x"}, "--work-group 8x"},
      {{"render", scene, "-o", out, "--work-group", "big"}, "auto or driver"},
      {{"render", scene, "-o", out, "--integrator", "magic"},
       "wanted \"whitted\" or \"path\", found the string \"magic\""},
      {{"render", scene, "-o", out, "--set", "fov=3"}, "--set fov=3: wanted JSON_POINTER=VALUE"},
      {{"render", scene, "-o", out, "--set", "/camera/fov"}, "wanted JSON_POINTER=VALUE"},
      {{"render", scene, "-o", out, "--set", "/camera/fov=190"},
       "/camera/fov: wanted a number above 0 and below 180"},
      {{"render", scene, "-o", out, "--set", "/camera/fvo=30"}, "unknown key \"fvo\""},
      {{"render", scene, "-o", out, "--set", "/objects/7/radius=1"},
       "the setting /objects/7/radius=1 leads nowhere"},
      {{"render", scene, "--stats", "-o", out}, "--stats wants a value (FILE), found the option -o"},
      {{"render", scene, "-o", out, "--samples", ""}, "--samples wants a value (N), found an empty text"},
      {{"render", scene, "--samples=", "-o", out}, "--samples wants a value (N), found an empty text"},
      {{"render", scene, "-o", out, "--size", "--quiet"},
       "--size wants a value (WxH), found the option --quiet"},
      {{"render", scene, "-o", out, "--device", "--isolate"},
       "--device wants a value (SPEC), found the option"},
      {{"bench", "rays", scene, "--json", "--csv", out},
       "--json wants a value (FILE), found the option --csv"},
      {{"tune", "--budget", "--show"}, "--budget wants a value (SECONDS), found the option --show"},
      {{"info"}, "SCENE is required (see sundog info --help)"},
      {{"info", scene, scene}, scene},
      {{"devices", "all"}, "all"},
      {{"compare", out}, "B is required"},
      {{"compare", out, out, "--tolerance", "-1"}, "--tolerance -1: wanted a number, 0 or more"},
      {{"compare", out, out, "--tolerance", "nan"}, "--tolerance nan"},
      {{"compare", out, out, "--tolerance", "1e-3x"}, "--tolerance 1e-3x"},
      {{"compare", out, out, "--diff", "diff.txt"}, "found .txt"},
  };
  for (const BadLine& line : lines) {
    const CommandResult result = run_sundog(line.arguments);
    CAPTURE(line.arguments, result.err);
    CHECK(result.status == 2);
    CHECK(result.out.empty());
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.find(line.says) != std::string::npos);
  }
  CHECK(folder.entries() == 1);
}

// A missing command is a usage error: nothing on stdout that a script could take for a result.
TEST_CASE("the program without a command prints a short help on stderr, with status 2") {
  const CommandResult result = run_sundog({});
  CHECK(result.status == 2);
  CHECK(result.out.empty());
  CHECK(std::ranges::count(result.err, '\n') <= 20);
  for (const char* says :
       {"sundog render SCENE -o OUT", "sundog check", "sundog --help", "sundog COMMAND --help"})
    CHECK(result.err.find(says) != std::string::npos);
}

TEST_CASE("help and version go to stdout with status 0") {
  const std::vector<std::vector<std::string>> lines = {{"--help"},
                                                       {"-h"},
                                                       {"--version"},
                                                       {"render", "--help"},
                                                       {"devices", "--help"},
                                                       {"info", "-h"},
                                                       {"compare", "--help"}};
  for (const auto& line : lines) {
    const CommandResult result = run_sundog(line);
    CAPTURE(line, result.err);
    CHECK(result.status == 0);
    CHECK(result.err.empty());
    CHECK(result.out.size() > 10);
  }
  const std::string version = run_sundog({"--version"}).out;
  for (const char* line : {"sundog ", "\nrevision ", "\ndevice ", ", driver "})
    CHECK(version.find(line) != std::string::npos);
}

TEST_CASE("the help of a command tells its options, and only of commands that exist") {
  const std::string render = run_sundog({"render", "--help"}).out;
  for (const char* option : {"--out", "--device", "--size", "--samples", "--max-depth", "--integrator",
                             "--filter", "--filter-radius", "--set", "--work-group", "--tile", "--stats",
                             "--aov", "--resume", "--quiet", "--verbose"})
    CHECK(render.find(option) != std::string::npos);
  const std::string all = run_sundog({"--help"}).out;
  for (const char* command : {"render", "devices", "info", "compare"})
    CHECK(all.find(command) != std::string::npos);
}

TEST_CASE("OpenCL C in a scene is refused unless it is allowed, and its errors name its lines") {
  const CliFolder folder;
  const auto scene = [&](const char* code) {
    return folder
        .write("native.json",
               fmt::format(R"({{"image": {{"width": 8, "height": 8}}, "camera": {{"position": [0, 0, 4],
          "target": [0, 0, 0], "fov": 20}}, "lights": [{{"type": "ambient"}}], "materials": {{"m": {{"ambient": 1}}}},
          "objects": [{{"type": "native", "code": ["{}"], "material": "m",
          "interval": {{"min": [-2, -2, -2], "max": [2, 2, 2]}}}}]}})",
                           code))
        .string();
  };
  const std::string good = scene("return length3(p) - 1.0f;"), out = folder.file("a.png");
  const CommandResult refused = run_sundog({"render", good, "-o", out});
  CHECK(refused.status == 3);
  CHECK(is_one_error_line(refused.err));
  CHECK(refused.err.find("--allow-native-code") != std::string::npos);
  CHECK(run_sundog({"render", good, "-o", out, "--allow-native-code"}).status == 0);
  const CommandResult wrong =
      run_sundog({"render", scene("return radius;"), "-o", out, "--allow-native-code"});
  CHECK(wrong.status == 5);
  CHECK(wrong.err.find("native code 0 of the scene") != std::string::npos);
}

TEST_CASE(
    "outputs that would write over an input or each other are refused before anything is read or written") {
  const CliFolder folder;
  const std::string text = sundog::read_file(folder.scene), out = folder.file("a.png");
  const std::string same = folder.path().string() + "/./a.png";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", folder.scene, "-o", out, "--stats", folder.scene},
        {"render", folder.scene, "-o", out, "--resume", folder.scene},
        {"render", folder.scene, "-o", out, "--stats", same},
        {"render", folder.scene, "-o", out, "--resume", same},
        {"bench", "samples", folder.scene, "--json", folder.scene},
        {"compare", folder.scene, out, "--diff", same},
        {"merge", out, folder.scene, "-o", same}}) {
    const CommandResult result = run_sundog(command);
    CAPTURE(command, result.err);
    CHECK(result.status == 2);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.find("another name") + result.err.find("two outputs") != 2 * std::string::npos);
  }
  CHECK(sundog::read_file(folder.scene) == text);
  CHECK(folder.entries() == 1);
}

// PoCL looks for its linker there, and ends the process where it finds none.
TEST_CASE("an environment without PATH costs nothing") {
  const CliFolder folder;
  CommandOptions options;
  options.environment = {{"PATH", ""}, {"XDG_CACHE_HOME", folder.file("cache")}, {"POCL_CACHE_DIR", ""}};
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--device", "portable"}, options);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.err.empty());
}
