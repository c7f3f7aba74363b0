// Ctrl-C and the progress bar, on a terminal of the test's own.
#include <base/image_io.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

/// A render that takes much longer than the test waits.
std::vector<std::string> long_render(const CliFolder& folder, const std::string& out) {
  return {"render",  folder.scene, "-o",   folder.file(out), "--size",
          "640x480", "--samples",  "2000", "--tile",         "16"};
}

CommandOptions on_terminal() {
  CommandOptions options;
  options.terminal = true;
  options.environment["TERM"] = "xterm";
  return options;
}

int dark_pixels(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* pixel = image.pixel(x, y);
      count += pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
    }
  return count;
}

}  // namespace

TEST_CASE("an interrupt saves the part that is done, with status 130") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP, SIGXCPU);
  const CliFolder folder;
  CommandOptions options = on_terminal();
  options.signal_at = "Mpixel/s";
  options.signal = signal;
  const CommandResult result = run_sundog(long_render(folder, "a.png"), options);
  CAPTURE(result.err);
  CHECK(result.status == 130);
  CHECK(result.err.find("sundog: interrupted: ") != std::string::npos);
  CHECK(result.err.find("% of the pixels are in " + folder.file("a.png")) != std::string::npos);
  const Image image = read_image(folder / "a.png");
  CHECK(image.width == 640);
  const int dark = dark_pixels(image);
  CHECK(dark > 0);
  CHECK(dark < 640 * 480);
  CHECK(folder.entries() == 2);
}

TEST_CASE(
    "a terminal that is closed, or the end of its processor time, costs a render nothing that is done") {
  const CliFolder folder;
  CommandOptions options = on_terminal();
  options.signal_at = "Mpixel/s";
  options.signal = GENERATE(SIGHUP, SIGXCPU);
  options.hang_up = true;  // twice, and nobody reads any more
  std::vector<std::string> command = long_render(folder, "a.png");
  command.insert(command.end(), {"--resume", folder.file("c")});
  const CommandResult result = run_sundog(command, options);
  CHECK_FALSE(result.timed_out);
  CHECK(result.status < 128 + 2 + 1);  // no signal ended it
  const int dark = dark_pixels(read_image(folder / "a.png"));
  CHECK(dark > 0);
  CHECK(dark < 640 * 480);
  CHECK(std::filesystem::exists(folder / "c"));
}

TEST_CASE("under nohup a closed terminal does not end a render") {
  const CliFolder folder;
  const CommandResult result = run_command({"sh", "-c",
                                            R"(trap '' HUP; "$0" render "$1" -o "$2" --samples 64 &)"
                                            " kill -HUP $!; sleep 0.2; kill -HUP $!; wait $!",
                                            SUNDOG_BINARY, folder.scene, folder.file("a.png")});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("an interrupt while a kernel is compiled ends at once, and the picture that is there stays") {
  const CliFolder folder;
  folder.write("a.png", "a good picture");
  CommandOptions options;
  options.environment["XDG_CACHE_HOME"] = folder.file("cold");
  options.environment["SUNDOG_DUMP_KERNELS"] = folder.file("kernels");
  options.signal_folder = folder / "kernels";
  const std::vector<std::string> more = GENERATE(
      std::vector<std::string>{}, std::vector<std::string>{"--time-limit", "0.01", "--write-every", "0.01"});
  std::vector<std::string> command{"render", folder.scene, "-o", folder.file("a.png")};
  command.insert(command.end(), more.begin(), more.end());
  const CommandResult result = run_sundog(command, options);
  CAPTURE(result.err, result.seconds);
  CHECK(result.status == 130);
  CHECK(result.err ==
        "sundog: interrupted: no pixel was made; " + folder.file("a.png") + " is not written\n");
  CHECK(read_file(folder / "a.png") == "a good picture");
}

// The tile would take hours: an interrupt that waited for its end would not come back.
TEST_CASE("an interrupt in the middle of the first tile, which has no pixel, comes back and writes nothing") {
  const CliFolder folder;
  CommandOptions options;
  options.environment["SUNDOG_DUMP_KERNELS"] = folder.file("kernels");
  options.signal_folder = folder / "kernels";
  const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.exr"), "--samples",
                                           "65536", "--size", "4096x64", "--tile", "4096"},
                                          options);
  CAPTURE(result.err);
  CHECK(result.status == 130);
  CHECK(result.err ==
        "sundog: interrupted: no pixel was made; " + folder.file("a.exr") + " is not written\n");
  CHECK_FALSE(std::filesystem::exists(folder / "a.exr"));
}

