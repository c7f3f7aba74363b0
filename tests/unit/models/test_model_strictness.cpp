// Model files that bend their format: read where what is meant is clear, else refused.
#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"

using namespace sundog;

namespace {

/// A document of three vertices: `count` bytes of positions of that type behind `head`, in a buffer.
std::string triangle_of(const std::string& bytes, const std::string& accessors, const std::string& attributes,
                        const std::string& head = "") {
  return document(head + R"("buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
                  R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) +
                  R"("}],"bufferViews":[{"buffer":0,"byteLength":)" + std::to_string(bytes.size()) +
                  R"(,"byteStride":8}],"accessors":[)" + accessors +
                  R"(],"meshes":[{"primitives":[{"attributes":{)" + attributes + "}}]}]," + one_node);
}

std::string accessor(int type, bool normalized, const std::string& shape = "VEC3") {
  return R"({"bufferView":0,"componentType":)" + std::to_string(type) + R"(,"type":")" + shape +
         R"(","count":3)" + (normalized ? R"(,"normalized":true})" : "}");
}

const std::string quantization = R"("extensionsRequired":["KHR_mesh_quantization"],)";

/// A triangle of the corners 0, x = full, y = full, as integers eight bytes apart.
template <class Value>
std::string corners(Value full) {
  std::string bytes;
  for (int i = 0; i < 3; ++i) {
    put<Value>(bytes, {i == 1 ? full : Value{0}, i == 2 ? full : Value{0}, Value{0}, Value{0}});
    bytes.resize(static_cast<std::size_t>(8 * (i + 1)));
  }
  return bytes;
}

}  // namespace

TEST_CASE("KHR_mesh_quantization: positions of 8 and 16 bits, normalised or as they stand", "[models]") {
  struct Case {
    int type;
    std::string bytes;
    double whole;  // what the largest value is without normalisation
  };
  for (const Case& c :
       {Case{5120, corners<std::int8_t>(127), 127}, Case{5121, corners<std::uint8_t>(255), 255},
        Case{5122, corners<std::int16_t>(32767), 32767}, Case{5123, corners<std::uint16_t>(65535), 65535}})
    for (const bool normalized : {false, true}) {
      CAPTURE(c.type, normalized);
      const Model model = load_text(
          "a.gltf", triangle_of(c.bytes, accessor(c.type, normalized), R"("POSITION":0)", quantization));
      const double side = normalized ? 1 : c.whole;
      CHECK(area_of(model.meshes.at(0)) == Approx(side * side / 2));
      CHECK_THAT(load_error("a.gltf", triangle_of(c.bytes, accessor(c.type, normalized), R"("POSITION":0)")),
                 ContainsSubstring("of floats wanted"));  // without the extension
    }
}

TEST_CASE("KHR_mesh_quantization: normals are signed and normalised, texture coordinates any integers",
          "[models]") {
  std::string bytes;
  put<std::int8_t>(bytes, {0, 0, 0, 0, 0, 0, 127, 0, 100, 0, 0, 0, 0, 0, 127, 0, 0, 100, 0, 0, 0, 0, 127, 0});
  const std::string at_4 = R"({"bufferView":0,"byteOffset":4,"count":3,"componentType":)";
  const auto with = [&](const std::string& normal, const std::string& uv) {
    return triangle_of(bytes, accessor(5120, false) + "," + at_4 + normal + "," + at_4 + uv,
                       R"("POSITION":0,"NORMAL":1,"TEXCOORD_0":2)", quantization);
  };
  const std::string normal = R"(5120,"normalized":true,"type":"VEC3"})", uv = R"(5120,"type":"VEC2"})";
  const Model model = load_text("a.gltf", with(normal, uv));
  CHECK(model.meshes.at(0).normals.at(0) == glm::vec3(0, 0, 1));
  CHECK(area_of(model.meshes[0]) == 5000);
  CHECK_THAT(load_error("a.gltf", with(R"(5120,"type":"VEC3"})", uv)), ContainsSubstring("/NORMAL"));
  CHECK_THAT(load_error("a.gltf", with(R"(5121,"normalized":true,"type":"VEC3"})", uv)),
             ContainsSubstring("/NORMAL"));
}

TEST_CASE("a glTF that asks for more than version 2.0 is refused", "[models]") {
  const auto error = [](const std::string& least) {
    return load_error("a.gltf", R"({"asset":{"version":"2.0","minVersion":")" + least + R"("}})");
  };
  CHECK(error("2.0").empty());
  for (const char* least : {"2.1", "3.0", "2.0.1", "x"})
    CHECK_THAT(error(least), ContainsSubstring("/asset/minVersion") && ContainsSubstring("2.0 is read"));
}

