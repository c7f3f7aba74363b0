// The scene of docs/guide/scenes.md loads. The fractals and formulas of docs/guide/formulas.md are scenes
// that load, without a warning but the one that the page mentions.
#include <fstream>

#include "catch.h"
#include "scene_text.h"

namespace {

/// The examples of a page: indented lines that begin with a brace, up to the next line that is not
/// indented.
std::vector<std::string> examples_of(const std::string& page) {
  std::ifstream file(SUNDOG_SOURCE_DIR "/docs/guide/" + page);
  std::vector<std::string> examples;
  bool is_open = false;
  for (std::string line; std::getline(file, line);) {
    const bool is_indented = line.starts_with("    ");
    if (is_indented && !is_open && line[4] == '{') examples.emplace_back();
    is_open = is_indented && (is_open || line[4] == '{');
    if (is_open) examples.back() += line + "\n";
  }
  return examples;
}

}  // namespace

TEST_CASE("the manual's fractals and formulas load") {
  const auto texts = examples_of("formulas.md");
  CHECK(texts.size() >= 5);
  for (const std::string& example : texts) {
    INFO(example);
    const auto scene = load_scene_text(R"({"materials": {"stone": {}}, "objects": [)" + example + "]}");
    CHECK(scene.fields.size() == 1);
    for (const std::string& warning : scene.warnings) CHECK(warning.find("changes by") != std::string::npos);
    CHECK(scene.warnings.empty() == (example.find("sin(") == std::string::npos));
  }
}

TEST_CASE("the manual's scene loads") {
  const auto texts = examples_of("scenes.md");
  REQUIRE(texts.size() == 1);
  const auto scene = load_scene_text(texts[0]);
  CHECK(scene.objects.size() == 2);
  CHECK(scene.warnings.empty());
}
