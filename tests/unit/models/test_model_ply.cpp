// PLY, from small files written here.
#include <cctype>
#include <cstring>
#include <limits>

#include "catch.h"
#include "model_files.h"

using namespace sundog;

namespace {

std::string header(const std::string& format, const std::string& vertex, int vertices, int faces,
                   const std::string& face = "") {
  return "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " + std::to_string(vertices) +
         "\n" + vertex + "element face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\n" + face + "end_header\n";
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

template <class Value>
void put(std::string& bytes, Value value, bool big) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof raw);
  if (big) std::reverse(raw, raw + sizeof raw);
  bytes.append(raw, sizeof raw);
}

// A quad with doubles for y, normals, and 8-bit colours, after an element that no one knows.
std::string binary_quad(bool big) {
  std::string bytes =
      "ply\nformat binary_" + std::string(big ? "big" : "little") +
      "_endian 1.0\nelement odd 2\nproperty list ushort double a\nproperty short b\n"
      "element vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nproperty float nx\nproperty float ny\n"
      "property float nz\nelement face 1\nproperty list uint8 uint16 vertex_index\nend_header\n";
  for (int i = 0; i < 2; ++i) {
    put(bytes, std::uint16_t(i), big);
    for (int k = 0; k < i; ++k) put(bytes, 1.0, big);
    put(bytes, std::int16_t(7), big);
  }
  for (int i = 0; i < 4; ++i) {
    put(bytes, i == 1 || i == 2 ? 2.0f : 0.0f, big);
    put(bytes, i >= 2 ? 3.0 : 0.0, big);
    put(bytes, 1.0f, big);
    bytes += std::string("\xff\x80\x00", 3);
    for (const float n : {0.0f, 0.0f, 5.0f}) put(bytes, n, big);
  }
  bytes += '\4';
  for (std::uint16_t i = 0; i < 4; ++i) put(bytes, i, big);
  return bytes;
}

}  // namespace

TEST_CASE("binary PLY files of both byte orders say the same", "[models]") {
  for (const bool big : {false, true}) {
    const Model model = load_text("a.ply", binary_quad(big));
    const Mesh& mesh = model.meshes.at(0);
    CHECK(mesh.source_vertex_count == 4);
    CHECK(mesh.triangles.size() == 2);
    CHECK(area_of(mesh) == 6);
    CHECK(mesh.normals == std::vector<glm::vec3>(4, {0, 0, 1}));
    CHECK(mesh.colors.at(0).x == 1);
    CHECK(mesh.colors.at(0).y == Approx(0.21586).epsilon(1e-3));  // sRGB 128 as a linear value
    CHECK(mesh.colors.at(0).z == 0);
    CHECK(model.materials.at(0).vertex_color);
  }
}

TEST_CASE("binary PLY triangles are read alike with a polygon among them, and refused by their number",
          "[models]") {
  constexpr int faces = 20000;
  const auto file = [](int quad_at, std::uint32_t last_corner) {
    std::string bytes = header("binary_little_endian", xyz, faces + 3, faces, "property uchar flags\n");
    for (int i = 0; i < faces + 3; ++i)
      for (const float x : {float(i), float(i % 2), 0.0f}) put(bytes, x, false);
    for (int i = 0; i < faces; ++i) {
      const auto first = std::uint32_t(i);
      bytes += i == quad_at ? '\4' : '\3';
      put(bytes, first, false), put(bytes, first + 1, false);
      if (i == quad_at) put(bytes, first + 3, false);
      put(bytes, i + 1 == faces ? last_corner : first + 2, false);
      bytes += '\7';
    }
    return bytes;
  };
  const Mesh plain = load_text("a.ply", file(-1, faces + 1)).meshes.at(0);
  REQUIRE(plain.triangles.size() == faces);
  const auto x_of = [](const Mesh& mesh, std::size_t face) {
    return mesh.positions[mesh.triangles[face].z].x;  // vertices may be copied along creases
  };
  for (const int face : {0, 12345, faces - 1}) CHECK(x_of(plain, std::size_t(face)) == float(face + 2));
  const Mesh mixed = load_text("a.ply", file(100, faces + 1)).meshes.at(0);
  REQUIRE(mixed.triangles.size() == faces + 1);
  CHECK(x_of(mixed, 12346) == 12347.0f);
  CHECK_THAT(load_error("a.ply", file(-1, 40000)),
             ContainsSubstring("face 19999: vertex 40000, but there are 20003 vertices"));
}

