// What a scene file may not hold: each error names the place, what was wanted and what was found.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.h"
#include "json_schema.h"
#include "scene/json/parse.h"
#include "scene_text.h"

using namespace sundog;

namespace {

/// A bad scene, the place that its error names, and words that the error says. `schema` is false where the
/// fault is beyond a JSON Schema: a name that leads nowhere, one number against another.
struct Bad {
  std::string text, place;
  std::vector<std::string> words;
  bool schema = true;
};

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

Bad object(const std::string& text, const std::string& place, std::vector<std::string> words,
           bool schema = true) {
  return {scene_of(text), "/objects/0" + place, std::move(words), schema};
}

Bad sphere(const std::string& members, const std::string& place, std::vector<std::string> words,
           bool schema = true) {
  return object(R"({"type": "sphere", "material": "m", )" + members + "}", place, std::move(words), schema);
}

Bad material(const std::string& text, const std::string& place, std::vector<std::string> words,
             bool schema = true) {
  return {scene_with(R"("materials": {"m": )" + text + "}"), "/materials/m" + place, std::move(words),
          schema};
}

Bad light(const std::string& text, const std::string& place, std::vector<std::string> words,
          bool schema = true) {
  return {scene_with(R"("lights": [)" + text + "]"), "/lights/0" + place, std::move(words), schema};
}

}  // namespace

TEST_CASE("bad sections of a scene are refused with their place") {
  check({
      {R"([])", "", {"wanted an object", "an array of 0 items"}},
      {R"({})", "", {"missing key \"objects\""}},
      {R"({"object": []})", "", {"missing key \"objects\"", "found \"object\""}},
      {R"({"objects": {}})", "/objects", {"wanted an array of objects", "found an object"}},
      {scene_with(R"("camra": {})"), "/camra", {"unknown key \"camra\"", "did you mean \"camera\"?"}},
      {scene_with(R"("zzzzzz": 1)"), "/zzzzzz", {"unknown key", "wanted", "camera", "lights", "objects"}},
      {scene_with(R"("a/b~c": 1)"), "/a~1b~0c", {"unknown key \"a/b~c\""}},
      {scene_with(R"("line\nbreak": 1)"), "/line\\u000abreak", {"unknown key \"line\\nbreak\""}},
      {scene_with(R"("camera": [])"), "/camera", {"wanted an object", "found an array of 0 items"}},
      {scene_with(R"("camera": {"position": [0, 0, 5]})"),
       "/camera",
       {"missing key \"target\"", "[x, y, z]"}},
      {scene_with(R"("camera": {"position": [0, 0, 5], "targt": [0, 0, 0]})"),
       "/camera",
       {"missing key \"target\"", "found \"targt\""}},
      {scene_with(R"("camera": {"position": [0, 0], "target": [0, 0, 0]})"),
       "/camera/position",
       {"wanted an array of 3 numbers", "found an array of 2 items"}},
      {scene_with(R"("camera": {"position": [0, 0, "5"], "target": [0, 0, 0]})"),
       "/camera/position/2",
       {"wanted a number", "found the string \"5\""}},
      {scene_with(R"("camera": {"position": [1, 2, 3], "target": [1, 2, 3]})"),
       "/camera",
       {"same point"},
       false},
      {scene_with(R"("camera": {"position": [0, 5, 0], "target": [0, 0, 0]})"), "/camera", {"\"up\""}, false},
      {scene_with(R"("camera": {"up": [0, 0, 0]})"), "/camera/up", {"wanted a direction", "length 0"}, false},
      {scene_with(R"("camera": {"fov": 180})"), "/camera/fov", {"above 0 and below 180", "found 180"}},
      {scene_with(R"("camera": {"fov": 0})"), "/camera/fov", {"above 0 and below 180", "found 0"}},
      {scene_with(R"("camera": {"fov": true})"), "/camera/fov", {"wanted a number", "found true"}},
      {scene_with(R"("camera": {"near": -1})"), "/camera/near", {"not below 0", "found -1"}},
      {scene_with(R"("camera": {"near": 5, "far": 2})"),
       "/camera/far",
       {"above the \"near\" of 5", "found 2"},
       false},
      {scene_with(R"("image": {"width": 0})"), "/image/width", {"an integer from 1 to 65536", "found 0"}},
      {scene_with(R"("image": {"height": 1.5})"),
       "/image/height",
       {"an integer from 1 to 65536", "found 1.5"}},
      {scene_with(R"("image": {"background": "red"})"),
       "/image/background",
       {"a colour [r, g, b]", "found the string \"red\""}},
      {scene_with(R"("image": {"background": [0, 0]})"),
       "/image/background",
       {"a colour [r, g, b]", "2 items"}},
      {scene_with(R"("image": {"background": [0, 0, -1]})"), "/image/background/2", {"found -1"}},
      {scene_with(R"("image": {"background": {"bottom": [0, 0, 0]}})"),
       "/image/background",
       {"missing key \"top\""}},
      {scene_with(R"("render": {"max_depth": 65})"),
       "/render/max_depth",
       {"an integer from 1 to 64", "found 65"},
       false},  // the integrator path takes it
      {scene_with(R"("render": {"samples": null})"), "/render/samples", {"an integer", "found null"}},
      {scene_with(R"("render": {"samples": 1e300})"), "/render/samples", {"an integer", "found 1e+300"}},
      {scene_with(R"("render": {"cutoff": 2})"), "/render/cutoff", {"from 0 to 1", "found 2"}},
      {scene_with(R"("render": {"integrator": "whited"})"),
       "/render/integrator",
       {"\"whitted\"", "found the string \"whited\"", "did you mean \"whitted\"?"}},
      {scene_with(R"("render": {"tracer": "fast"})"),
       "/render/tracer",
       {"\"auto\", \"wide\" or \"compact\""}},
      {scene_with(R"("world": {"medium": "watr"}, "media": {"water": {}})"),
       "/world/medium",
       {"the name of a medium", "did you mean \"water\"?", "found the string \"watr\""},
       false},
      {scene_with(R"("$schema": 3)"), "/$schema", {"wanted a string", "found 3"}},
  });
}

