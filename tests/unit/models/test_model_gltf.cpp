// glTF and GLB, from small files written here: buffers, nodes and meshes.
#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"

using namespace sundog;

namespace {

dvec3 at(const dmat4& m, dvec3 p) { return dvec3(m * glm::dvec4(p, 1)); }
bool near(dvec3 a, dvec3 b) { return glm::length(a - b) < 1e-6; }

}  // namespace

TEST_CASE("a glTF's buffer may be a data URI, a file beside it, or a GLB's chunk", "[models]") {
  const std::string rest =
      quad_views + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)" + one_node;
  const TemporaryFolder folder;
  folder.write("sub folder/q.bin", quad_bytes());
  const std::string file = document(R"("buffers":[{"byteLength":72,"uri":"sub%20folder/q.bin"}],)" + rest);
  const Model models[] = {
      load_text("a.gltf", quad(one_node)), load_model(folder.write("a.gltf", file)),
      load_text("a.glb", glb(document(R"("buffers":[{"byteLength":72}],)" + rest), quad_bytes())),
      load_text("a.glb.gz",
                gzipped(glb(document(R"("buffers":[{"byteLength":72}],)" + rest), quad_bytes())))};
  for (const Model& model : models) {
    CHECK(area_of(model.meshes.at(0)) == 4);
    CHECK(model.meshes[0].source_vertex_count == 4);
    CHECK(model.meshes[0].normals.empty());
    CHECK(model.objects.size() == 1);
  }
}

TEST_CASE("a missing buffer file is an error that names it, a missing texture is none", "[models]") {
  CHECK_THAT(load_error("a.gltf", document(R"("buffers":[{"byteLength":4,"uri":"gone.bin"}])")),
             ContainsSubstring("/buffers/0/uri") && ContainsSubstring("gone.bin cannot be read"));
  CHECK(load_error("a.gltf", quad(one_node + R"(,"images":[{"uri":"gone.png"}],"textures":[{"source":0}],
    "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
                                  R"(,"material":0)"))
            .empty());
}

TEST_CASE("a glTF's names may hold percent signs, encoded or not", "[models]") {
  const std::string rest =
      quad_views + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)" + one_node;
  for (const auto& [file, uri] : {std::pair("my data 10%.bin", "my data 10%.bin"),
                                  {"a%20b.bin", "a%20b.bin"},
                                  {"100%25.bin", "100%25.bin"},
                                  {"50%.bin", "50%25.bin"}}) {
    const TemporaryFolder folder;
    folder.write(file, quad_bytes());
    const std::string text =
        document(R"("buffers":[{"byteLength":72,"uri":")" + std::string(uri) + R"("}],)" + rest);
    CHECK(load_error(folder.write("a.gltf", text)).empty());
  }
}

TEST_CASE("an image of a glTF that cannot be had is a warning, and its material goes without", "[models]") {
  for (const std::string image :
       {R"({"uri":"http://example.com/a.png"})", R"({"uri":"../a.png"})", R"({"uri":"gone.png"})",
        R"({"bufferView":9})", R"({})", R"({"uri":"data:image/png;base64,?"})"}) {
    CAPTURE(image);
    const Model model =
        load_text("a.gltf", quad(one_node + R"(,"images":[)" + image + R"(],"textures":[{"source":0}],
    "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
                                 R"(,"material":0)"));
    CHECK(model.materials.at(0).textures.diffuse == -1);
    REQUIRE(model.warnings.size() == 1);
    CHECK_THAT(model.warnings[0], ContainsSubstring("/images/0"));
  }
  const Model basis = load_text("a.gltf", quad(one_node + R"(,"images":[{"uri":"a.ktx2"}],
    "textures":[{"extensions":{"KHR_texture_basisu":{"source":0}}}],
    "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])",
                                               R"(,"material":0)"));
  CHECK(basis.unread == std::vector<std::string>{"images of other formats than PNG, JPEG and WebP"});
}

