// Loads scenes from text in a folder of their own.
#include "scene_text.h"

#include <fmt/format.h>
#include "catch.h"
#include "scene/load.h"

using namespace sundog;

const std::string_view tetrahedron_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

SceneDescription load_scene_text(std::string_view text, const std::vector<std::string>& overrides) {
  const TemporaryFolder folder;
  folder.write("tetra.ply", tetrahedron_ply);
  return load_scene(folder.write("scene.json", text), overrides);
}

SceneError error_of(std::string_view text, const std::vector<std::string>& overrides) {
  try {
    load_scene_text(text, overrides);
  } catch (const SceneError& error) {
    return error;
  }
  FAIL("no error for " << text);
  return {"", "", ""};
}

std::string scene_with(std::string_view members) {
  const char* comma = members.empty() ? "" : ",";
  const bool own_materials = members.find("\"materials\"") != std::string_view::npos;
  return fmt::format(R"({{{}{}{} "objects": [{{"type": "sphere", "material": "m"}}]}})", members, comma,
                     own_materials ? "" : R"( "materials": {"m": {}},)");
}

std::string scene_of(std::string_view object) {
  return fmt::format(R"({{"materials": {{"m": {{}}}}, "objects": [{}]}})", object);
}