TEST_CASE("bad lights are refused with their place") {
  check({
      {scene_with(R"("lights": {})"), "/lights", {"wanted an array of lights", "found an object"}},
      light("3", "", {"wanted an object", "found 3"}),
      light(R"({"color": [1, 1, 1]})", "", {"missing key \"type\"", "\"ambient\"", "\"spot\""}),
      light(R"({"type": "sun"})", "/type", {"\"ambient\", \"directional\", \"point\", \"spot\"", "\"sun\""}),
      light(R"({"type": "ambient", "position": [0, 0, 0]})", "/position", {"unknown key \"position\""}),
      light(R"({"type": "directional"})", "", {"missing key \"direction\""}),
      light(R"({"type": "directional", "direction": [0, 0, 0]})", "/direction", {"length 0"}, false),
      light(R"({"type": "point"})", "", {"missing key \"position\""}),
      light(R"({"type": "point", "position": [0, 0, 0], "intensity": -1})", "/intensity",
            {"not below 0", "found -1"}),
      light(R"({"type": "point", "position": [0, 0, 0], "color": [1, 1, 1, 1]})", "/color", {"4 items"}),
      light(R"({"type": "point", "position": [0, 0, 0], "falloff": {"constant": 0}})", "/falloff", {"not 0"},
            false),
      light(R"({"type": "point", "position": [0, 0, 0], "falloff": {"square": 1}})", "/falloff/square",
            {"quadratic"}),
      light(R"({"type": "spot", "position": [0, 0, 0]})", "", {"\"direction\" or \"target\"", "found none"}),
      light(R"({"type": "spot", "position": [0, 0, 0], "direction": [0, 1, 0], "target": [0, 1, 0]})", "",
            {"wanted one of", "found \"direction\" and \"target\""}),
      light(R"({"type": "spot", "position": [0, 1, 0], "target": [0, 1, 0]})", "/target", {"away from"},
            false),
      light(R"({"type": "spot", "position": [0, 1, 0], "target": [0, 0, 0], "outer_angle": 90})",
            "/outer_angle", {"above 0 and below 90", "found 90"}),
      light(
          R"({"type": "spot", "position": [0, 1, 0], "target": [0, 0, 0], "outer_angle": 20, "inner_angle": 25})",
          "", {"\"inner_angle\"", "20", "found 25"}, false),
      light(R"({"type": "rectangle", "position": [0, 1, 0], "target": [0, 0, 0]})", "",
            {"missing key \"size\""}),
      light(R"({"type": "rectangle", "position": [0, 1, 0], "target": [0, 0, 0], "size": [1]})", "/size",
            {"2 lengths", "1 item"}),
      light(R"({"type": "rectangle", "position": [0, 1, 0], "target": [0, 0, 0], "size": [1, 0]})", "/size/1",
            {"1e-15", "found 0"}),
      light(R"({"type": "disk", "position": [0, 1, 0]})", "", {"\"direction\" or \"target\"", "found none"}),
      light(R"({"type": "sphere", "position": [0, 1, 0], "radius": 0})", "/radius", {"1e-15", "found 0"}),
      light(R"({"type": "sphere", "position": [0, 1, 0], "samples": 0})", "/samples", {"1", "found 0"}),
      light(R"({"type": "sphere", "position": [0, 1, 0], "falloff": {}})", "/falloff", {"unknown key"}),
  });
}