TEST_CASE("attributes of a glTF's vertices that are no numbers count as missing, with a warning",
          "[models]") {
  std::string bytes;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  put<float>(bytes, {0, 0, 0, 2, 0, 0, 0, 2, 0, nan, nan, nan});
  put<float>(bytes, {nan, nan, nan, 0, 0, 1, 0, 0, 1, nan, nan, nan});
  const Model model = load_text(
      "a.gltf", document(R"("buffers":[{"byteLength":96,"uri":"data:application/octet-stream;base64,)" +
                         base64(bytes) + R"("}],"bufferViews":[{"buffer":0,"byteLength":48},
    {"buffer":0,"byteOffset":48,"byteLength":48}],"accessors":[
    {"bufferView":0,"componentType":5126,"type":"VEC3","count":4},
    {"bufferView":1,"componentType":5126,"type":"VEC3","count":4}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1}}]}],)" +
                         one_node));
  for (const glm::vec3& n : model.meshes.at(0).normals) CHECK(n == glm::vec3(0, 0, 1));
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("/meshes/0: 1 attributes of vertices are no numbers"));
}

TEST_CASE("a skin places its mesh by its joints, whatever its node's transform", "[models]") {
  // A triangle whose second corner hangs at a joint that has moved by (0, 0, 3) since it was bound.
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  put<float>(bytes, {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
  put<float>(bytes, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  put<float>(bytes, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -2, 1});
  put<std::uint8_t>(bytes, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
  const std::string rest = R"("bufferViews":[{"buffer":0,"byteLength":36},
    {"buffer":0,"byteOffset":36,"byteLength":48},{"buffer":0,"byteOffset":84,"byteLength":128},
    {"buffer":0,"byteOffset":212,"byteLength":12}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
    {"bufferView":1,"componentType":5126,"type":"VEC4","count":3},
    {"bufferView":2,"componentType":5126,"type":"MAT4","count":2},
    {"bufferView":3,"componentType":5121,"type":"VEC4","count":3}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":3}}]}],
    "skins":[{"joints":[1,2],"inverseBindMatrices":2}],
    "scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"translation":[100,0,0],"scale":[5,5,5]},
    {"translation":[10,0,0],"children":[2]},{"translation":[0,0,5]}])";
  const Model model = load_text(
      "a.gltf", document(R"("buffers":[{"byteLength":224,"uri":"data:application/octet-stream;base64,)" +
                         base64(bytes) + R"("}],)" + rest));
  CHECK(model.objects.at(0).world_from_object == dmat4(1));
  const Mesh& mesh = model.meshes.at(0);
  CHECK(mesh.positions.at(0) == glm::vec3(10, 0, 0));
  CHECK(mesh.positions.at(1) == glm::vec3(11, 0, 3));
  CHECK(mesh.positions.at(2) == glm::vec3(10, 1, 1.5f));
}

TEST_CASE("a buffer that is not fetched is an error only for who reads it", "[models]") {
  const std::string buffers =
      R"("buffers":[{"byteLength":72,"uri":"http://example.com/q.bin"}],)" + quad_views;
  CHECK(load_error("a.gltf", document(buffers)).empty());
  CHECK_THAT(load_error("a.gltf",
                        document(buffers + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1}}]}],)" +
                                 one_node)),
             ContainsSubstring("/accessors/1: buffer 0 is not at hand"));
}

TEST_CASE("glTF's nodes place meshes by their whole chain, and share them", "[models]") {
  const Model model = load_text("a.gltf", quad(R"("scene":1,"scenes":[{"nodes":[3]},{"nodes":[0]}],"nodes":[
    {"children":[1,2],"translation":[10,0,0]},
    {"name":"turned","mesh":0,"rotation":[0,0,0.70710678,0.70710678],"scale":[2,1,1]},
    {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]},{"mesh":0}])"));
  REQUIRE(model.objects.size() == 2);
  CHECK(model.meshes.size() == 1);
  CHECK(model.objects[0].name == "turned");
  CHECK(model.objects[0].place == "/nodes/1");
  CHECK(near(at(model.objects[0].world_from_object, {1, 0, 0}), {10, 2, 0}));
  CHECK(model.objects[1].name == "quad");
  CHECK(near(at(model.objects[1].world_from_object, {0, 0, 0}), {15, 6, 7}));
}

