// Malformed model files: the optional assets', each with its validator's own report, and hostile ones written
// here.
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "assets.h"
#include "catch.h"
#include "model_files.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

// The rule: a file in which the validator found no error must load, and one with an error must be refused
// with its place, unless all its errors are of these kinds. They concern what is not read (skins,
// custom attributes, textures, extensions at the wrong place), or contradict nothing that is (missing
// bounds, an empty list, a buffer view's hint of use).
const std::set<std::string> not_read{"UNEXPECTED_EXTENSION_OBJECT",
                                     "BUFFER_MISSING_GLB_DATA",
                                     "EMPTY_ENTITY",
                                     "BUFFER_VIEW_TARGET_OVERRIDE",
                                     "GLB_CHUNK_LENGTH_UNALIGNED",
                                     "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
                                     "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
                                     "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
                                     "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
                                     "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
                                     "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
                                     "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
                                     "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR"};

bool must_be_refused(const fs::path& report) {
  std::ifstream in(report);
  const auto messages = nlohmann::json::parse(in).at("issues").at("messages");
  for (const auto& message : messages) {
    const bool lost_offset = message.value("pointer", "").ends_with("/byteOffset") &&
                             message.at("code") == "UNSATISFIED_DEPENDENCY";  // only warned of
    if (message.at("severity") == 0 && not_read.count(message.at("code")) == 0 && !lost_offset) return true;
  }
  return false;
}

std::vector<fs::path> files_in(const fs::path& folder, const std::set<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && extensions.count(entry.path().extension().string()))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

const std::string asset = R"("asset":{"version":"2.0"})";

}  // namespace

TEST_CASE(
    "glTF files are refused where their validator's report has an error that matters, and load where not",
    "[assets]") {
  if (assets_directory().empty()) return;
  const auto files = files_in(assets_directory() / "malformed/gltf-validator", {".gltf", ".glb"});
  REQUIRE(files.size() > 120);
  for (const fs::path& file : files) {
    INFO(file);
    const std::string error = load_error(file);
    INFO(error);
    CHECK(error.empty() != must_be_refused(file.string() + ".report.json"));
  }
}

TEST_CASE("files that broke other readers give an error with its place", "[assets]") {
  if (assets_directory().empty()) return;
  const fs::path folder = assets_directory() / "malformed";
  CHECK_THAT(load_error(folder / "assimp/malformed.obj"), ContainsSubstring("line 23: vertex 12"));
  CHECK_THAT(load_error(folder / "assimp/malformed2.obj"),
             ContainsSubstring("line 23: a face without corners"));
  CHECK_THAT(load_error(folder / "assimp/empty.obj"), ContainsSubstring("empty"));
  CHECK_THAT(load_error(folder / "assimp/empty.ply"), ContainsSubstring("empty"));
  CHECK_THAT(load_error(folder / "assimp/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply"),
             ContainsSubstring("line 7"));
  const fs::path bounds = folder / "tinygltf/BoundsChecking";
  CHECK_THAT(load_error(bounds / "integer-out-of-bounds.gltf"),
             ContainsSubstring("/bufferViews/0/byteLength"));
  CHECK_THAT(load_error(bounds / "invalid-buffer-index.gltf"), ContainsSubstring("/bufferViews/1/buffer"));
  CHECK_THAT(load_error(bounds / "invalid-buffer-view-index.gltf"),
             ContainsSubstring("/bufferViews/0/buffer"));
  CHECK_THAT(load_error(bounds / "invalid-primitive-indices.gltf"),
             ContainsSubstring("/bufferViews/0/buffer"));
  CHECK(load_model(folder / "tinygltf/regression/unassigned-skeleton.gltf").meshes.size() == 1);
  CHECK(load_model(folder / "tinygltf/regression/zero-sized-bin-chunk-issue-440.glb").meshes.size() == 1);
}

TEST_CASE("deeply nested JSON neither overflows the stack nor hangs", "[models]") {
  const std::string open(2000000, '['), close(2000000, ']');
  CHECK(load_error("a.gltf", "{" + asset + R"(,"extras":)" + open + close + "}").empty());
  CHECK_THAT(load_error("a.gltf", "{" + asset + R"(,"nodes":)" + open + close + "}"),
             ContainsSubstring("/nodes/0: an object wanted"));
  CHECK_THAT(load_error("a.gltf", open), ContainsSubstring("not valid JSON"));
}

TEST_CASE("a chain of very many nodes is walked without recursion", "[models]") {
  std::string nodes = "{}";
  for (int i = 0; i < 100000; ++i) nodes += R"(,{"children":[)" + std::to_string(i) + "]}";
  CHECK(load_error("a.gltf", "{" + asset + R"(,"nodes":[)" + nodes + "]}").empty());
}

TEST_CASE("a small file cannot ask for a huge allocation", "[models]") {
  CHECK_THAT(load_error("a.gltf", "{" + asset + R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"componentType":5126,"type":"VEC3","count":4000000000}]})"),
             ContainsSubstring("/accessors/0") && ContainsSubstring("would grow"));
  std::string primitives = R"({"attributes":{"POSITION":0},"mode":5})";
  for (int i = 0; i < 2000; ++i) primitives += R"(,{"attributes":{"POSITION":0},"mode":5})";
  CHECK_THAT(load_error("a.gltf", "{" + asset + R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[)" + primitives +
                                      R"(]}],
      "accessors":[{"componentType":5126,"type":"VEC3","count":100000}]})"),
             ContainsSubstring("would grow"));
}

TEST_CASE("every shortened and every damaged copy of a file ends in an error or loads", "[models]") {
  const std::string obj =
      "mtllib x\nusemtl y\nv 0 0 0\nv 1 0 0 1 1 1\nv 0 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/1/1 -1//1\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string stl =
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid\n";
  const std::string nff =
      "v\nfrom 0 0 1\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\nl 1 2 3\n"
      "f 1 1 1 1 0 0 0 0\ns 0 0 0 1\nc 0 0 0 1 0 0 1 1\np 3\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string gltf =
      "{" + asset +
      R"(,"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"scale":[1,2,3]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const TemporaryFolder folder;
  std::size_t refused = 0;
  const std::map<std::string, std::string> files{
      {".obj", obj}, {".ply", ply}, {".stl", stl}, {".nff", nff}, {".gltf", gltf}};
  std::istringstream formats(SUNDOG_MODEL_EXTENSIONS);
  for (std::string format; formats >> format;) {
    if (format == ".glb") continue;  // glTF in a container
    INFO("a format needs a file here: " << format);
    REQUIRE(files.contains(format));
    const std::string name = "a" + format, text = files.at(format);
    REQUIRE(load_error(folder.write(name, text)).empty());
    for (std::size_t i = 0; i < text.size(); ++i) {
      refused += !load_error(folder.write(name, text.substr(0, i))).empty();
      for (const char c : {'\0', '9', '-', ' ', '/', '\xff'}) {
        std::string damaged = text;
        damaged[i] = c;
        refused += !load_error(folder.write(name, damaged)).empty();
      }
    }
  }
  CHECK(refused > 2000);
}