TEST_CASE("bad environments, lenses and moving cameras are refused with their place") {
  const auto environment = [](const std::string& text) { return scene_with(R"("environment": )" + text); };
  const auto camera = [](const std::string& text) {
    return scene_with(R"("camera": {"position": [0, 0, 5], "target": [0, 0, 0], )" + text + "}");
  };
  check({
      {environment("3"), "/environment", {"wanted an object", "found 3"}},
      {environment(R"({"type": "haze"})"),
       "/environment/type",
       {"\"image\", \"gradient\", \"sky\" or \"halo\""}},
      {environment(R"({"type": "image"})"), "/environment", {"missing key \"file\""}},
      {environment(R"({"type": "image", "file": "none.exr"})"), "/environment/file", {"none.exr"}, false},
      {environment(R"({"type": "sky", "turbidity": 1})"), "/environment/turbidity", {"found 1"}},
      {environment(R"({"type": "sky", "sun": {"altitude": 91}})"), "/environment/sun/altitude", {"found 91"}},
      {environment(R"({"type": "halo"})"), "/environment", {"missing key \"crystals\""}},
      {environment(R"({"type": "halo", "crystals": []})"), "/environment/crystals", {"1 to 64"}},
      {environment(R"({"type": "halo", "crystals": [{"shape": "star"}]})"),
       "/environment/crystals/0/shape",
       {"\"parry\" or \"random\""}},
      {environment(R"({"type": "halo", "crystals": [{"shape": "plate", "ratio": 0}]})"),
       "/environment/crystals/0/ratio",
       {"found 0"}},
      {environment(R"({"type": "halo", "crystals": [{"shape": "plate", "share": 0}]})"),
       "/environment/crystals",
       {"share above 0"},
       false},
      {environment(R"({"type": "halo", "crystals": [{"shape": "plate", "size": 1}]})"),
       "/environment/crystals/0/size",
       {"unknown key"}},
      {environment(R"({"type": "halo", "crystals": [{"shape": "plate"}], "ior": 1})"),
       "/environment/ior",
       {"found 1"}},
      {environment(R"({"type": "halo", "crystals": [{"shape": "plate"}], "rays": 1e12})"),
       "/environment/rays",
       {"400000000"}},
      {environment(R"({"type": "halo", "crystals": [{"shape": "plate"}], "cells": 8192})"),
       "/environment/cells",
       {"4096"}},
      {environment(R"({"type": "gradient", "up": [0, 0, 0]})"), "/environment/up", {"length 0"}, false},
      {camera(R"("lens": {"radius": -1})"), "/camera/lens/radius", {"not below 0", "found -1"}},
      {camera(R"("lens": {"blades": 2})"), "/camera/lens/blades", {"3 or more", "found 2"}, false},
      {camera(R"("lens": {"focus": 0})"), "/camera/lens/focus", {"found 0"}},
      {camera(R"("moves_to": {"target": [0, 0, 5]})"), "/camera/moves_to", {"same point"}, false},
      {scene_with(R"("camera": {"moves_to": {}})"), "/camera/moves_to", {"\"position\" and \"target\""}},
  });
}