TEST_CASE("a large binary PLY's vertices are read alike wherever they lie, and the first bad one is named",
          "[models]") {
  constexpr int vertices = 50000;
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string more = "property double nx\nproperty double ny\nproperty double nz\n";
  const auto file = [&](const std::vector<int>& lost, const std::vector<int>& beyond) {
    std::string bytes = header("binary_little_endian", xyz + more, vertices, 1);
    for (int i = 0; i < vertices; ++i) {
      for (const float x : {std::ranges::count(lost, i) > 0 ? nan : float(i), 2.0f, float(i % 3)})
        put(bytes, x, false);
      for (const double n : {0.0, 0.0, std::ranges::count(beyond, i) > 0 ? 1e300 : 2.0}) put(bytes, n, false);
    }
    bytes += '\3';
    for (const std::uint32_t corner : {0, 20000, 49999}) put(bytes, corner, false);
    return bytes;
  };
  // At the edges of the parts that threads read.
  const Mesh mesh = load_text("a.ply", file({16383, 16384, 16385, 32768}, {})).meshes.at(0);
  REQUIRE(mesh.positions.size() == vertices);
  for (const std::size_t i : {0, 16382, 16386, 20000, 32767, 32769, 49999}) {
    CHECK(mesh.positions[i] == glm::vec3(float(i), 2, float(i % 3)));
    CHECK(mesh.normals[i] == glm::vec3(0, 0, 1));
  }
  for (const std::size_t i : {16383, 16384, 16385}) CHECK(mesh.positions[i] == mesh.positions[16382]);
  CHECK(mesh.positions[32768] == mesh.positions[32767]);
  CHECK_THAT(load_error("a.ply", file({20000}, {})), ContainsSubstring("vertex 20000 has a coordinate"));
  const std::string first = load_error("a.ply", file({}, {40000}));
  for (int i = 0; i < 5; ++i) CHECK(load_error("a.ply", file({}, {40000, 45000, 49999})) == first);
  CHECK_THAT(first, ContainsSubstring("beyond single precision's range"));
}

TEST_CASE("an ASCII PLY's polygons are triangulated and its normals made", "[models]") {
  const Model model =
      load_text("a.ply", header("ascii", xyz, 5, 2) +
                             "0 0 0\n4 0 0\ncomment between\n1 1 0\n4 4 0\n0 4 0\n5 0 1 2 3 4\n2 0 1\n");
  const Mesh& mesh = model.meshes.at(0);
  CHECK(mesh.triangles.size() == 3);
  CHECK(area_of(mesh) == Approx(10));
  CHECK(model.dropped_polygons == 1);
  CHECK(mesh.normals == std::vector<glm::vec3>(5, {0, 0, 1}));
  CHECK(model.materials.empty());
}

TEST_CASE("colours from 0 to 255 in properties for floats are bytes, others are light", "[models]") {
  const std::string colors = "property float red\nproperty float green\nproperty float blue\n";
  const auto first = [&](const std::string& color) {
    const std::string corner = " 0 0 0\n";
    const Model model = load_text("a.ply", header("ascii", xyz + colors, 3, 1) + "0 0 0 " + color +
                                               "\n1 0 0" + corner + "0 1 0" + corner + "3 0 1 2\n");
    return glm::vec3(model.meshes.at(0).colors.at(0));
  };
  CHECK(first("255 128 1").x == 1);
  CHECK(first("255 128 1").y == Approx(0.21586).epsilon(1e-3));
  CHECK(first("1 0 1") == glm::vec3(1, 0, 1));
  CHECK(first("3.5 0.5 1") == glm::vec3(3.5f, 0.5f, 1));
}

TEST_CASE("PLY faces of different colour split the vertices between them, and still smooth", "[models]") {
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const Model model =
      load_text("a.ply", header("ascii", xyz, 4, 2, colors) +
                             "0 0 0\n1 0 .1\n1 1 0\n0 1 .1\n3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n");
  const Mesh& mesh = model.meshes.at(0);
  CHECK(mesh.source_vertex_count == 4);
  REQUIRE(mesh.positions.size() == 6);
  const glm::uvec3 a = mesh.triangles[0], b = mesh.triangles[1];
  for (int k = 0; k < 3; ++k) {
    CHECK(mesh.colors[a[k]] == glm::vec3(1, 0, 0));
    CHECK(mesh.colors[b[k]] == glm::vec3(0, 0, 1));
  }
  CHECK(glm::length(mesh.normals[a.x] - mesh.normals[b.x]) < 1e-6f);
}

