// STL, from small files written here.
#include <cctype>
#include <cstring>

#include "catch.h"
#include "model_files.h"

using namespace sundog;

namespace {

std::string ascii_facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 0\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
         "\n endloop\nendfacet\n";
}

std::string binary(std::uint32_t promised, const std::vector<float>& coordinates,
                   const std::string& start = "made here") {
  std::string bytes = start + std::string(80 - start.size(), ' ');
  bytes.append(reinterpret_cast<const char*>(&promised), 4);
  for (std::size_t i = 0; i < coordinates.size(); i += 9) {
    bytes += std::string(12, '\0');
    bytes.append(reinterpret_cast<const char*>(&coordinates[i]), 36);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

const std::vector<float> two_triangles{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0.1f};

}  // namespace

TEST_CASE("ASCII and binary STL files load flat, with the vertices that they store", "[models]") {
  const Model text =
      load_text("a.stl", "solid made here\n" + ascii_facet("0 0 0", "2 0 0", "0 1 0") + "endsolid\n" +
                             "solid two\n" + ascii_facet("0 0 0", "2 0 0", "0 1e0 0") + "endsolid two\n");
  CHECK(text.meshes.at(0).triangles.size() == 2);
  CHECK(area_of(text.meshes[0]) == 2);
  CHECK(text.meshes[0].normals.empty());
  for (const std::string start : {"made here", "solid but binary"}) {
    const Model model = load_text("a.stl", binary(2, two_triangles, start));
    CHECK(model.meshes.at(0).source_vertex_count == 6);
    CHECK(model.meshes[0].triangles.size() == 2);
    CHECK(model.meshes[0].normals.empty());
    CHECK(area_of(model.meshes[0]) == Approx(1).epsilon(0.01));
  }
}

TEST_CASE("a binary STL that promises fewer facets than it holds says so", "[models]") {
  const Model model = load_text("a.stl", binary(1, two_triangles));
  CHECK(model.meshes.at(0).triangles.size() == 1);
  REQUIRE(model.warnings.size() == 1);
  CHECK_THAT(model.warnings[0], ContainsSubstring("1 facets promised, but the file has room for 2"));
}

TEST_CASE("a binary STL with colours says that they are not read", "[models]") {
  const std::vector<std::string> colors{"colours of facets"};
  CHECK(load_text("a.stl", binary(2, two_triangles, "COLOR=\xff\x80\x20\xff")).unread == colors);
  std::string last = binary(2, two_triangles);
  last.back() = '\x80';
  CHECK(load_text("a.stl", last).unread == colors);
  CHECK(load_text("a.stl", binary(2, two_triangles)).unread == std::vector<std::string>{});
}

TEST_CASE("an ASCII STL may be in capitals, behind a byte order mark", "[models]") {
  std::string text = "solid a\n" + ascii_facet("0 0 0", "2 0 0", "0 1 0") + "endsolid a\n";
  CHECK(area_of(load_text("a.stl", "\xEF\xBB\xBF" + text).meshes.at(0)) == 1);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  CHECK(area_of(load_text("a.stl", text).meshes.at(0)) == 1);
  // A binary one may begin with any bytes.
  CHECK(load_text("a.stl", binary(2, two_triangles, "\xEF\xBB\xBFsolid")).meshes.at(0).triangles.size() == 2);
}

TEST_CASE("an STL smooths when a crease angle is given", "[models]") {
  ModelOptions options;
  options.crease_angle = 30;
  const Mesh mesh = load_text("a.stl", binary(2, two_triangles), options).meshes.at(0);
  REQUIRE(mesh.normals.size() == 6);
  CHECK(mesh.normals[mesh.triangles[0].x] == mesh.normals[mesh.triangles[1].x]);
  CHECK(mesh.normals[mesh.triangles[0].y] != mesh.normals[mesh.triangles[1].z]);
}

TEST_CASE("a bad STL is refused with its line or byte", "[models]") {
  CHECK_THAT(load_error("a.stl", "solid x\n" + ascii_facet("0 0 0", "1 0 0", "0 1")),
             ContainsSubstring("line 6"));
  CHECK_THAT(load_error("a.stl", "solid x\n" + ascii_facet("0 0 0", "1 0 0", "0 1 0")),
             ContainsSubstring("endsolid"));
  CHECK_THAT(load_error("a.stl", "solid x\nvertex 0 0 0\n"), ContainsSubstring("line 2"));
  CHECK_THAT(load_error("a.stl", "solid x\nouter loop\nvertex 0 0 0\nendloop\n"),
             ContainsSubstring("line 4: a facet needs three"));
  CHECK_THAT(load_error("a.stl", "solid x\nnonsense\n"), ContainsSubstring("line 2"));
  CHECK_THAT(load_error("a.stl", "what"), ContainsSubstring("byte 4"));
  CHECK_THAT(load_error("a.stl", binary(4000000000u, two_triangles)),
             ContainsSubstring("byte 80: 4000000000 facets"));
  std::vector<float> bad = two_triangles;
  bad[4] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THAT(load_error("a.stl", binary(2, bad)), ContainsSubstring("byte 112: a coordinate is not finite"));
}