TEST_CASE("bad materials and media are refused with their place") {
  check({
      {scene_with(R"("materials": [])"), "/materials", {"wanted an object of materials"}},
      material(R"({"colour": [1, 1, 1]})", "/colour", {"unknown key", "did you mean \"color\"?"}),
      material(R"({"type": "metal"})", "/type", {"\"phong\", \"dielectric\" or \"openpbr\"", "\"metal\""}),
      material(R"({"color": 1})", "/color", {"a colour [r, g, b]", "\"checker\"", "found 1"}),
      material(R"({"color": {"texture": "t"}})", "/color", {"a texture is taken by its name alone"}),
      material(R"({"specular": {"texture": "t"}})", "/specular", {"a texture is taken by its name alone"}),
      material(R"({"emission": {"color": {"texture": "t"}}})", "/emission/color",
               {"a texture is taken by its name alone"}),
      material(R"({"type": "openpbr", "base_color": {"texture": "t"}})", "/base_color",
               {"a texture is taken by its name alone"}),
      material(R"({"type": "openpbr", "specular_roughness": {"texture": "t"}})", "/specular_roughness",
               {"a texture is taken by its name alone"}),
      material(R"({"color": {"checker": [[1, 1, 1]]}})", "/color/checker",
               {"2 colours", "found an array of 1 item"}),
      material(R"({"color": {"checker": [[1, 1, 1], [0, 0]]}})", "/color/checker/1", {"a colour", "2 items"}),
      material(R"({"color": {"checker": [[1, 1, 1], [0, 0, 0]], "size": 0}})", "/color/size",
               {"above 0", "found 0"}),
      material(R"({"diffuse": -0.5})", "/diffuse", {"from 0 to 1000000", "found -0.5"}),
      material(R"({"diffuse": true})", "/diffuse", {"a coefficient", "true"}),
      material(R"({"diffuse": {"exponent": 3}})", "/diffuse/exponent", {"unknown key", "coefficient"}),
      material(R"({"specular": {"exponent": -1}})", "/specular/exponent", {"from 0", "found -1"}),
      material(R"({"reflection": 1.5})", "/reflection", {"from 0 to 1", "found 1.5"}),
      material(R"({"transmission": {"color": [1, 1, 2]}})", "/transmission/color/2",
               {"from 0 to 1", "found 2"}),
      material(R"({"type": "dielectric"})", "", {"missing key \"ior\"", "\"medium\""}),
      material(R"({"type": "dielectric", "ior": 1.5, "color": [1, 0, 0]})", "/color", {"transmission"},
               false),
      material(R"({"ior": 0})", "/ior", {"from 0.01 to 100", "found 0"}),
      material(R"({"medium": "ice", "ior": 1.3})", "", {"\"medium\" or \"ior\"", "found both"}),
      material(R"({"ior": 1.3, "thin_walled": true})", "/thin_walled", {"wall is a dielectric"}, false),
      material(R"({"type": "dielectric", "medium": "ice", "thin_walled": true})", "/thin_walled",
               {"an \"ior\" and no \"medium\""}, false),
      material(R"({"type": "dielectric", "thin_walled": true})", "", {"missing key \"ior\"", "a thin wall"}),
      material(R"({"medium": "ice"})", "/medium", {"names no medium", "the string \"ice\""}, false),
      material(R"({"shadow": "none"})", "/shadow", {"\"filter\" or \"opaque\""}),
      material(R"({"shading": 1})", "/shading", {"\"phong\" or \"blinn\"", "found 1"}),
      material(R"({"vertex_color": 1})", "/vertex_color", {"true or false", "found 1"}),
      {scene_with(R"("media": {"a": {"ior": 1000}})"), "/media/a/ior", {"from 0.01 to 100"}},
      {scene_with(R"("media": {"a": {"ior": "BK8"}})"), "/media/a/ior", {"\"BK7\"", "\"diamond\"", "BK8"}},
      {scene_with(R"("media": {"a": {"ior": ["BK7"]}})"), "/media/a/ior", {"number"}},
      {scene_with(R"("media": {"a": {"abbe": 60}})"), "/media/a/abbe", {"\"ior\" beside it"}},
      {scene_with(R"("media": {"a": {"ior": 1.5, "abbe": 0.5}})"), "/media/a/abbe", {"from 1 to 10000"}},
      {scene_with(R"("media": {"a": {"ior": "BK7", "abbe": 60}})"),
       "/media/a/abbe",
       {"a substance's"},
       false},
      {scene_with(R"("media": {"a": {"ior": 90, "abbe": 1}})"),
       "/media/a/abbe",
       {"at 380 nm", "from 0.01 to 100"},
       false},
      {scene_with(R"("media": {"a": {"ior": 1.5, "cauchy": [1.5, 0.004]}})"),
       "/media/a",
       {"\"ior\" or \"cauchy\"", "found both"}},
      {scene_with(R"("media": {"a": {"cauchy": [1.5]}})"), "/media/a/cauchy", {"2 or 3 numbers"}},
      {scene_with(R"("media": {"a": {"cauchy": [1.5, 1e9]}})"), "/media/a/cauchy/1", {"from -1000 to 1000"}},
      {scene_with(R"("media": {"a": {"cauchy": [-1.5, 0.004]}})"), "/media/a/cauchy", {"380 nm"}, false},
      {scene_with(R"("media": {"a": {"sellmeier": [1, 0.01, 0.2]}})"),
       "/media/a/sellmeier",
       {"2, 4, 6 or 8 numbers"},
       false},
      // A pole at 500 nm; a square below zero.
      {scene_with(R"("media": {"a": {"sellmeier": [1, 0.25]}})"), "/media/a/sellmeier", {"nm is"}, false},
      {scene_with(R"("media": {"a": {"sellmeier": [-5, 0.01]}})"), "/media/a/sellmeier", {"nan"}, false},
      material(R"({"ior": "vacuum"})", "/ior", {"\"water\"", "\"vacuum\""}),
      material(R"({"abbe": 50})", "/abbe", {"\"ior\" beside it"}),
      material(R"({"medium": "ice", "abbe": 50})", "", {"\"medium\" or \"abbe\"", "found both"}),
      {scene_with(R"("media": {"a": {"priority": 1001}})"), "/media/a/priority", {"from -1000 to 1000"}},
      {scene_with(R"("media": {"a": {"absorption": 1}})"), "/media/a/absorption", {"[r, g, b]", "found 1"}},
      {scene_with(R"("media": {"a": {"absorption": {"color": [1, 1, 0], "distance": 1}}})"),
       "/media/a/absorption/color/2",
       {"above 0", "found 0"}},
      {scene_with(R"("media": {"a": {"absorption": {"color": [1, 1, 1]}}})"),
       "/media/a/absorption",
       {"missing key \"distance\""}},
  });
}