// The scene's file is opened, and reading it never begins.
TEST_CASE("an interrupt while the scene is loaded ends the program at once, and says so") {
  const std::string signal = GENERATE("INT", "TERM");
  const CliFolder folder;
  CommandOptions options;
  options.folder = folder.path();
  options.environment["SUNDOG_FAULTS"] = "hold@scene.json";
  const CommandResult result =
      run_command({"sh", "-c",
                   "\"$0\" render scene.json -o a.png & "
                   "until ls -l /proc/$!/fd | grep -q scene.json; do sleep 0.02; done 2>/dev/null; "
                   "kill -$1 $!; wait $!",
                   SUNDOG_BINARY, signal},
                  options);
  CHECK(result.status == 130);
  CHECK(result.err == "sundog: interrupted: the frame was not yet begun; a.png is not written\n");
  CHECK_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_CASE("a driver that has signal handlers of its own does not get to see an interrupt") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const CliFolder folder;
  folder.write("vendors/pocl.icd", "libpocl.so.2\n");
  folder.write("vendors/fake.icd", SUNDOG_FAKE_DRIVER "\n");
  CommandOptions options;
  options.environment = {{"OCL_ICD_VENDORS", folder.file("vendors") + "/"},
                         {"FAKE_DRIVER_TAKES_SIGNALS", "1"},
                         {"SUNDOG_DUMP_KERNELS", folder.file("kernels")}};
  options.signal_folder = folder / "kernels";
  options.signal = signal;
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.exr"), "--device", "portable", "--samples",
                  "65536", "--size", "4096x64", "--tile", "4096"},
                 options);
  CHECK(result.status == 130);
  CHECK(result.err ==
        "sundog: interrupted: no pixel was made; " + folder.file("a.exr") + " is not written\n");
}

TEST_CASE("an interrupted render's AOVs are whole, and hold what is done of the image") {
  const CliFolder folder;
  const std::vector<std::string> aovs = {"--aov", "depth", "--aov", "normal"};
  std::vector<std::string> command = long_render(folder, "a.exr");
  command.insert(command.end(), aovs.begin(), aovs.end());
  CommandOptions options = on_terminal();
  options.signal_at = "Mpixel/s";
  const CommandResult result = run_sundog(command, options);
  CAPTURE(result.err);
  CHECK(result.status == 130);
  CHECK(result.err.find("% of the pixels are in " + folder.file("a.exr")) != std::string::npos);
  CHECK(folder.entries() == 2);
  // First surfaces are those of one sample, too.
  command[3] = folder.file("whole.exr");
  command[7] = "1";
  REQUIRE(run_sundog(command).status == 0);
  const Image image = read_image(folder / "a.exr");
  const AovImages parts = read_aovs(folder / "a.exr"), whole = read_aovs(folder / "whole.exr");
  REQUIRE(parts.size() == 2);
  const int dark = dark_pixels(image);
  CHECK(dark > 0);
  CHECK(dark < 640 * 480);
  for (const auto& [name, part] : parts) {
    const Image& all = whole.at(name);
    REQUIRE(part.data.size() == all.data.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < part.data.size(); ++i) {
      const std::size_t pixel = i / static_cast<std::size_t>(part.channels);
      const bool done = image.data[4 * pixel + 2] > 0;  // sky and floor are both bluish
      wrong += part.data[i] != (done ? all.data[i] : 0);
    }
    CAPTURE(name);
    CHECK(wrong == 0);
  }
}

