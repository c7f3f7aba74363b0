// Tone mapping from the command line: files of 8 bits show it, others keep what was rendered.
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
  render("a.part", {"--tiles", "1/1"});
  REQUIRE(
      run_sundog({"merge", folder.file("a.part"), "-o", folder.file("c.png"), "--exposure", "-1"}).status ==
      0);
  CHECK(read_file(folder / "c.png") == read_file(folder / "b.png"));
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
}