TEST_CASE("bad objects are refused with their place") {
  check({
      object("[]", "", {"wanted an object", "an array of 0 items"}),
      object("{}", "", {"missing key \"type\"", "\"sphere\"", "\"group\""}),
      object(R"({"type": "shpere"})", "/type", {"did you mean \"sphere\"?"}),
      object(R"({"type": "sphere"})", "", {"missing key \"material\""}, false),
      object(R"({"type": "sphere", "material": "n"})", "/material",
             {"the name of a material", "the scene has \"m\"", "found the string \"n\""}, false),
      object(R"({"type": "sphere", "material": "glass"})", "/material", {"the scene has \"m\""}, false),
      object(R"({"type": "sphere", "material": {}})", "/material", {"wanted a string", "found an object"}),
      object(R"({"type": "sphere", "material": "m", "name": ""})", "/name",
             {"wanted a string", "an empty string"}),
      sphere(R"("radius": 0)", "/radius", {"above 0", "found 0"}),
      sphere(R"("radius": 1e19)", "/radius", {"up to 1e+18", "found 1e+19"}),
      sphere(R"("center": [1e30, 0, 0])", "/center/0", {"of magnitude up to 1e+18", "found 1e+30"}),
      sphere(R"("half": 1)", "/half", {"unknown key \"half\"", "radius"}),
      object(R"({"type": "plane", "material": "m", "normal": [0, 0, 0]})", "/normal", {"length 0"}, false),
      object(R"({"type": "box", "material": "m", "half": 1, "min": [0, 0, 0], "max": [1, 1, 1]})", "",
             {"\"half\" or \"min\"", "found both"}),
      object(R"({"type": "box", "material": "m", "max": [1, 1, 1]})", "", {"missing key \"min\""}),
      object(R"({"type": "box", "material": "m", "min": [0, 0, 0], "max": [1, 0, 1]})", "", {"\"min\" below"},
             false),
      object(R"({"type": "box", "material": "m", "half": [1, 1]})", "/half", {"3 numbers"}),
      object(R"({"type": "box", "material": "m", "half": [1, 0, 1]})", "/half/1", {"above 0"}),
      object(R"({"type": "round_box", "material": "m", "half": [1, 0.2, 1], "radius": 0.3})", "/radius",
             {"up to 0.2", "found 0.3"}, false),
      object(R"({"type": "cylinder", "material": "m", "height": 1, "from": [0, 0, 0], "to": [0, 1, 0]})", "",
             {"\"height\" or \"from\"", "both"}),
      object(R"({"type": "cylinder", "material": "m", "from": [0, 0, 0]})", "", {"missing key \"to\""}),
      object(R"({"type": "cylinder", "material": "m", "from": [1, 2, 3], "to": [1, 2, 3]})", "/to", {"same"},
             false),
      object(R"({"type": "cone", "material": "m", "bottom_radius": 0})", "", {"\"top_radius\"", "both 0"},
             false),
      object(R"({"type": "rectangle", "material": "m", "size": [1, 2, 3]})", "/size",
             {"an array of 2 lengths"}),
      object(R"({"type": "disk", "material": "m", "inner_radius": 1})", "/inner_radius",
             {"below 1", "found 1"}, false),
      object(R"({"type": "torus", "material": "m", "minor_radius": 2})", "/minor_radius",
             {"below 1", "found 2"}, false),
      object(R"({"type": "group"})", "", {"missing key \"objects\""}),
      object(
          R"({"type": "group", "objects": [{"type": "group", "material": "m", "objects": [{"type": "disk", "x": 1}]}]})",
          "/objects/0/objects/0/x", {"unknown key \"x\""}),
  });
}