TEST_CASE("glTF's instancing extension makes an object of each instance", "[models]") {
  std::string bytes = quad_bytes();
  put<float>(bytes, {1, 0, 0, 0, 5, 0});
  put<std::int16_t>(bytes, {0, 0, 0, 32767, 0, 0, 23170, 23170});
  put<float>(bytes, {1, 1, 1, 2, 2, 2});
  const std::string uri =
      R"("buffers":[{"byteLength":136,"uri":"data:application/octet-stream;base64,)" + base64(bytes);
  const Model model =
      load_text("a.gltf", document(uri + R"("}],"bufferViews":[{"buffer":0,"byteOffset":8,"byteLength":48},
    {"buffer":0,"byteOffset":72,"byteLength":24},{"buffer":0,"byteOffset":96,"byteLength":16},
    {"buffer":0,"byteOffset":112,"byteLength":24}],"accessors":[
    {"bufferView":0,"componentType":5126,"type":"VEC3","count":4},{"bufferView":1,"componentType":5126,"type":"VEC3","count":2},
    {"bufferView":2,"componentType":5122,"normalized":true,"type":"VEC4","count":2},
    {"bufferView":3,"componentType":5126,"type":"VEC3","count":2}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "nodes":[{"mesh":0,"translation":[0,0,9],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":
    {"TRANSLATION":1,"ROTATION":2,"SCALE":3}}}}])"));
  REQUIRE(model.objects.size() == 2);
  CHECK(near(at(model.objects[0].world_from_object, {1, 1, 0}), {2, 1, 9}));
  CHECK(near(at(model.objects[1].world_from_object, {1, 0, 0}), {0, 7, 9}));
}

TEST_CASE("glTF's primitive modes give triangles of one winding, or none", "[models]") {
  std::string bytes;
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  const auto load = [&](int mode) {
    return load_text(
        "a.gltf", document(R"("buffers":[{"byteLength":60,"uri":"data:application/gltf-buffer;base64,)" +
                           base64(bytes) +
                           R"("}],"bufferViews":[{"buffer":0,"byteLength":60}],"accessors":[{"bufferView":0,
        "componentType":5126,"type":"VEC3","count":5}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":)" +
                           std::to_string(mode) + "}]}]," + one_node));
  };
  for (const int mode : {0, 1, 2, 3}) CHECK(load(mode).objects.empty());
  CHECK(load(4).meshes.at(0).triangles.size() == 1);
  const Mesh strip = load(5).meshes.at(0);
  REQUIRE(strip.triangles.size() == 3);
  for (const glm::uvec3 t : strip.triangles)
    CHECK(glm::cross(strip.positions[t.y] - strip.positions[t.x], strip.positions[t.z] - strip.positions[t.x])
              .z > 0);
  const Mesh fan = load(6).meshes.at(0);
  REQUIRE(fan.triangles.size() == 3);
  CHECK(fan.triangles[1] == glm::uvec3(2, 3, 0));
  CHECK_THAT(load_error("a.gltf", quad(one_node, R"(,"mode":7)")),
             ContainsSubstring("/meshes/0/primitives/0/mode"));
}

TEST_CASE("sparse accessors replace some elements, of data or of zeros", "[models]") {
  std::string bytes = quad_bytes();
  put<std::uint16_t>(bytes, {1, 3});
  put<float>(bytes, {7, 0, 0, 0, 8, 0});
  for (const bool zeros : {false, true}) {
    const std::string base = zeros ? "" : R"("bufferView":1,)";
    const Model model = load_text(
        "a.gltf",
        document(
            R"("buffers":[{"byteLength":100,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
            R"("}],"bufferViews":[{"buffer":0,"byteLength":6},{"buffer":0,"byteOffset":8,"byteLength":48},
      {"buffer":0,"byteOffset":72,"byteLength":4},{"buffer":0,"byteOffset":76,"byteLength":24}],
      "accessors":[{"bufferView":0,"componentType":5121,"type":"SCALAR","count":6},{)" +
            base +
            R"("componentType":5126,"type":"VEC3","count":4,"sparse":{"count":2,
      "indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":3}}}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)" +
            one_node));
    const auto& p = model.meshes.at(0).positions;
    CHECK(p.at(1) == glm::vec3(7, 0, 0));
    CHECK(p.at(2) == (zeros ? glm::vec3(0) : glm::vec3(2, 2, 0)));
    CHECK(p.at(3) == glm::vec3(0, 8, 0));
  }
}

TEST_CASE("interleaved attributes and vertex colours are read", "[models]") {
  const Model model = load_text(
      "a.gltf",
      document(quad_buffer() + "," + quad_views +
               R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1,"COLOR_0":2},"indices":0}]}],)" +
               one_node));
  CHECK(model.meshes.at(0).colors.at(0) == glm::vec3(1, 0, 0));
  CHECK(model.meshes[0].colors.at(2) == glm::vec3(0.2f));
  CHECK(model.materials.at(0).vertex_color);
  std::string bytes;  // position, padding, normal
  for (const float x : {0.0f, 1.0f, 2.0f}) put<float>(bytes, {x, x * x, 0, 99, 0, 0, 3});
  const Mesh mesh =
      load_text("a.gltf",
                document(R"("buffers":[{"byteLength":84,"uri":"data:application/octet-stream;base64,)" +
                         base64(bytes) + R"("}],"bufferViews":[{"buffer":0,"byteLength":84,"byteStride":28}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
    {"bufferView":0,"byteOffset":16,"componentType":5126,"type":"VEC3","count":3}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1}}]}],)" +
                         one_node))
          .meshes.at(0);
  CHECK(mesh.positions.at(2) == glm::vec3(2, 4, 0));
  CHECK(mesh.normals == std::vector<glm::vec3>(3, {0, 0, 1}));
}

