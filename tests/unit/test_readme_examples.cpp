// The README's fractals and formulas are scenes that load, without a warning but the one that it tells of.
#include <fstream>

#include "catch.h"
#include "scene_text.h"

namespace {

/// The examples of a section: indented lines that begin with a brace, up to the next line that is not
/// indented.
std::vector<std::string> examples_of(const std::string& section) {
  std::ifstream file(SUNDOG_SOURCE_DIR "/README.md");
  std::vector<std::string> examples;
  bool is_here = false, is_open = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) is_here = line == section;
    const bool is_indented = line.starts_with("    ");
    if (is_here && is_indented && !is_open && line[4] == '{') examples.emplace_back();
    is_open = is_here && is_indented && (is_open || line[4] == '{');
    if (is_open) examples.back() += line + "\n";
  }
  return examples;
}

}  // namespace

TEST_CASE("the README's fractals and formulas load") {
  const auto examples = examples_of("### Fractals and formulas");
  CHECK(examples.size() >= 5);
  for (const std::string& example : examples) {
    INFO(example);
    const auto scene = load_scene_text(R"({"materials": {"stone": {}}, "objects": [)" + example + "]}");
    CHECK(scene.fields.size() == 1);
    for (const std::string& warning : scene.warnings) CHECK(warning.find("changes by") != std::string::npos);
    CHECK(scene.warnings.empty() == (example.find("sin(") == std::string::npos));
  }
}