TEST_CASE("vertices too far away are an error of the model, not of a made-up camera", "[models]") {
  const std::string far = load_error("a.obj", "v 0 0 0\nv 1e31 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK_THAT(far, ContainsSubstring("a.obj: ") && ContainsSubstring("1e+31") && !ContainsSubstring("camera"));
  CHECK(load_error("a.obj", "v 0 0 0\nv 1e16 0 0\nv 0 1 0\nf 1 2 3\n").empty());
  CHECK_THAT(load_error("a.gltf", quad(R"("nodes":[{"mesh":0,"scale":[1e30,1,1]}])")),
             ContainsSubstring("the mesh 'quad' has a vertex at"));
}

TEST_CASE("what a glTF may leave out or leave over is no error", "[models]") {
  const Model offset = load_text(
      "a.gltf", document(R"("accessors":[{"byteOffset":4,"componentType":5126,"type":"VEC3","count":1}])"));
  REQUIRE(offset.warnings.size() >= 1);
  CHECK_THAT(offset.warnings[0], ContainsSubstring("/accessors/0/byteOffset"));
  // Two matrices of bytes: 8 bytes each, of which the last needs 6.
  const auto matrices = [](int bytes) {
    return document(R"("buffers":[{"byteLength":16,"uri":"data:application/octet-stream;base64,)" +
                    base64(std::string(16, '\0')) + R"("}],"bufferViews":[{"buffer":0,"byteLength":)" +
                    std::to_string(bytes) +
                    R"(}],"accessors":[{"bufferView":0,"componentType":5121,"type":"MAT2","count":2}])");
  };
  CHECK(load_error("a.gltf", matrices(14)).empty());
  CHECK_THAT(load_error("a.gltf", matrices(13)), ContainsSubstring("the view has 13 bytes"));
  // A buffer that is nowhere is an error for who reads it.
  const std::string nowhere = R"("buffers":[{"byteLength":72}],)" + quad_views;
  CHECK(load_error("a.gltf", document(nowhere)).empty());
  std::string json = document(nowhere);
  while (json.size() % 4) json += ' ';
  std::string chunkless = "glTF";
  put<std::uint32_t>(chunkless, {2, static_cast<std::uint32_t>(20 + json.size()),
                                 static_cast<std::uint32_t>(json.size()), 0x4E4F534A});
  CHECK(load_error("a.glb", chunkless + json).empty());
  CHECK_THAT(load_error("a.gltf",
                        document(nowhere + R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1}}]}],)" +
                                 one_node)),
             ContainsSubstring("buffer 0 is not at hand"));
}

TEST_CASE("a GLB's chunks and a glTF's elements need not be aligned, as old exporters write them",
          "[models]") {
  std::string bytes = "x";
  put<float>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string json =
      document(
          R"("buffers":[{"byteLength":37}],"bufferViews":[{"buffer":0,"byteOffset":1,"byteLength":36}],"accessors":[
      {"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"meshes":[{"primitives":[{"attributes":
      {"POSITION":0}}]}],)" +
          one_node) +
      " ";
  for (const std::size_t odd : {0u, 1u, 2u, 3u}) {
    const std::string text = json + std::string(odd, ' ');
    std::string glb = "glTF";
    const auto size = [](const std::string& s) { return static_cast<std::uint32_t>(s.size()); };
    put<std::uint32_t>(glb, {2, 12 + 8 + size(text) + 8 + size(bytes), size(text), 0x4E4F534A});
    glb += text;
    put<std::uint32_t>(glb, {size(bytes), 0x004E4942});
    glb += bytes;
    CHECK(area_of(load_text("a.glb", glb).meshes.at(0)) == 0.5);
  }
}

TEST_CASE(
    "an OBJ may name normals or texture coordinates without having any, and its library a material without a "
    "name",
    "[models]") {
  const Model normals = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\n");
  CHECK(area_of(normals.meshes.at(0)) == 0.5);
  REQUIRE(normals.warnings.size() == 1);
  CHECK_THAT(normals.warnings[0], ContainsSubstring("line 4") && ContainsSubstring("normals"));
  const Model uvs = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 3/3\n");
  CHECK(uvs.meshes.at(0).uvs.empty());
  REQUIRE(uvs.warnings.size() == 1);
  CHECK_THAT(uvs.warnings[0], ContainsSubstring("line 4: faces name texture coordinates"));
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  const Model model =
      load_model(folder.write("a.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl green\nf 1 2 3\n"));
  CHECK(model.materials.at(static_cast<std::size_t>(model.meshes.at(0).materials.at(0))).diffuse ==
        dvec3(0, 1, 0));
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("m.mtl: line 1: newmtl without a name"));
}

TEST_CASE("faces of one or two corners give one warning with their number", "[models]") {
  const Model model = load_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1\nf 1 2\nf 1 2 3\n");
  REQUIRE(model.warnings.size() == 1);
  CHECK(model.warnings[0] == "2 faces of one or two corners are left out");
}
