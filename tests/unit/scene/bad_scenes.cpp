// Checks tables of bad scenes against the loader's errors and the schema's.
#include "bad_scenes.h"

#include <filesystem>

#include "catch.h"
#include "json_schema.h"
#include "scene/json/parse.h"
#include "scene_text.h"

using namespace sundog;

namespace bad_scenes {

void check(const std::vector<Bad>& table) {
  for (const Bad& bad : table) {
    INFO(bad.text);
    const SceneError error = error_of(bad.text);
    INFO(error.what());
    CHECK(error.place == bad.place);
    CHECK(std::filesystem::path(error.file).filename() == "scene.json");
    CHECK(error.reason.find('\n') == std::string::npos);
    for (const std::string& word : bad.words) {
      INFO(word);
      CHECK(error.reason.find(word) != std::string::npos);
    }
    CHECK(schema_errors(scene_schema(), parse_json(bad.text, "scene.json")).empty() == !bad.schema);
  }
}

Bad object(const std::string& text, const std::string& place, std::vector<std::string> words, bool schema) {
  return {scene_of(text), "/objects/0" + place, std::move(words), schema};
}

Bad sphere(const std::string& members, const std::string& place, std::vector<std::string> words,
           bool schema) {
  return object(R"({"type": "sphere", "material": "m", )" + members + "}", place, std::move(words), schema);
}

}  // namespace bad_scenes