TEST_CASE("a glTF mesh without normals is flat, or smooth when a crease angle is given", "[models]") {
  ModelOptions options;
  options.crease_angle = 30;
  CHECK(load_text("a.gltf", quad(one_node)).meshes.at(0).normals.empty());
  CHECK(load_text("a.gltf", quad(one_node), options).meshes.at(0).normals ==
        std::vector<glm::vec3>(4, {0, 0, 1}));
}

TEST_CASE("a bad glTF is refused with its JSON pointer", "[models]") {
  const auto error = [](const std::string& members) { return load_error("a.gltf", quad(members)); };
  CHECK_THAT(error(R"("nodes":[{"mesh":1}])"),
             ContainsSubstring("/nodes/0/mesh: mesh 1 does not exist: there are 1"));
  CHECK_THAT(error(R"("nodes":[{"children":[1]},{"children":[0]}],"scenes":[{"nodes":[0]}])"),
             ContainsSubstring("/scenes/0/nodes/0"));
  CHECK_THAT(error(R"("nodes":[{"children":[0]}])"), ContainsSubstring("/nodes/0/children/0"));
  CHECK_THAT(error(R"("nodes":[{"children":[2]},{"children":[2]},{}])"),
             ContainsSubstring("/nodes/1/children/0"));
  CHECK_THAT(error(R"("nodes":[{"rotation":[0,0,0,0]}])"), ContainsSubstring("/nodes/0/rotation"));
  CHECK_THAT(error(R"("nodes":[{"scale":[1,1]}])"),
             ContainsSubstring("/nodes/0/scale: 3 numbers wanted, found 2"));
  CHECK_THAT(error(R"("nodes":[{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}])"),
             ContainsSubstring("/nodes/0/matrix"));
  CHECK_THAT(error(R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":2}}])"),
             ContainsSubstring("/materials/0/pbrMetallicRoughness/metallicFactor: 2 is outside [0, 1]"));
  CHECK_THAT(error(R"("scene":0)"), ContainsSubstring("/scene: scene 0 does not exist"));
  CHECK_THAT(error(R"("extensionsRequired":["KHR_draco_mesh_compression"])"),
             ContainsSubstring("/extensionsRequired/0") && ContainsSubstring("KHR_draco_mesh_compression"));
  CHECK_THAT(load_error("a.gltf", R"({"asset":{"version":"1.0"}})"), ContainsSubstring("/asset/version"));
  CHECK_THAT(load_error("a.gltf", R"({"asset":{)"), ContainsSubstring("byte 11: not valid JSON"));
  CHECK_THAT(load_error("a.gltf", "{\u201casset\u201d:1}"), !ContainsSubstring("last read"));
  CHECK_THAT(load_error("a.glb", "glTF"), ContainsSubstring("byte 4"));
}

TEST_CASE("indices beyond the vertices, and data that is not a number, are refused", "[models]") {
  std::string bytes = quad_bytes();
  bytes[2] = 4;
  const auto error = [&] {
    return load_error(
        "a.gltf",
        document(R"("buffers":[{"byteLength":72,"uri":"data:application/octet-stream;base64,)" +
                 base64(bytes) + R"("}],)" + quad_views +
                 R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)" + one_node));
  };
  CHECK_THAT(error(),
             ContainsSubstring("/meshes/0/primitives/0/indices: index 2 is 4, but there are 4 vertices"));
  bytes = quad_bytes();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 12, &nan, 4);
  CHECK_THAT(error(), ContainsSubstring("/accessors/1: vertex 0 is not finite"));
}

TEST_CASE("a node scaled to nothing is left out with a warning", "[models]") {
  const Model model = load_text("a.gltf", quad(R"("nodes":[{"mesh":0,"scale":[0,0,0]}])"));
  CHECK(model.objects.empty());
  CHECK(model.warnings.size() == 1);
}
