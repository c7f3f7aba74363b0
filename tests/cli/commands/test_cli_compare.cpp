// `sundog compare`: figures, exit status and the picture of the differences.
#include <base/file.h>
#include <base/image_io.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

/// Two images of 20x10 that differ by 0.25 in one channel of one pixel.
struct Pair : TemporaryFolder {
  std::string a = (*this / "a.pfm").string(), b = (*this / "b.pfm").string();
  Pair() {
    Image image(20, 10, 3);
    write_image(image, a);
    image.pixel(7, 3)[1] = 0.25f;
    write_image(image, b);
  }
};

}  // namespace

TEST_CASE("equal images compare with status 0") {
  const Pair pair;
  const CommandResult result = run_sundog({"compare", pair.a, pair.a});
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  CHECK(result.out.find("0 of 200") != std::string::npos);
}

TEST_CASE("a difference is status 6 unless the tolerance covers it") {
  const Pair pair;
  CHECK(run_sundog({"compare", pair.a, pair.b}).status == 6);
  CHECK(run_sundog({"compare", pair.a, pair.b, "--tolerance", "0.2"}).status == 6);
  CHECK(run_sundog({"compare", pair.a, pair.b, "--tolerance", "0.25"}).status == 0);
}

TEST_CASE("compare --json gives the figures") {
  const Pair pair;
  const json figures = json::parse(run_sundog({"compare", pair.a, pair.b, "--json"}).out);
  CHECK(figures["schema"] == 1);
  CHECK(figures["max"] == 0.25);
  CHECK(figures["pixels"] == 200);
  CHECK(figures["differing"] == 1);
  CHECK(figures["over_tolerance"] == 1);
  CHECK(figures["equal"] == false);
  CHECK(json::parse(run_sundog({"compare", pair.a, pair.a, "--json"}).out)["psnr"].is_null());
}

TEST_CASE("alpha is compared where both pictures have it") {
  const TemporaryFolder folder;
  Image image(6, 4, 4);
  std::ranges::fill(image.data, 0.5f);
  write_image(image, folder / "half.exr");
  write_image(image, folder / "half.png");
  for (int x = 0; x < 3; ++x) image.pixel(x, 1)[3] = 1;
  write_image(image, folder / "holes.exr");
  write_image(image, folder / "none.pfm");
  write_image(image, folder / "none.jpg");
  const auto compare = [&](const char* a, const char* b) {
    return json::parse(run_sundog({"compare", (folder / a).string(), (folder / b).string(), "--json"}).out);
  };
  const json both = compare("half.exr", "holes.exr");
  CHECK(both["alpha"] == true);
  CHECK(both["differing"] == 3);
  CHECK(both["max"] == 0.5);
  CHECK(compare("half.exr", "half.png")["alpha"] == true);
  for (const char* none : {"none.pfm", "none.jpg"}) CHECK(compare("holes.exr", none)["alpha"] == false);
  CHECK(compare("holes.exr", "none.pfm")["differing"] == 0);
}

TEST_CASE("every layer that both EXR files have is compared, and the others are named") {
  const TemporaryFolder folder;
  Image image(6, 4, 4), near(6, 4, 1), far(6, 4, 1), normal(6, 4, 3);
  far.pixel(2, 1)[0] = std::numeric_limits<float>::infinity();
  far.pixel(3, 1)[0] = 0.5f;
  write_image(image, folder / "a.exr", {{"depth", near}, {"normal", normal}, {"uv", Image(6, 4, 2)}});
  normal.pixel(0, 0)[2] = 0.25f;
  write_image(image, folder / "b.exr", {{"depth", far}, {"normal", normal}, {"object", near}});
  const auto compare = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"compare", (folder / "a.exr").string(), (folder / "b.exr").string()});
    return run_sundog(more);
  };
  const CommandResult result = compare({"--json"});
  CHECK(result.status == 6);
  const json figures = json::parse(result.out);
  CHECK(figures["differing"] == 0);
  CHECK(figures["equal"] == false);
  CHECK(figures["layers"]["depth"]["differing"] == 2);
  CHECK(figures["layers"]["depth"]["max"].is_null());
  CHECK(figures["layers"]["normal"]["max"] == 0.25);
  CHECK(figures["layers_not_compared"] == json({"uv", "object"}));
  const std::string text = compare({}).out;
  CHECK(text.find("layer depth: max inf, pixels differing 2 of 24") != std::string::npos);
  CHECK(text.find("layer uv: not in both files alike") != std::string::npos);
  write_image(image, folder / "a.exr", {{"normal", normal}, {"depth", near}});
  near.pixel(0, 0)[0] = 0.125f;
  write_image(image, folder / "b.exr", {{"normal", normal}, {"depth", near}});
  CHECK(compare({"--tolerance", "0.125"}).status == 0);
  CHECK(compare({"--tolerance", "0.12"}).status == 6);
}

TEST_CASE("images of different sizes differ, and stderr says how") {
  const Pair pair;
  write_image(Image(10, 20, 3), pair / "c.pfm");
  const CommandResult result = run_sundog({"compare", pair.a, (pair / "c.pfm").string()});
  CHECK(result.status == 6);
  CHECK(is_one_error_line(result.err));
  CHECK(result.err.find("20x10") != std::string::npos);
  CHECK(result.err.find("10x20") != std::string::npos);
}

TEST_CASE("compare --diff writes a picture that shows where") {
  const Pair pair;
  const auto diff = pair / "diff.png";
  CHECK(run_sundog({"compare", pair.a, pair.b, "--diff", diff.string()}).status == 6);
  const Image shown = read_image(diff);
  REQUIRE(shown.width == 20);
  CHECK(shown.pixel(7, 3)[0] > 0.5f);
  CHECK(shown.pixel(8, 3)[0] == 0);
}

TEST_CASE("compare tells a bad input from an output that cannot be written") {
  const Pair pair;
  CommandResult result = run_sundog({"compare", pair.a, (pair / "none.png").string()});
  CHECK(result.status == 3);
  CHECK(result.err ==
        "sundog: " + (pair / "none.png").string() + ": cannot be read: No such file or directory\n");
  const std::string text = pair.write("text.png", "not an image").string();
  result = run_sundog({"compare", text, pair.a});
  CHECK(result.status == 3);
  CHECK(result.err.starts_with("sundog: " + text + ": "));
  CHECK(is_one_error_line(result.err));
  result = run_sundog({"compare", pair.a, pair.b, "--diff", (pair / "none/diff.png").string()});
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
}

TEST_CASE("a full standard output is an error") {
  const Pair pair;
  const CommandResult result =
      run_command({"sh", "-c", "exec \"$0\" compare \"$1\" \"$1\" >/dev/full", SUNDOG_BINARY, pair.a});
  CHECK(result.status == 1);
  CHECK(result.err == "sundog: the standard output cannot be written\n");
}
