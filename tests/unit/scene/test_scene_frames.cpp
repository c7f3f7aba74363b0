// Frames that are read one after the other are those that are read alone, and read nothing twice.
#include <compile/compiled_scene.h>
#include <fmt/format.h>
#include <render/film/hash.h>

#include "catch.h"
#include "scene/load.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr const char* tetrahedron = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 {}
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
)";

struct FramesFolder : TemporaryFolder {
  FramesFolder() {
    write("a.ply", fmt::format(tetrahedron, 1));
    write("b.ply", fmt::format(tetrahedron, 2));
  }
  std::filesystem::path scene(const std::string& tracks) const {
    return write("scene.json", fmt::format(R"({{
      "camera": {{"position": [0, 1, 5], "target": [0, 0, 0]}}, "lights": [{{"type": "ambient"}}],
      "materials": {{"m": {{}}}},
      "meshes": {{"t": {{"file": "a.ply"}}, "i": {{"generate": {{"type": "ice_block", "subdivision": 4}}}}}},
      "objects": [{{"type": "mesh", "mesh": "t", "material": "m", "transform": [{{"translate": [0, 0, 0]}}]}},
        {{"type": "mesh", "mesh": "i", "material": "m"}}],
      "animate": [{}]}})",
                                           tracks));
  }
};

std::uint64_t look(const SceneDescription& scene) { return hash_scene(compile(scene)); }

std::string keyed(const char* value, const char* first, const char* second) {
  return fmt::format(
      R"({{"type": "linear", "value": "{}", "keys": [{{"frame": 0, "value": {}}}, {{"frame": 2, "value": {}}}]}})",
      value, first, second);
}

}  // namespace

TEST_CASE("frames in a row are the frames alone, whatever moves") {
  const FramesFolder folder;
  const std::string tracks =
      GENERATE(keyed("/camera/fov", "30", "50"), keyed("/lights/0/intensity", "1", "2"),
               keyed("/materials/m/color", "[0, 0, 0]", "[1, 1, 1]"),
               keyed("/objects/0/transform/0/translate", "[0, 0, 0]", "[1, 2, 3]"),
               keyed("/meshes/t/file", R"("a.ply")", R"("b.ply")"),
               keyed("/meshes/i/generate/size", "[1, 1, 1]", "[1, 2, 1]"));
  CAPTURE(tracks);
  const auto file = folder.scene(tracks);
  SceneFrames frames(file, {}, {});
  frames.check({0, 1, 2});
  std::vector<std::uint64_t> looks;
  for (const double frame : {0.0, 1.0, 2.0, 0.0}) {
    looks.push_back(look(*frames.read(frame)));
    CHECK(looks.back() == look(load_scene(file, {}, {.frame = frame})));
  }
  CHECK(looks[0] != looks[2]);
}

TEST_CASE("files that frames have in common are read once") {
  const FramesFolder folder;
  const auto file = folder.scene(keyed("/objects/0/transform/0/translate", "[0, 0, 0]", "[1, 2, 3]"));
  SceneFrames frames(file, {}, {});
  const std::uint64_t first = look(*frames.read(0));
  folder.write("a.ply", "no model any more");
  folder.write("scene.json", "no scene any more");
  CHECK(look(*frames.read(2)) != first);
  CHECK(look(*frames.read(0)) == first);
}

TEST_CASE("a check of frames finds what is wrong in any of them, without the meshes of each") {
  const FramesFolder folder;
  SceneFrames changing(folder.scene(keyed("/meshes/i/generate/roughness", "0", "5")), {}, {});
  CHECK_NOTHROW(changing.check({0}));
  try {
    changing.check({0, 1, 2});
    FAIL("no error");
  } catch (const SceneError& error) {
    CHECK(error.place == "/meshes/i/generate/roughness");
    CHECK(error.reason.find("(in frame 1, moved by /animate/0)") != std::string::npos);
  }
  SceneFrames sequence(folder.scene(keyed("/meshes/t/file", R"("a.ply")", R"("missing.ply")")), {}, {});
  CHECK_THROWS_AS(sequence.check({0, 1, 2}), SceneError);
}