TEST_CASE("PLY triangle strips become triangles of one winding", "[models]") {
  const Model model =
      load_text("a.ply", "ply\nformat ascii 1.0\nelement vertex 5\n" + xyz +
                             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 0 1 2\n");
  const Mesh& mesh = model.meshes.at(0);
  REQUIRE(mesh.triangles.size() == 4);
  for (const glm::uvec3 t : mesh.triangles)
    CHECK(glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]).z >
          0);
}

TEST_CASE("a PLY whose header promises more than the file holds is refused before anything is allocated",
          "[models]") {
  CHECK_THAT(load_error("a.ply", header("binary_little_endian", xyz, 2000000000, 1) + "abc"),
             ContainsSubstring("2000000000 of 'vertex'"));
  CHECK_THAT(load_error("a.ply", header("ascii", xyz, 2000000000, 1) + "0 0 0\n"),
             ContainsSubstring("2000000000 of 'vertex'"));
  CHECK_THAT(load_error("a.ply", "ply\nformat ascii 1.0\nelement none 4294967295\nelement vertex 1\n" + xyz +
                                     "end_header\n0 0 0\n"),
             ContainsSubstring("too many"));
  std::string bytes = header("binary_little_endian", xyz, 1, 1, "property list uint float more\n");
  for (int i = 0; i < 3; ++i) put(bytes, 0.0f, false);
  bytes += std::string("\0\xff\xff\xff\xff", 5);
  CHECK_THAT(load_error("a.ply", bytes), ContainsSubstring("the file ends within its data"));
}

TEST_CASE("PLY faces may come before their vertices", "[models]") {
  for (const std::string format : {"ascii", "binary_big_endian"}) {
    std::string bytes =
        "ply\nformat " + format +
        " 1.0\nelement face 2\nproperty list uchar ushort vertex_indices\nelement vertex 4\n" + xyz +
        "end_header\n";
    if (format == "ascii") {
      bytes += "4 0 1 2 3\n3 0 1 2\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n";
    } else {
      for (const std::vector<std::uint16_t>& face : {std::vector<std::uint16_t>{0, 1, 2, 3}, {0, 1, 2}}) {
        bytes += static_cast<char>(face.size());
        for (const std::uint16_t corner : face) put(bytes, corner, true);
      }
      for (const float value : {0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 2.f, 2.f, 0.f, 0.f, 2.f, 0.f})
        put(bytes, value, true);
    }
    const Mesh mesh = load_text("a.ply", bytes).meshes.at(0);
    CHECK(mesh.triangles.size() == 3);
    CHECK(area_of(mesh) == Approx(6));
  }
}

TEST_CASE("a PLY's normals and coordinates that are no numbers are made anew, with a warning", "[models]") {
  const std::string more =
      "property float nx\nproperty float ny\nproperty float nz\nproperty float u\n"
      "property float v\n";
  const Model model = load_text("a.ply", header("ascii", xyz + more, 4, 1) +
                                             "0 0 0 nan nan nan 0 0\n1 0 0 0 0 1 nan 1\n0 1 0 0 0 1 1 1\n"
                                             "nan nan nan 0 0 1 0 0\n3 0 1 2\n");
  CHECK(model.meshes.at(0).normals.at(0) == glm::vec3(0, 0, 1));
  CHECK(model.meshes[0].uvs.at(1) == glm::vec2(0));
  REQUIRE(model.warnings.size() == 2);
  CHECK_THAT(model.warnings[0], Catch::Matchers::StartsWith("1 normals that are no numbers are made up"));
}

TEST_CASE("a PLY's header may be in capitals, behind a byte order mark", "[models]") {
  std::string text = header("ascii", xyz, 3, 1);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::string points = "0 0 0\n2 0 0\n0 1 0\n3 0 1 2\n";
  CHECK(area_of(load_text("a.ply", text + points).meshes.at(0)) == 1);
  CHECK(area_of(load_text("a.ply", "\xEF\xBB\xBF" + header("ascii", xyz, 3, 1) + points).meshes.at(0)) == 1);
}