TEST_CASE("bad meshes and models are refused with their place") {
  check({
      object(R"({"type": "mesh"})", "", {"missing key \"mesh\""}),
      object(R"({"type": "mesh", "mesh": "bunny"})", "/mesh", {"the scene names no mesh", "\"bunny\""},
             false),
      object(R"({"type": "model", "file": "none.ply"})", "/file", {"none.ply\" does not exist"}, false),
      object(R"({"type": "model", "file": "."})", "/file", {"is a folder"}, false),
      object(R"({"type": "model", "file": "scene.json"})", "/file",
             {"a model file", ".gltf", "\"scene.json\""}, false),
      object(R"({"type": "model", "file": 3})", "/file", {"wanted a string", "found 3"}),
      {scene_with(R"("meshes": {"a": {}})"),
       "/meshes/a",
       {"wanted one of \"file\" or \"generate\"", "found none"}},
      {scene_with(R"("meshes": {"a": {"flie": "tetra.ply"}})"), "/meshes/a/flie", {"did you mean \"file\"?"}},
      {scene_with(R"("meshes": {"a": {"file": "gone.obj"}})"), "/meshes/a/file", {"does not exist"}, false},
      {scene_with(R"("meshes": {"a": {"file": "tetra.ply", "crease_angle": 181}})"),
       "/meshes/a/crease_angle",
       {"from 0 to 180", "found 181"}},
      {scene_with(R"("meshes": {"a": {"generate": {"type": "ice_block"}, "crease_angle": 3}})"),
       "/meshes/a/crease_angle",
       {"unknown key"}},
      {scene_with(R"("meshes": {"a": {"generate": {}}})"), "/meshes/a/generate", {"missing key \"type\""}},
      {scene_with(R"("meshes": {"a": {"generate": {"type": "snow"}}})"),
       "/meshes/a/generate/type",
       {"\"snow\""}},
      {scene_with(R"("meshes": {"a": {"generate": {"type": "ice_block", "sed": 1}}})"),
       "/meshes/a/generate/sed",
       {"did you mean \"seed\"?"}},
  });
}

