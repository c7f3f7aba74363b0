// scenes/scene.schema.json says what the reader does: the same keys, the same defaults.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "base/image_io.h"
#include "catch.h"
#include "every_kind.h"
#include "json_schema.h"
#include "scene/integrators.h"
#include "scene/json/parse.h"
#include "scene/kinds.h"
#include "scene/load.h"
#include "scene/procedural/profile.h"
#include "scene/read/scene_reader.h"
#include "scene/read/textures.h"
#include "scene/read/tracks.h"
#include "scene_text.h"

using namespace sundog;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// One thing of every kind, so that the reader asks for every key.
const std::string everything = R"({
  "$schema": "scene.schema.json",
  "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "far": 9, "lens": {}, "moves_to": {"position": [1, 0, 5]}},
  "environment": {"type": "sky", "sun": {}}, "image": {"transparent": true, "tone_map": {"white_balance": 5000}, "background": {"bottom": [0, 0, 0], "top": [1, 1, 1]}}, "render": {"samples": 16, "path": {"guides": [{"center": [0, 0, 0], "radius": 1}]}, "adaptive": {}, "subsample": {"on": false}}, "world": {"medium": "a", "fog": {"density": 1, "anisotropy": 0.5}},
  "media": {"a": {"absorption": {"color": [1, 1, 1], "distance": 1}}, "b": {"absorption": [0, 1, 2]}},
  "lights": [{"type": "ambient"}, {"type": "directional", "direction": [0, -1, 0]},
    {"type": "point", "position": [0, 0, 0], "falloff": {}},
    {"type": "spot", "position": [0, 0, 0], "direction": [0, 1, 0]},
    {"type": "rectangle", "position": [0, 0, 0], "direction": [0, 1, 0], "size": [1, 2]},
    {"type": "disk", "position": [0, 0, 0], "target": [0, 1, 0]}, {"type": "sphere", "position": [0, 0, 0]}],
  "textures": {"t": {"type": "image", "file": "t.pfm", "wrap": ["clamp", "mirror"], "scale": [2, 1]},
    "a": {"type": "checker", "colors": [[0, 0, 0], "t"]}, "b": {"type": "stripes"}, "c": {"type": "gradient"}, "d": {"type": "brick"},
    "e": {"type": "noise"}, "f": {"type": "cells"}, "g": {"type": "marble"}, "h": {"type": "wood"},
    "v": {"type": "vertex_color", "channel": "alpha"},
    "i": {"type": "ramp", "of": "e", "stops": [{"at": 0.5, "color": [0, 1, 0]}]}, "j": {"type": "product", "of": ["a", "i"]}, "k": {"type": "formula", "formula": "s * p.x", "parameters": {"s": 2}}},
  "materials": {
    "textured": {"color": "t", "specular": {"color": "t", "exponent": "t"}, "emission": {"color": "t"}, "opacity": "t",
      "normal_map": {"texture": "t"}, "bump": {"texture": "e"}, "occlusion": "t"},
    "deep": {"parallax": {"texture": "e"}, "displacement": {"texture": "t"}},
    "m": {"color": {"checker": [[0, 0, 0], [1, 1, 1]]}, "ambient": {}, "specular": {}, "reflection": {}},
    "plain": {"color": [0, 1, 0], "ambient": 0, "specular": 0.5, "transmission": 1, "ior": 1.5},
    "glass": {"type": "dielectric", "medium": "a"},
    "wall": {"type": "dielectric", "thin_walled": true, "ior": 1.5},
    "layered": {"type": "openpbr", "base_color": "t", "transmission_weight": 0.5, "coat_weight": 1, "fuzz_weight": 0.5},
    "mapped": {"type": "openpbr", "base_metalness": "t", "specular_roughness": "t", "transmission_weight": "t", "coat_weight": "t"}},
  "meshes": {
    "t": {"file": "tetra.ply", "crease_angle": 30},
    "i": {"generate": {"type": "ice_block", "subdivision": 4, "cavity": {}}},
    "l": {"generate": {"type": "ice_block", "subdivision": 4, "part": "liquid", "level": 0, "cavity": {}}},
    "v": {"generate": {"type": "lathe", "profile": [[0, 0], [1, 0], [1, 2], [0.8, 2, 0.05], [0.8, 0.2], [0, 0.2]], "segments": 8}},
    "e": {"generate": {"type": "extrusion", "outline": [[0, 0], [1, 0], [0, 1, 0.1]]}},
    "m": {"generate": {"type": "terrain", "cells": 4, "octaves": 2}},
    "tf": {"generate": {"type": "terrain", "cells": 4, "formula": "p.x"}},
    "sw": {"generate": {"type": "sweep"}},
    "w": {"generate": {"type": "fill", "vessel": "v", "to": 1, "meniscus": 0.01}}},
  "animate": [{"type": "smooth", "value": "/camera/fov", "keys": [{"frame": 0, "value": 30}, {"frame": 9, "value": 40}]},
    {"type": "bezier", "value": "/camera/near", "keys": [{"frame": 0, "value": 0, "handle_right": {"frame": 1, "value": 0}}]},
    {"type": "step", "value": "/camera/far", "keys": [{"frame": 0, "value": 9}]},
    {"type": "linear", "value": "/camera/up/0", "keys": [{"frame": 0, "value": 0}]},
    {"type": "slerp", "value": "/objects/0/transform/0/rotate/quaternion", "keys": [{"frame": 0, "value": [0, 0, 0, 1]}]},
    {"type": "rotate", "value": "/lights/1/direction", "last": 60}],
  "fields": {"f": {"field": {"type": "union", "fields": [
      {"type": "intersection", "fields": [{"type": "fractal", "formula": "mandelbulb"}, {"type": "formula", "distance": "length(p) - 1"}]},
      {"type": "difference", "fields": [{"type": "moved", "rotate": {"axis": [0, 1, 0], "degrees": 3}, "field": {"type": "fractal", "formula": "menger"}},
        {"type": "thicken", "amount": 0.1, "field": {"type": "fractal", "formula": "menger"}}]},
      {"type": "repeat", "period": [3, 0, 0], "field": {"type": "shell", "amount": 0.1, "field": {"type": "fractal", "formula": "menger"}}},
      {"type": "union", "fields": [{"type": "sphere"}, {"type": "plane"}, {"type": "box"}, {"type": "cylinder"}]},
      {"type": "union", "fields": [{"type": "cone"}, {"type": "torus"}, {"type": "round_box"}, {"type": "native", "code": "return p.x;"}]},
      {"type": "hybrid", "steps": [{"type": "fractal", "formula": "menger"},
        {"type": "formula", "map": "z = z * 2", "distance": "length(z) - 1"}]}]},
    "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}}},
  "objects": [{"type": "sphere", "transform": [{"rotate": {"quaternion": [0, 0, 0, 1]}}]}, {"type": "field", "field": "f"},
    {"type": "fractal", "formula": "julia", "ball": {"radius": 2}, "coloring": {"palette": [[1, 0, 0]]}, "glow": {"color": [1, 1, 1]}},
    {"type": "formula", "distance": "length(p) - a", "parameters": {"a": {"value": 1}}},
    {"type": "hybrid", "steps": [{"type": "fractal", "formula": "menger"}]},
    {"type": "union", "fields": [{"type": "fractal", "formula": "menger"}, {"type": "fractal", "formula": "menger"}], "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "intersection", "fields": [{"type": "fractal", "formula": "menger"}, {"type": "fractal", "formula": "menger"}], "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "difference", "fields": [{"type": "fractal", "formula": "menger"}, {"type": "fractal", "formula": "menger"}], "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "moved", "field": {"type": "fractal", "formula": "menger"}, "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "repeat", "period": [3, 0, 0], "field": {"type": "fractal", "formula": "menger"}, "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "thicken", "amount": 0.1, "field": {"type": "fractal", "formula": "menger"}, "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "native", "code": "return p.x;", "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
    {"type": "shell", "amount": 0.1, "field": {"type": "native", "code": "return p.x;"}, "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}}, {"type": "plane"}, {"type": "box"}, {"type": "cylinder"}, {"type": "cone"},
    {"type": "disk"}, {"type": "rectangle", "size": [1, 2]}, {"type": "torus"}, {"type": "round_box"}, {"type": "mesh", "mesh": "t"},
    {"type": "lathe", "profile": [[0, 0], [1, 0], [0, 1]], "curve": "lines"}, {"type": "lathe", "mesh": "w"},
    {"type": "box", "min": [0, 0, 0], "max": [1, 1, 1]}, {"type": "cone", "from": [0, 0, 0], "to": [1, 1, 1]},
    {"type": "cylinder", "from": [0, 0, 0], "to": [1, 1, 1]},
    {"type": "model", "file": "tetra.ply", "transform": [{"translate": [0, 0, 0]}, {"scale": 2}, {"scale": [1, 2, 3]},
      {"rotate": {"axis": [0, 1, 0], "degrees": 3}}, {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]},
    {"type": "scatter", "on": "m", "density": 0.01, "objects": [{"type": "sphere", "material": "m"}]},
    {"type": "group", "objects": [], "turns_by": {"axis": [0, 1, 0], "degrees": 90}, "grows_to": 2}]})";

const std::string small_picture = "PF\n1 1\n-1\n" + std::string(12, '\0');

json everything_document() {
  json document = parse_json(everything, "everything.json");
  for (json& object : document["objects"]) object["material"] = "m";
  return document;
}

/// Reads a document that lies beside tetra.ply and sky.pfm.
SceneDescription read(const json& document, decltype(JsonContext::asked) asked = nullptr) {
  const TemporaryFolder folder;
  folder.write("tetra.ply", tetrahedron_ply);
  write_image(Image(2, 1, 3), folder.path() / "sky.pfm");
  folder.write("t.pfm", small_picture);
  const JsonContext context{folder.path() / "scene.json", asked, true};
  return read_scene(JsonValue(document, context));
}

/// Every place of a document, outermost first.
void list_places(const json& value, const std::string& pointer, std::vector<std::string>& places) {
  places.push_back(pointer);
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) list_places(member, join_pointer(pointer, key), places);
}

bool takes(const json& document, const fs::path& folder) {
  const JsonContext context{folder / "scene.json", nullptr, true, nullptr, false};
  try {
    const SceneDescription scene = read_scene(JsonValue(document, context));
    for (const Object& object : scene.objects)
      for (int column = 0; column < 4; ++column)
        CHECK(glm::all(glm::lessThan(glm::abs(object.world_from_object[column]), glm::dvec4(1e19))));
    return true;
  } catch (const SceneError& error) {
    CHECK(!error.place.empty());
    return false;
  }
}

/// The keys of each kind of object that has no others: "camera", and by its type "light/point".
std::map<std::string, std::set<std::string>, std::less<>> schema_keys() {
  std::map<std::string, std::set<std::string>, std::less<>> result;
  const auto add = [&](const std::string& kind, const SchemaRule& rule) {
    for (const auto& [key, of] : rule.keys) result[kind].emplace(key);
  };
  for (const auto& [kind, schema] : scene_schema().at("$defs").items()) {
    if (schema.value("additionalProperties", json()) != false &&
        schema.value("unevaluatedProperties", json()) != false)
      continue;
    const SchemaRule& rule = *schema_rule(kind);
    for (const auto& [type, typed] : rule.of_type) add(fmt::format("{}/{}", kind, type), *typed);
    if (rule.of_type.empty()) add(kind, rule);
  }
  return result;
}

}  // namespace

TEST_CASE("the reader and the schema know the same keys") {
  std::map<std::string, std::set<std::string>, std::less<>> asked;
  json document = everything_document();
  read(document, &asked);
  for (const char* environment :
       {R"({"type": "image", "file": "sky.pfm"})", R"({"type": "gradient"})",
        R"({"type": "halo", "crystals": [{"shape": "plate"}], "sun": {}, "ior": 1.31})"}) {
    document["environment"] = json::parse(environment);
    read(document, &asked);
    CHECK(schema_errors(scene_schema(), document).empty());
  }
  const auto schema = schema_keys();
  CHECK(schema.size() > 100);
  // The reader refuses these.
  const std::set<std::string> open_solids{"field/disk", "field/rectangle", "field/lathe"};
  for (const auto& [kind, keys] : asked) {
    INFO("$defs/" << kind << " of the schema has: "
                  << fmt::format(
                         "{}",
                         fmt::join(schema.count(kind) ? schema.at(kind) : std::set<std::string>{}, ", ")));
    INFO("the reader asks for: " << fmt::format("{}", fmt::join(keys, ", ")));
    CHECK((schema.count(kind) == 1 && schema.at(kind) == keys));
  }
  for (const auto& [kind, keys] : schema) {
    INFO("$defs/" << kind << " of the schema is of no kind that the reader reads");
    CHECK((asked.count(kind) == 1 || open_solids.contains(kind)));
  }
}

/// Reads every name that the schema has for a key into the enumeration.
template <class E>
void check_names(const char* kind, const char* key) {
  for (const std::string_view name :
       schema_rule(kind)->keys.at(key).rule->as(SchemaRule::Type::string)->names) {
    INFO(kind << "/" << key << ": " << name);
    CHECK_NOTHROW(enumerator_named<E>(name));
  }
}

TEST_CASE("integrators have the schema's names") {
  const auto& names = schema_rule("render")->keys.at("integrator").rule->as(SchemaRule::Type::string)->names;
  CHECK(std::ranges::equal(names, integrator_names));
}

TEST_CASE("enumerators have the schema's names") {
  CHECK(enumerator_named<Filter>("blackman_harris") == Filter::blackman_harris);
  CHECK(enumerator_named<Tracer>("auto") == Tracer::automatic);
  CHECK_THROWS_AS(enumerator_named<Filter>("triangle"), std::logic_error);
  CHECK_THROWS_AS(enumerator_named<Filter>(""), std::logic_error);
  check_names<ToneCurve>("tone_map", "curve");
  check_names<Filter>("render", "filter");
  check_names<Tracer>("render", "tracer");
  check_names<EnvironmentType>("environment", "type");
  check_names<MaterialType>("material", "type");
  check_names<TextureFilter>("image_texture", "filter");
  check_names<ImageEncoding>("image_texture", "encoding");
  check_names<Mapping>("checker_texture", "projection");
  check_names<procedural::ProfileCurve>("generate_lathe", "curve");
  check_names<Track::Kind>("keyed_track", "type");
  check_names<FormulaDerivative>("formula", "derivative");
  check_names<EscapeEstimate>("formula", "estimate");
  check_names<SdfColorBy>("coloring", "by");
}

TEST_CASE("the schema takes what the reader takes") {
  const auto holds = [](const json& list, std::string_view type) {
    return std::any_of(list.begin(), list.end(), [&](const json& item) { return item["type"] == type; });
  };
  const json document = everything_document();
  for (const Shape& solid : every_solid()) CHECK(holds(document["objects"], name_of(solid)));
  for (const LightTypeFacts& facts : light_types) CHECK(holds(document["lights"], facts.name));
  const auto errors = schema_errors(scene_schema(), everything_document());
  INFO(fmt::format("{}", fmt::join(errors, "\n")));
  CHECK(errors.empty());
  for (const char* scene :
       {R"({"objects": []})", R"({"objects": [], "image": {"width": 10.0, "background": [1, 2, 3]}})",
        R"({"objects": [], "camera": {"far": 1e300}})"})
    CHECK(schema_errors(scene_schema(), json::parse(scene)).empty());
}

/// The document with one object alone, that in which `place` lies, or the first; `place` then leads to it
/// there.
json with_one_object(json document, std::string& place) {
  const std::string all = "/objects/";
  if (place == "/objects") return document;
  std::size_t kept = 0;
  if (place.starts_with(all)) {
    const std::size_t end = std::min(place.find('/', all.size()), place.size());
    kept = std::stoul(place.substr(all.size(), end - all.size()));
    place = all + "0" + place.substr(end);
  }
  document["objects"] = json::array({document["objects"][kept]});
  return document;
}

/// The document without the lists, and the named things, that neither hold `place` nor are referred to.
json without_unneeded(json document, const std::string& place, const fs::path& folder) {
  const auto drop = [&](const std::string& pointer) {
    if ((place + "/").starts_with(pointer + "/")) return;
    json smaller = document;
    const json::json_pointer dropped(pointer);
    smaller[dropped.parent_pointer()].erase(dropped.back());
    if (takes(smaller, folder)) document = std::move(smaller);
  };
  for (const std::string list :
       {"/animate", "/lights", "/fields", "/meshes", "/materials", "/textures", "/media"}) {
    if (place == list) continue;
    if (!place.starts_with(list + "/")) {
      drop(list);
    } else if (const json things = document[json::json_pointer(list)]; things.is_object()) {
      for (const auto& [name, thing] : things.items()) drop(list + "/" + name);
    }
  }
  return document;
}

/// The first two steps of a place: below them every place needs the same of the document.
std::string root_of(const std::string& place) {
  const std::size_t second = place.find('/', 1);
  return second == std::string::npos ? place : place.substr(0, place.find('/', second + 1));
}

TEST_CASE("what the schema refuses, the reader refuses") {
  const TemporaryFolder folder;
  folder.write("tetra.ply", tetrahedron_ply);
  folder.write("t.pfm", small_picture);
  const json document = everything_document();
  const json strange = json::parse(
      R"([null, true, 0, -1, 0.5, 1e-300, 2e18, "", "x", [], [1, 2, 3], [0, 0, 0], {}, {"x": 1}])");
  std::vector<std::string> places;
  list_places(document, "", places);
  std::size_t refused = 0;
  std::map<std::string, json> parts;
  for (std::string place : places) {
    if (place.empty()) continue;
    // Thousands of readings: each is to be short.
    const std::string root = root_of(place);
    const json whole = with_one_object(document, place);
    if (!parts.contains(root)) parts[root] = without_unneeded(whole, place, folder.path());
    const json& part = parts[root];
    for (const json& value : strange) {
      json changed = part;
      changed[json::json_pointer(place)] = value;
      INFO(place << " = " << value.dump());
      if (takes(changed, folder.path())) {
        CHECK(schema_errors(scene_schema(), changed).empty());
      } else {
        ++refused;
      }
    }
  }
  CHECK(refused > places.size() * 10);
}

/// Compares two descriptions line by line, so that a failure names the difference alone.
void check_same(SceneDescription a, SceneDescription b) {
  for (SceneDescription* scene : {&a, &b})
    for (ImageDescription& image : scene->images) image.file.clear();  // in temporary folders
  std::istringstream left(all_values(a)), right(all_values(b));
  for (std::string one, other; std::getline(left, one) && std::getline(right, other);) CHECK(one == other);
  CHECK(all_values(a).size() == all_values(b).size());
}

TEST_CASE("the schema's defaults are the reader's") {
  const json document = everything_document();
  json filled = document;
  fill_defaults(scene_schema(), filled);
  // Proof that something was filled in, at every depth.
  CHECK(filled.at("/camera/fov"_json_pointer) == 45);
  CHECK(filled.at("/lights/3/outer_angle"_json_pointer) == 30);
  CHECK(filled.at("/lights/2/falloff/constant"_json_pointer) == 1);
  CHECK(filled.at("/materials/m/specular/exponent"_json_pointer) == 32);
  CHECK(filled.at("/meshes/i/generate/chips"_json_pointer) == 12);
  CHECK(filled.at("/objects/0/radius"_json_pointer) == 1);
  CHECK(filled.at("/objects/16/capped"_json_pointer) == true);
  // Only a "filter" that is written lets the shadow rays of paths through interfaces.
  for (auto& [name, material] : filled["materials"].items())
    if (!document["materials"][name].contains("shadow")) material.erase("shadow");
  // A mesh brings the curve of its profile.
  for (json& object : filled["objects"])
    if (object.contains("mesh")) object.erase("curve");
  check_same(read(document), read(filled));
}

TEST_CASE("a description that no reader has filled holds the schema's defaults") {
  const SceneDescription scene = read(json::parse(R"({
    "camera": {"position": [0, 0, 5], "target": [0, 0, 0], "lens": {}}, "image": {"tone_map": {}},
    "render": {"path": {}, "adaptive": {}, "subsample": {"on": false}},
    "environment": {"type": "sky", "sun": {}},
    "media": {"a": {}}, "materials": {"m": {}, "l": {"type": "openpbr"}},
    "textures": {"t": {"type": "vertex_color"}},
    "lights": [{"type": "ambient"}, {"type": "directional", "direction": [0, -1, 0]},
      {"type": "point", "position": [0, 0, 0], "falloff": {}},
      {"type": "spot", "position": [0, 0, 0], "direction": [0, -1, 0]},
      {"type": "rectangle", "position": [0, 0, 0], "direction": [0, -1, 0], "size": [1, 1]},
      {"type": "disk", "position": [0, 0, 0], "direction": [0, -1, 0]}, {"type": "sphere", "position": [0, 0, 0]}],
    "objects": [{"type": "group", "material": "m", "objects": [{"type": "sphere"}, {"type": "plane"}, {"type": "box"}, {"type": "cylinder"}, {"type": "cone"},
      {"type": "disk"}, {"type": "rectangle"}, {"type": "torus"}, {"type": "round_box"}]}]})"));
  SceneDescription own = scene;
  own.camera = {};
  own.image = {};
  own.render = {};
  own.environment = {};
  own.environment.type = EnvironmentType::sky;
  for (LightDescription& light : own.lights) {
    const LightType type = light.type;
    light = {};
    light.type = type;
  }
  own.media[1] = {};
  own.media[1].name = "a";
  own.materials[0].layers = OpenPbr{};
  own.materials[1] = {};
  own.materials[1].name = "m";
  own.materials[1].checker_ambient = own.materials[1].ambient;  // of a board of one colour
  own.materials[1].checker_diffuse = own.materials[1].diffuse;
  for (Object& object : own.objects)
    if (object.light < 0) std::visit([](auto& shape) { shape = {}; }, object.shape);
  check_same(own, scene);
}