TEST_CASE("a bad PLY is refused with its line or byte", "[models]") {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  const auto error = [&](const std::string& data) {
    return load_error("a.ply", header("ascii", xyz, 3, 1) + data);
  };
  CHECK_THAT(error(points), ContainsSubstring("line 13: the header promises 1 of 'face'"));
  CHECK_THAT(error(points + "3 0 1 3\n"),
             ContainsSubstring("line 14") && ContainsSubstring("vertex 3, but there are 3"));
  CHECK_THAT(error(points + "3 0 1 -1\n"), ContainsSubstring("line 14"));
  CHECK_THAT(error(points + "3 0 1 0.5\n"),
             ContainsSubstring("line 14") && ContainsSubstring("whole number"));
  CHECK_THAT(error(points + "3 0 1\n"), ContainsSubstring("line 14"));
  CHECK_THAT(error(points + "-3 0 1 2\n"), ContainsSubstring("line 14"));
  CHECK_THAT(error(points + "3 0 1 2 9\n"), ContainsSubstring("line 14: face ends before '9'"));
  CHECK_THAT(error("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), ContainsSubstring("line 12"));
  CHECK_THAT(error("0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n"),
             ContainsSubstring("line 14: face 0: vertex 1 has a coordinate that is no number"));
  CHECK_THAT(error(points + "\n\n"), ContainsSubstring("the file ends before its last face"));
  CHECK_THAT(load_error("a.ply", "plx\n"), ContainsSubstring("line 1"));
  CHECK_THAT(load_error("a.ply", "ply\nformat ascii 1.0\n"), ContainsSubstring("end_header"));
  CHECK_THAT(load_error("a.ply", "ply\nformat klingon 1.0\n"), ContainsSubstring("line 2"));
  CHECK_THAT(load_error("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"),
             ContainsSubstring("line 4"));
  CHECK_THAT(load_error("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n"), ContainsSubstring("line 3"));
  CHECK_THAT(load_error("a.ply", "ply\nformat ascii 1.0\nproperty int x\n"), ContainsSubstring("line 3"));
  CHECK_THAT(load_error("a.ply", "ply\nformat ascii 1.0\nend_header\n"), ContainsSubstring("no vertices"));
  const std::string whole = binary_quad(false);
  CHECK_THAT(load_error("a.ply", std::string_view(whole).substr(0, whole.size() - 1)),
             ContainsSubstring("byte"));
}

TEST_CASE("a PLY's faces have texture coordinates and images, as MeshLab writes them", "[models]") {
  const TemporaryFolder folder;
  folder.write("a.png", "an image");
  const std::string head =
      "ply\nformat ascii 1.0\ncomment TextureFile <this>.png\ncomment TextureFile b c.png\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property int texnumber\nend_header\n";
  // A square of two triangles; along their edge, the texture continues at one end and jumps at the other.
  const Model model =
      load_model(folder.write("a.ply", head + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                                              "3 0 1 2 6 0 0 .5 0 .5 1 0\n3 0 2 3 6 0 0 1 1 0 1 1\n"));
  const Mesh& mesh = model.meshes.at(0);
  REQUIRE(mesh.triangles.size() == 2);
  CHECK(mesh.positions.size() == 5);
  CHECK(mesh.triangles[0].x == mesh.triangles[1].x);
  const auto uv = [&](std::size_t triangle, int corner) {
    return mesh.uvs[mesh.triangles[triangle][corner]];
  };
  CHECK(uv(0, 2) == glm::vec2(.5f, 1));
  CHECK(uv(1, 1) == glm::vec2(1, 1));
  CHECK(mesh.positions[mesh.triangles[1].y] == mesh.positions[mesh.triangles[0].z]);
  CHECK(mesh.materials == std::vector<int>{0, 1});
  REQUIRE(model.materials.size() == 2);
  REQUIRE(model.images.size() == 1);
  CHECK(model.images[0].name == "a.png");
  CHECK(model.materials[0].diffuse == dvec3(1));
  CHECK(model.materials[1].textures.diffuse == -1);
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("line 4: the image") && ContainsSubstring("b c.png"));
}

TEST_CASE("of several elements of faces in a PLY, some may have no colours or texture coordinates",
          "[models]") {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string plain = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string uvs = "property list uchar float texcoord\n", vertices = "0 0 0\n1 0 0\n0 1 0\n";
  const auto mesh_of = [&](const std::string& elements, const std::string& faces) {
    return load_text("a.ply", head + elements + "end_header\n" + vertices + faces).meshes.at(0);
  };
  const std::string face = "3 0 1 2", red = face + " 255 0 0", mapped = face + " 6 0 0 1 0 0 1";
  for (const auto& [elements, faces] : std::vector<std::pair<std::string, std::string>>{
           {plain + colors + plain, red + "\n" + face}, {plain + plain + colors, face + "\n" + red}}) {
    const Mesh mesh = mesh_of(elements, faces + "\n");
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.colors.size() == mesh.positions.size());
  }
  for (const auto& [elements, faces] : std::vector<std::pair<std::string, std::string>>{
           {plain + uvs + plain, mapped + "\n" + face}, {plain + plain + uvs, face + "\n" + mapped}}) {
    const Mesh mesh = mesh_of(elements, faces + "\n");
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.uvs.size() == mesh.positions.size());
  }
}
