// The pages of the manual: those that are generated are current, every key of a scene is described, and links
// lead somewhere.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "base/file.h"
#include "base/image_io.h"
#include "catch.h"
#include "formula/functions.h"
#include "formula/list.h"
#include "models/model.h"
#include "scene_reference.h"

using namespace sundog;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

const fs::path root = SUNDOG_SOURCE_DIR;
const fs::path reference_page = root / "docs/reference/scene-reference.md",
               language_page = root / "docs/reference/formula-language.md";

ordered_json ordered_schema() { return ordered_json::parse(read_file(root / "scenes/scene.schema.json")); }

/// The language's page with its table of functions as it must be.
std::string language_text() {
  const std::string page = read_file(language_page);
  const std::string first = "<!-- functions: ", last = "<!-- end of functions -->";
  const auto begin = page.find('\n', page.find(first)) + 1, end = page.find(last);
  std::string table = "\n| function | value |\n|---|---|\n";
  for (const FunctionHelp& f : function_help())
    table += fmt::format("| `{}` | {} |\n", f.call, std::regex_replace(f.meaning, std::regex("\\|"), "\\|"));
  return page.substr(0, begin) + table + "\n" + page.substr(end);
}

std::vector<fs::path> pages() {
  std::vector<fs::path> all{root / "README.md", root / "CONTRIBUTING.md", root / "host/README.md",
                            root / "kernels/README.md", root / "host/models/README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  return all;
}

/// The anchors of a page's headings, as GitHub makes them.
std::set<std::string> anchors(const std::string& page) {
  std::set<std::string> all;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("#")) continue;
    std::string anchor;
    for (const char c : line.substr(line.find_first_not_of("# ")))
      if (c == ' ' || c == '-')
        anchor += '-';
      else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
        anchor += static_cast<char>(std::tolower(c));
    all.insert(anchor);
  }
  return all;
}

/// Targets of the page's links and pictures.
std::vector<std::string> links(const std::string& page) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  std::vector<std::string> all;
  for (std::sregex_iterator it(page.begin(), page.end(), link), end; it != end; ++it) all.push_back((*it)[1]);
  return all;
}

}  // namespace

TEST_CASE("the scene reference is the schema's") {
  INFO("docs/write_pages.sh writes it");
  CHECK((read_file(reference_page) == scene_reference(ordered_schema())));
}

TEST_CASE("the formula language's page has every function") {
  INFO("docs/write_pages.sh writes them");
  CHECK((read_file(language_page) == language_text()));
  for (const FunctionHelp& f : function_help()) {
    INFO(f.call);
    CHECK(!f.meaning.empty());
  }
}

TEST_CASE("write the generated pages", "[.write-pages]") {
  write_file(reference_page, scene_reference(ordered_schema()));
  write_file(language_page, language_text());
}

TEST_CASE("every key of the schema is described, and what holds without it") {
  const ordered_json schema = ordered_schema();
  const ordered_json& kinds = schema.at("$defs");
  const std::set<std::string> plain{"vec3",        "number",      "length",      "color",
                                    "share_color", "light_color", "coefficient", "share"};
  std::size_t count = 0;
  for (const auto& [name, kind] : kinds.items()) {
    if (!kind.contains("properties")) continue;
    INFO("$defs/" << name);
    CHECK((kind.contains("description") || kind["properties"].contains("type")));
    const ordered_json required = kind.value("required", ordered_json::array());
    for (const auto& [key, rule] : kind["properties"].items()) {
      if (key == "type" && !rule.contains("description") && !rule.contains("$ref")) continue;
      INFO(key);
      const std::string of = rule.contains("$ref") ? rule["$ref"].get<std::string>().substr(8) : "";
      const ordered_json shared = of.empty() || plain.contains(of) ? ordered_json::object() : kinds.at(of);
      const std::string text = rule.value("description", shared.value("description", ""));
      CHECK(!text.empty());
      const bool has_default = rule.contains("default") || (!of.empty() && kinds.at(of).contains("default"));
      if (!has_default && std::find(required.begin(), required.end(), key) == required.end())
        CHECK((text.find("Without") != std::string::npos || text.find("Default") != std::string::npos));
      ++count;
    }
  }
  CHECK(count > 400);
}

TEST_CASE("links and pictures of the pages lead somewhere") {
  std::size_t count = 0;
  for (const fs::path& path : pages()) {
    const std::string page = read_file(path);
    for (const std::string& link : links(page)) {
      if (link.starts_with("http")) continue;
      INFO(path << ": " << link);
      const auto hash = link.find('#');
      const fs::path file = hash == 0 ? path : path.parent_path() / link.substr(0, hash);
      CHECK(fs::exists(file));
      if (hash != std::string::npos && fs::exists(file))
        CHECK(anchors(read_file(file)).contains(link.substr(hash + 1)));
      ++count;
    }
  }
  CHECK(count > 50);
}

TEST_CASE("the contact sheet and the pages have as many surfaces as the list") {
  const std::size_t count = formula_list().size();
  for (const auto& [page, text] : {std::pair("docs/gallery.md", "the {} surfaces of `sundog formulas`"),
                                   {"docs/measurements/peers.md", "| {} surfaces and formulas"},
                                   {"README.md", "{} surfaces, or a"}})
    CHECK(read_file(root / page).find(fmt::format(fmt::runtime(text), count)) != std::string::npos);
  const Image sheet =
      read_image(root / "docs/pictures/formulas.png");  // docs/render_pictures.sh: rows of eight
  const std::size_t rows = (count + 7) / 8;
  CHECK(sheet.width == 8 * 180);
  CHECK(sheet.height == static_cast<int>(rows) * (180 + 22));
  const Image thumbnails =
      read_image(root / "host/app/serve/page/surfaces.jpg");  // of the viewer, by the same script
  CHECK(thumbnails.width == 8 * 96);
  CHECK(thumbnails.height == static_cast<int>(rows) * 96);
}

TEST_CASE("the schema and the pages name every format of models") {
  std::istringstream formats(SUNDOG_MODEL_EXTENSIONS);
  for (std::string format; formats >> format;)
    for (const char* name : {"scenes/scene.schema.json", "docs/reference/command-line.md"}) {
      INFO(name << " lacks " << format);
      CHECK(read_file(root / name).find(format) != std::string::npos);
    }
}
