// Rays that leave solids which they had not entered: the warning names the objects at fault.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

/// A tetrahedron whose faces look inwards.
constexpr const char* turned = R"(v -1 -1 -1
v 1 -1 -1
v 0 -1 1
v 0 1 0
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
)";

/// The warnings of a render of the small scene with `objects` in place of its ball.
std::string warnings_with(const std::string& objects) {
  const CliFolder folder;
  folder.write("turned.obj", turned);
  nlohmann::json scene = nlohmann::json::parse(small_scene);
  scene["objects"].erase(1);
  for (const nlohmann::json& object : nlohmann::json::parse(objects)) scene["objects"].push_back(object);
  // Out of sight: a mesh and disks of no glass, so that one kernel draws all of these scenes.
  const auto count = [&](const char* type) {
    return std::ranges::count_if(scene["objects"],
                                 [&](const auto& object) { return object["type"] == type; });
  };
  while (count("model") < 1)
    scene["objects"].push_back({{"type", "model"},
                                {"file", "turned.obj"},
                                {"material", "floor"},
                                {"transform", {{{"translate", {0, 0, 90}}}}}});
  while (count("disk") < 7)
    scene["objects"].push_back({{"type", "disk"}, {"center", {0, 0, 99}}, {"material", "floor"}});
  const std::string file = folder.write("strays.json", scene.dump()).string();
  const CommandResult result = run_sundog({"render", file, "--quiet", "-o", folder.file("a.pfm")});
  CHECK(result.status == 0);
  return result.err;
}

}  // namespace

TEST_CASE("a mesh that is inside out is named in a warning of its own") {
  const std::string text =
      warnings_with(R"([{"type": "model", "file": "turned.obj", "name": "jug", "material": "glass"}])");
  CHECK_THAT(text, ContainsSubstring(" rays left a solid that they had not entered, in at most "));
  CHECK_THAT(text, ContainsSubstring("\"jug: turned\" is inside out"));
  CHECK_THAT(text, !ContainsSubstring("closed"));
}

TEST_CASE("shapes without an inside are named, many of them in short") {
  const std::string pane = R"({"type": "disk", "material": "glass", "radius": 3, "normal": [0, 0, -1])";
  CHECK_THAT(warnings_with("[" + pane + "}]"), ContainsSubstring("/objects/1 has an interior"));
  std::string many = "[" + pane + R"(, "name": "a"})";
  for (const char* name : {"b", "c", "d", "e", "f", "g"})
    many += "," + pane + ", \"name\": \"" + name + "\"}";
  CHECK_THAT(warnings_with(many + "]"),
             ContainsSubstring(R"("a", "b", "c", "d" and 3 more have an interior)"));
}