// The interrupted render has one compute unit, so that it takes some seconds on any machine.
TEST_CASE("an interrupted render continues from its checkpoint to the same image and AOVs") {
  const CliFolder folder;
  const std::vector<std::string> end = {"--size", "128x96",  "--samples", "400",   "--tile",
                                        "16",     "--float", "--aov",     "depth", "--quiet"};
  const auto render = [&](const char* out, const char* device) {
    std::vector<std::string> command = {"render", folder.scene, "-o", folder.file(out), "--device", device};
    command.insert(command.end(), end.begin(), end.end());
    return command;
  };
  REQUIRE(run_sundog(render("whole.exr", "portable")).status == 0);
  std::vector<std::string> parts = render("parts.exr", "portable/1");
  parts.back() = "--resume";
  parts.push_back(folder.file("checkpoint"));
  CommandOptions options = on_terminal();
  options.signal_at = "Mpixel/s";
  const CommandResult first = run_sundog(parts, options);
  CAPTURE(first.err);
  REQUIRE(first.status == 130);
  CHECK(first.err.find("the same command continues from there") != std::string::npos);
  REQUIRE(std::filesystem::exists(folder / "checkpoint"));
  REQUIRE(run_sundog(parts).status == 0);
  CHECK(read_image(folder / "parts.exr").data == read_image(folder / "whole.exr").data);
  CHECK(read_aovs(folder / "parts.exr").at("depth").data == read_aovs(folder / "whole.exr").at("depth").data);
  CHECK_FALSE(std::filesystem::exists(folder / "checkpoint"));
}

TEST_CASE("the progress bar shows rate and time left, fits the terminal, and is gone at the end") {
  const CliFolder folder;
  const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--size",
                                           "200x150", "--samples", "1000", "--tile", "16"},
                                          on_terminal());
  REQUIRE(result.status == 0);
  CHECK(result.err.find("Mpixel/s") != std::string::npos);
  CHECK(result.err.find(" left") != std::string::npos);
  CHECK(result.err.ends_with("\r\033[K"));
  CHECK(result.err.find('\n') == std::string::npos);
  for (std::size_t at = 0; at < result.err.size();) {
    const std::size_t next = std::min(result.err.find('\r', at + 1), result.err.size());
    CHECK(next - at <= 1 + 79 + 3);  // the carriage return, the line, and the erasing of what is behind it
    at = next;
  }
  CHECK(result.seconds > 0);
  const auto drawings = std::count(result.err.begin(), result.err.end(), '\r');
  CHECK(static_cast<double>(drawings) <= 10 * result.seconds + 2);
}

TEST_CASE("there is no progress bar where stderr is not a terminal, or a dumb one") {
  const CliFolder folder;
  CommandOptions options;
  SECTION("a pipe") {}
  SECTION("a dumb terminal") {
    options.terminal = true;
    options.environment["TERM"] = "dumb";
  }
  const CommandResult result = run_sundog({"render", folder.scene, "-o", folder.file("a.png"), "--size",
                                           "200x150", "--samples", "100", "--tile", "16"},
                                          options);
  CHECK(result.status == 0);
  CHECK(result.err.empty());
}

TEST_CASE(
    "what a writer killed within a checkpoint has left is removed by the next run, not what one writes") {
  const CliFolder folder;
  CommandOptions options;
  options.folder = folder.path();
  const CommandResult result = run_command(
      {"sh", "-c",
       "mkdir kept; touch kept/c.1.tmp; "
       "SUNDOG_FAULTS=stall@c SUNDOG_CHECKPOINT_EVERY=0 \"$0\" render scene.json -o a.png --size 640x480 "
       "--samples 2000 --tile 16 --resume kept/c & "
       "until ls kept/c.*.*.*.tmp; do sleep 0.1; done >/dev/null 2>&1; sleep 0.1; "
       "\"$0\" render scene.json -o b.png --quiet --resume kept/c; ls kept | wc -l; "
       "kill -KILL $!; wait $!; ls kept | wc -l; "
       "\"$0\" render scene.json -o b.png --quiet --resume kept/c; ls kept",
       SUNDOG_BINARY},
      options);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.out == "2\n2\nc.1.tmp\n");
}
