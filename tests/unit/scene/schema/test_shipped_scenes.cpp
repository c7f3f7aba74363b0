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

namespace {

/// Checks the scenes of a folder against the schema that they name. Returns their files.
std::vector<fs::path> valid_scenes(const char* folder, const std::string& schema) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") continue;
    INFO(entry.path());
    files.push_back(entry.path());
    const json document = read_json_file(entry.path());
    CHECK(document.value("$schema", "") == schema);
    const auto errors = schema_errors(scene_schema(), document);
    INFO(fmt::format("{}", fmt::join(errors, "\n")));
    CHECK(errors.empty());
  }
  CHECK(files.size() >= 6);
  return files;
}

}  // namespace

TEST_CASE("every scene that ships loads and is valid") {
  for (const fs::path& file : valid_scenes(SUNDOG_SOURCE_DIR "/scenes", "scene.schema.json")) {
    INFO(file);
    CHECK(load_scene(file).warnings == std::vector<std::string>());
  }
}

TEST_CASE("the scenes of the gallery, whose meshes a script writes, are valid and have their pictures") {
  for (const fs::path& file : valid_scenes(SUNDOG_SOURCE_DIR "/scenes/gallery", "../scene.schema.json")) {
    INFO(file);
    CHECK(fs::exists(SUNDOG_SOURCE_DIR "/docs/pictures/gallery/" + file.stem().string() + ".jpg"));
  }
}