TEST_CASE("bad transforms are refused with their place") {
  const auto transform = [](const std::string& list, const std::string& place, std::vector<std::string> words,
                            bool schema = true) {
    return sphere(R"("transform": )" + list, "/transform" + place, std::move(words), schema);
  };
  check({
      transform("{}", "", {"wanted an array of transforms", "found an object"}),
      transform("[{}]", "/0", {"wanted one of", "\"translate\"", "\"matrix\"", "found none"}),
      transform(R"([{"translate": [0, 0, 0], "scale": 2}])", "/0", {"found \"translate\" and \"scale\""}),
      transform(R"([{"rotation": 3}])", "/0/rotation", {"unknown key", "did you mean \"rotate\"?"}),
      transform(R"([{"rotate": {"degrees": 30}}])", "/0/rotate", {"missing key \"axis\""}),
      transform(R"([{"rotate": {"axis": [0, 0, 0], "degrees": 30}}])", "/0/rotate/axis", {"length 0"}, false),
      transform(R"([{"scale": 2}, {"scale": 0}])", "/1/scale", {"singular", "not 0"}),
      transform(R"([{"scale": [1, 0, 1]}])", "/0/scale", {"singular", "not 0"}, false),
      transform(R"([{"scale": "2"}])", "/0/scale", {"a factor", "found the string \"2\""}),
      transform(R"([{"matrix": [1, 0, 0, 0]}])", "/0/matrix", {"16 numbers", "4 items"}),
      transform(R"([{"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,5,5,1]}])", "/0/matrix", {"last row is 0 0 0 1"},
                false),
      transform(R"([{"matrix": [1,2,0,0, 2,4,0,0, 0,0,1,0, 0,0,0,1]}])", "/0", {"singular"}, false),
      transform(R"([{"matrix": [1,2,3,0, 4,5,6,0, 7,8,9,0, 0,0,0,1]}])", "/0", {"singular"}, false),
      transform(R"([{"scale": 1e10}, {"scale": 1e10}])", "", {"range of floats"}, false),
      transform(R"([{"scale": 1e-10}, {"scale": 1e-10}])", "", {"singular"}, false),
      object(R"({"type": "group", "transform": [{"scale": 1e-9}], "material": "m", "objects": [
                 {"type": "sphere", "transform": [{"scale": 1e-9}]}]})",
             "/objects/0/transform", {"singular"}, false),
      sphere(R"("turns_by": {"degrees": 10})", "/turns_by", {"axis"}),
      sphere(R"("turns_by": {"axis": [0, 0, 0], "degrees": 10})", "/turns_by/axis", {"length 0"}, false),
      sphere(R"("turns_by": {"axis": [0, 1, 0], "degrees": 1e6})", "/turns_by/degrees", {"36000"}),
      sphere(R"("turns_by": 10)", "/turns_by", {"object"}),
      sphere(R"("grows_to": 0)", "/grows_to", {"0.001", "found 0"}),
  });
}
