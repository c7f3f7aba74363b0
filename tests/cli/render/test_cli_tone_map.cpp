// Tone mapping from the command line: files of 8 bits show it, others keep what was rendered.
#include <fmt/format.h>

#include <cmath>

#include "base/file.h"
#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

TEST_CASE("--exposure brightens a .png and leaves a .pfm and a merged part as rendered") {
  const CliFolder folder;
  const auto render = [&](const std::string& out, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", folder.scene, "-o", folder.file(out), "--device", "0:0"});
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
  };
  render("a.png", {});
  render("b.png", {"--exposure", "-1"});
  const Image plain = read_image(folder / "a.png"), darker = read_image(folder / "b.png");
  for (std::size_t i = 0; i < plain.data.size(); i += 4)
    if (plain.data[i] < 0.99f) CHECK(std::abs(darker.data[i] - plain.data[i] / 2) < 0.01f);
  render("a.pfm", {});
  render("b.pfm", {"--exposure", "-1", "--tone-map", "agx", "--white-balance", "3200"});
  CHECK(read_file(folder / "a.pfm") == read_file(folder / "b.pfm"));
  render("c.pfm", {"--exposure", "auto", "--contrast", "1.5", "--vignette", "0.5", "--bloom", "0.1"});
  CHECK(read_file(folder / "a.pfm") == read_file(folder / "c.pfm"));
  render("d.png", {"--contrast", "1", "--vignette", "0", "--bloom", "0"});
  CHECK(read_file(folder / "a.png") == read_file(folder / "d.png"));
  for (const char* option : {"--exposure=auto", "--contrast=1.5", "--vignette=0.5", "--bloom=0.1"}) {
    render("e.png", {option});
    CHECK(read_file(folder / "a.png") != read_file(folder / "e.png"));
  }
  render("a.part", {"--tiles", "1/1"});
  REQUIRE(
      run_sundog({"merge", folder.file("a.part"), "-o", folder.file("c.png"), "--exposure", "-1"}).status ==
      0);
  CHECK(read_file(folder / "c.png") == read_file(folder / "b.png"));
}

TEST_CASE("8 bits of .png are dithered: means stay, exact colours too, the same bits each time") {
  const CliFolder folder;
  const auto render = [&](const std::string& out, double level, std::vector<std::string> more) {
    // Nothing but the background, a colour that lies at `level` of the 255 steps from black to white.
    const std::string scene =
        folder
            .write(
                "flat.json",
                R"({"camera": {"position": [0, 0, 0], "target": [0, 0, -1]},
              "image": {"width": 32, "height": 32, "background": )" +
                    fmt::format("[{0}, {0}, {0}]", linear_from_srgb(float(level / 255))) +
                    R"(}, "materials": {"m": {}}, "objects": [{"type": "sphere", "center": [0, 0, 9], "material": "m"}]})")
            .string();
    more.insert(more.begin(), {"render", scene, "-o", folder.file(out), "--device", "0:0"});
    const CommandResult result = run_sundog(more);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    std::vector<double> levels;
    const Image image = read_image(folder / out);
    for (std::size_t i = 0; i < image.data.size(); ++i)
      if (i % 4 < 3) levels.push_back(std::round(255 * double(srgb_from_linear(image.data[i]))));
    return levels;
  };
  const std::vector<double> dark = render("a.png", 4.25, {});
  for (std::size_t y = 0; y < 32; y += 8)
    for (std::size_t x = 0; x < 32; x += 8)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (std::size_t k = 0; k < 64; ++k) {
          const double one = dark[3 * ((y + k / 8) * 32 + x + k % 8) + c];
          REQUIRE((one == 4 || one == 5));
          sum += one;
        }
        CHECK(sum / 64 == Approx(4.25).margin(0.08));
      }
  CHECK(render("b.png", 4.25, {}) == dark);
  for (const double one : render("c.png", 4.25, {"--no-dither"})) REQUIRE(one == 4);
  for (const double exact : {0.0, 1.0, 77.0, 254.0, 255.0})
    for (const double one : render("d.png", exact, {})) REQUIRE(one == exact);
}

TEST_CASE("values of tone mapping that are none are refused by the option's name") {
  const CliFolder folder;
  const auto refused = [&](const std::string& option, const std::string& value) {
    const CommandResult result =
        run_sundog({"render", folder.scene, "-o", folder.file("a.png"), option, value});
    CHECK(result.status == 2);
    CHECK(is_one_error_line(result.err));
    CHECK(result.err.find(option + " " + value) != std::string::npos);
  };
  refused("--tone-map", "filmic");
  refused("--exposure", "bright");
  refused("--white-balance", "100");
  refused("--white-balance", "auto");
  refused("--contrast", "0");
  refused("--vignette", "2");
  refused("--bloom", "-1");
}
