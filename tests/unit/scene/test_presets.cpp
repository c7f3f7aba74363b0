// Materials by name.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "catch.h"
#include "json_schema.h"
#include "scene/json/parse.h"
#include "scene/materials/presets.h"
#include "scene/read/scene_reader.h"

using namespace sundog;
using nlohmann::json;

namespace {

SceneDescription read(const std::string& text) {
  const json document = parse_json(text, "scene.json");
  const JsonContext context{"scene.json"};
  return read_scene(JsonValue(document, context));
}

std::string with_ball(const std::string& material, const std::string& sections = "") {
  return fmt::format(R"({{{} "objects": [{{"type": "sphere", "material": "{}"}}]}})", sections, material);
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("an object takes any preset by its name, and the schema lists them all") {
  CHECK(preset_names().size() >= 40);
  for (const std::string& name : preset_names()) {
    INFO(name);
    const SceneDescription scene = read(with_ball(name));
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.materials[0].name == name);
  }
  CHECK(scene_schema().at("/$defs/preset_material/properties/preset/enum"_json_pointer) ==
        json(preset_names()));
}

TEST_CASE("a preset's inside absorbs by the metre") {
  const double water = read(with_ball("water", R"("unit": 1,)")).media[1].absorption.x;
  CHECK(water == Approx(0.28));
  CHECK(read(with_ball("water")).media[1].absorption.x == Approx(water / 10));
  CHECK(read(with_ball("water", R"("unit": 0.01,)")).media[1].absorption.x == Approx(water / 100));
}

TEST_CASE("a material may be a preset with other values") {
  const SceneDescription gold =
      read(with_ball("ring", R"("materials": {"ring": {"preset": "gold", "specular_roughness": 0.4}},)"));
  CHECK(gold.materials[0].layers->specular_roughness == 0.4);
  CHECK(gold.materials[0].layers->base_metalness == 1);
  const SceneDescription drink =
      read(with_ball("drink", R"("materials": {"drink": {"preset": "beer", "ior": 1.4}},)"));
  CHECK(drink.media.at(1).ior == 1.4);
  CHECK(drink.media.at(1).absorption.x > 1);
  const SceneDescription other = read(with_ball(
      "x", R"("media": {"oil": {"ior": 1.5}}, "materials": {"x": {"preset": "beer", "medium": "oil"}},)"));
  CHECK(other.media.size() == 2);
  CHECK(other.materials[0].medium == 1);
}

TEST_CASE("what a scene names itself is no preset") {
  const SceneDescription scene =
      read(with_ball("ice", R"("materials": {"ice": {"diffuse": 1}}, "media": {"gold": {"ior": 2}},)"));
  CHECK(scene.materials.size() == 1);
  CHECK(scene.materials[0].type == MaterialType::phong);
  CHECK(read(with_ball("ice", R"("media": {"ice": {"ior": 2}},)")).media.at(1).ior == 2);
}

TEST_CASE("a wrong preset is refused where it stands") {
  CHECK_THAT(refusal(with_ball("a", R"("materials": {"a": {"preset": "golt"}},)")),
             ContainsSubstring("/materials/a/preset") && ContainsSubstring("did you mean \"gold\"?"));
  CHECK_THAT(refusal(with_ball("a", R"("materials": {"a": {"preset": 3}},)")),
             ContainsSubstring("/materials/a/preset"));
  CHECK_THAT(refusal(with_ball("a", R"("materials": {"a": {"preset": "gold", "roughness": 1}},)")),
             ContainsSubstring("/materials/a"));
  CHECK_THAT(refusal(with_ball("a", R"("materials": {"a": {"preset": "ice", "ior": "wat"}},)")),
             ContainsSubstring("/materials/a/ior: wanted a number") && ContainsSubstring("\"water\""));
  CHECK_THAT(refusal(with_ball("a", R"("materials": {"a": {"preset": "ice", "abbe": 60}},)")),
             ContainsSubstring("/materials/a/abbe: the \"ior\" is a substance's"));
  CHECK_THAT(refusal(with_ball("a", R"("materials": {"a": {"preset": "ice", "ior": 90, "abbe": 1}},)")),
             ContainsSubstring("/materials/a/abbe: the index of refraction at 380 nm"));
  CHECK_THAT(refusal(with_ball("sliver")), ContainsSubstring("did you mean \"silver\"?"));
}

TEST_CASE("sections of another type are refused beside presets") {
  for (const char* key : {"materials", "media", "textures"})
    for (const char* value : {"[]", "[{}]", "\"ice\"", "null"})
      CHECK_THAT(refusal(with_ball("oak_floor", fmt::format(R"("{}": {},)", key, value))),
                 ContainsSubstring(fmt::format("/{0}: wanted an object of {0}", key)));
}

TEST_CASE("textures are presets, too, with sizes in metres, and bring what they are made of") {
  CHECK(scene_schema().at("/$defs/preset_texture/properties/preset/enum"_json_pointer) ==
        json(texture_preset_names()));
  for (const std::string& name : texture_preset_names()) {
    INFO(name);
    CHECK_NOTHROW(read(with_ball(
        "m", fmt::format(R"("materials": {{"m": {{"type": "openpbr", "base_color": "{}"}}}},)", name))));
  }
  const auto textures = [](const std::string& text) {
    const json document = parse_json(text, "scene.json");
    const JsonContext context{"scene.json"};
    read_scene(JsonValue(document, context));
    return preset_sections(document, context)["textures"];
  };
  const json floor = textures(with_ball("oak_floor", R"("unit": 1,)"));
  CHECK(floor["plank_ends"]["size"] == Approx(1.2));
  CHECK(floor["oak_rings"]["size"] == Approx(0.007));
  CHECK(floor.contains("oak_pores"));
  CHECK(textures(with_ball("oak_floor"))["planks"]["size"] == Approx(2.4));
  const std::string wet = R"("textures": {"rain": {"preset": "drops", "size": 3}}, "materials": {
    "m": {"preset": "glass", "bump": {"texture": "rain", "height": 0.1}}},)";
  CHECK(textures(with_ball("m", wet))["rain"]["size"] == 3);
  CHECK_THAT(refusal(with_ball("m", R"("textures": {"rain": {"preset": "dops"}},)")),
             ContainsSubstring("/textures/rain/preset") && ContainsSubstring("drops"));
  // A scene's own texture takes the place of a preset's.
  const json own =
      textures(with_ball("oak_floor", R"("textures": {"planks": {"type": "noise", "size": 5}},)"));
  CHECK(own["planks"]["size"] == 5);
}
