// Every scene that ships is valid and loads without a warning.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.h"
#include "json_schema.h"
#include "scene/json/parse.h"
#include "scene/load.h"

using namespace sundog;
using nlohmann::json;
namespace fs = std::filesystem;

TEST_CASE("every scene that ships loads and is valid") {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(SUNDOG_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    INFO(entry.path());
    ++count;
    const json document = read_json_file(entry.path());
    CHECK(document.value("$schema", "") == "scene.schema.json");
    const auto errors = schema_errors(scene_schema(), document);
    INFO(fmt::format("{}", fmt::join(errors, "\n")));
    CHECK(errors.empty());
    CHECK(load_scene(entry.path()).warnings == std::vector<std::string>());
  }
  CHECK(count >= 6);
}

TEST_CASE("the scenes of the gallery, whose meshes a script writes, are valid") {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(SUNDOG_SOURCE_DIR "/scenes/gallery")) {
    if (entry.path().extension() != ".json") continue;
    INFO(entry.path());
    ++count;
    const json document = read_json_file(entry.path());
    CHECK(document.value("$schema", "") == "../scene.schema.json");
    const auto errors = schema_errors(scene_schema(), document);
    INFO(fmt::format("{}", fmt::join(errors, "\n")));
    CHECK(errors.empty());
    // Its pictures are on the gallery's page.
    CHECK(fs::exists(SUNDOG_SOURCE_DIR "/docs/pictures/gallery/" + entry.path().stem().string() + ".jpg"));
  }
  CHECK(count >= 6);
}
