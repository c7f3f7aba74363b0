// All model formats: polygons become triangles, normals are made, files may be gzipped.
#include <numeric>

#include "catch.h"
#include "model_files.h"
#include "models/angles.h"
#include "models/normals.h"
#include "models/polygon.h"

using namespace sundog;

namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<glm::uvec3> cut(const std::vector<glm::vec3>& corners) {
  std::vector<glm::uvec3> triangles;
  REQUIRE(models::triangulate(corners, triangles));
  return triangles;
}

// The sum of signed and of unsigned areas in the plane z = 0: equal when no triangle is turned over.
std::pair<double, double> areas(const std::vector<glm::vec3>& corners,
                                const std::vector<glm::uvec3>& triangles) {
  double plain = 0, absolute = 0;
  for (const glm::uvec3 t : triangles) {
    const dvec3 a = corners[t.x], b = corners[t.y], c = corners[t.z];
    const double twice = glm::cross(b - a, c - a).z;
    plain += twice / 2;
    absolute += std::abs(twice) / 2;
  }
  return {plain, absolute};
}

// A comb with `teeth` teeth of height 1 and width 1, a gap of 1 between them, on a bar of height 1.
std::vector<glm::vec3> comb(int teeth) {
  std::vector<glm::vec3> corners{{0, 0, 0}, {2 * teeth - 1, 0, 0}};
  for (int i = teeth; i-- > 0;) {
    const auto x = static_cast<float>(2 * i);
    corners.insert(corners.end(), {{x + 1, 2, 0}, {x, 2, 0}});
    if (i > 0) corners.insert(corners.end(), {{x, 1, 0}, {x - 1, 1, 0}});
  }
  return corners;
}

// A closed cylinder's side about z, radius 1, with two rings of `sides` vertices.
Mesh tube(unsigned sides) {
  Mesh mesh;
  for (unsigned i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    for (const double z : {0.0, 1.0}) mesh.positions.emplace_back(dvec3(std::cos(angle), std::sin(angle), z));
  }
  for (unsigned i = 0; i < sides; ++i) {
    const unsigned a = 2 * i, b = 2 * ((i + 1) % sides);
    mesh.triangles.emplace_back(a, b, b + 1);
    mesh.triangles.emplace_back(a, b + 1, a + 1);
  }
  return mesh;
}

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const std::vector<std::array<unsigned, 4>> quads{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    mesh.triangles.emplace_back(q[0], q[1], q[2]);
    mesh.triangles.emplace_back(q[0], q[2], q[3]);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a concave polygon is cut into triangles that cover it once", "[models]") {
  const std::vector<glm::vec3> arrow{
      {0, 0, 0}, {4, -2, 0}, {1, 0, 0}, {4, 2, 0}};  // fan from corner 0 is right
  const std::vector<glm::vec3> turned{{4, -2, 0}, {1, 0, 0}, {4, 2, 0}, {0, 0, 0}};  // here it is not
  for (const auto& corners : {arrow, turned, comb(2), comb(40)}) {
    const auto triangles = cut(corners);
    CHECK(triangles.size() == corners.size() - 2);
    const auto [plain, absolute] = areas(corners, triangles);
    CHECK(absolute == Approx(plain));
  }
  CHECK(areas(comb(40), cut(comb(40))).first == Approx(79 + 40));
}

TEST_CASE("a polygon wound clockwise keeps its winding", "[models]") {
  std::vector<glm::vec3> corners = comb(5);
  std::reverse(corners.begin(), corners.end());
  const auto [plain, absolute] = areas(corners, cut(corners));
  CHECK(plain == Approx(-14));
  CHECK(absolute == Approx(14));
}

TEST_CASE("polygons on one line, with repeated corners or crossing edges give n - 2 triangles", "[models]") {
  CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size() == 2);
  CHECK(cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).size() == 3);
  CHECK(cut({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 3, 0}}).size() == 2);  // a bow tie
  CHECK(cut({{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}, {0, 2.9f, 0}}).size() ==
        4);  // a star
}

TEST_CASE("a convex polygon may have any number of corners, a concave one a bounded number", "[models]") {
  std::vector<glm::vec3> round;
  for (int i = 0; i < 20000; ++i)
    round.emplace_back(dvec3(std::cos(i * pi / 1e4), std::sin(i * pi / 1e4), 0) * 1e3);
  CHECK(cut(round).size() == 19998);
  std::vector<glm::uvec3> triangles;
  CHECK_FALSE(models::triangulate(comb(static_cast<int>(models::most_concave_corners)), triangles));
  CHECK(triangles.empty());
}

TEST_CASE("made normals are smooth on a tube of many sides and split on one of few", "[models]") {
  Mesh smooth = tube(64);  // 5.6 degrees between sides
  models::complete_normals(smooth, {}, 45);
  REQUIRE(smooth.positions.size() == 128);
  for (std::size_t i = 0; i < smooth.positions.size(); ++i) {
    const glm::vec3 p = smooth.positions[i];
    CHECK(glm::dot(smooth.normals[i], glm::normalize(glm::vec3(p.x, p.y, 0))) > 0.99999f);
  }
  Mesh split = tube(6);  // 60 degrees
  models::complete_normals(split, {}, 45);
  CHECK(split.positions.size() == 24);
  Mesh joined = tube(6);
  models::complete_normals(joined, {}, 61);
  CHECK(joined.positions.size() == 12);
}

TEST_CASE("angle weights make a cube's corner normal the diagonal, however its sides are cut", "[models]") {
  Mesh mesh = cube();
  models::complete_normals(mesh, {}, 91);
  REQUIRE(mesh.positions.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::vec3 outward = glm::normalize(mesh.positions[i] - glm::vec3(0.5f));
    CHECK(glm::length(mesh.normals[i] - outward) < 1e-6f);
  }
}

TEST_CASE("a cube's edges are creases, and each side keeps four vertices", "[models]") {
  Mesh mesh = cube();
  models::complete_normals(mesh, {}, 45);
  CHECK(mesh.positions.size() == 24);
  for (const glm::uvec3 t : mesh.triangles) {
    const glm::vec3 ng = glm::normalize(
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
    for (int k = 0; k < 3; ++k) CHECK(glm::length(mesh.normals[t[k]] - ng) < 1e-6f);
  }
}

TEST_CASE("a model of many points has the normals and vertices of its parts", "[models]") {
  Mesh many;
  constexpr unsigned cubes = 3000;  // more points than one thread takes at once
  const Mesh part = cube();
  for (unsigned i = 0; i < cubes; ++i) {
    for (const glm::vec3& p : part.positions) many.positions.push_back(p + glm::vec3(2.0f * float(i), 0, 0));
    for (const glm::uvec3& t : part.triangles) many.triangles.push_back(t + 8 * i);
  }
  models::complete_normals(many, {}, 45);
  REQUIRE(many.positions.size() == 24 * cubes);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < many.triangles.size(); ++i) {
    const glm::uvec3 t = many.triangles[i];
    const glm::vec3 a = many.positions[t.x], b = many.positions[t.y], c = many.positions[t.z];
    const glm::vec3 ng = glm::normalize(glm::cross(b - a, c - a));
    wrong += std::floor(a.x / 2) != float(i / 12);
    for (int k = 0; k < 3; ++k) wrong += !(glm::length(many.normals[t[k]] - ng) < 1e-6f);
  }
  CHECK(wrong == 0);
}

TEST_CASE("triangles without area are kept, and make no normal that is not a number", "[models]") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {5, 5, 5}, {1e-30f, 0, 0}, {0, 1e-30f, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 1, 2}, {4, 4, 4}, {0, 5, 6}};
  models::complete_normals(mesh, {}, 45);
  CHECK(mesh.triangles.size() == 5);
  REQUIRE(mesh.normals.size() == mesh.positions.size());
  for (const glm::vec3& n : mesh.normals) CHECK(glm::length(n) == Approx(1));
  CHECK(mesh.normals[0] == glm::vec3(0, 0, 1));
}

TEST_CASE("a vertex of very many faces takes no quadratic time", "[models]") {
  constexpr unsigned faces = 400000;
  Mesh fan;  // every edge a crease: the faces stand on end around one axis vertex
  fan.positions.emplace_back(0);
  for (unsigned i = 0; i <= faces; ++i)
    fan.positions.emplace_back(dvec3(std::cos(i * 0.1), std::sin(i * 0.1), i % 2 ? 5.0 : -5.0));
  for (unsigned i = 1; i <= faces; ++i) fan.triangles.emplace_back(0, i, i + 1);
  models::complete_normals(fan, {}, 10);
  CHECK(fan.normals.size() == fan.positions.size());
  Mesh book;  // one edge that all faces share
  book.positions = {{0, 0, 0}, {0, 0, 1}};
  for (unsigned i = 0; i < faces; ++i)
    book.positions.emplace_back(dvec3(std::cos(i * 0.1), std::sin(i * 0.1), 0));
  for (unsigned i = 0; i < faces; ++i) book.triangles.emplace_back(0, 1, i + 2);
  models::complete_normals(book, {}, 45);
  CHECK(book.normals.size() == book.positions.size());
}

TEST_CASE("vertices at one place are welded for smoothing", "[models]") {
  Mesh mesh = tube(64);
  Mesh soup;
  for (const glm::uvec3 t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) soup.positions.push_back(mesh.positions[t[k]]);
    const auto n = static_cast<unsigned>(soup.positions.size());
    soup.triangles.emplace_back(n - 3, n - 2, n - 1);
  }
  models::complete_normals(soup, {}, 45, models::weld_positions(soup));
  CHECK(soup.positions.size() == 384);
  for (std::size_t i = 0; i < soup.positions.size(); ++i)
    CHECK(glm::dot(soup.normals[i], glm::vec3(soup.positions[i].x, soup.positions[i].y, 0)) > 0.9999f);
}

TEST_CASE("model files are known by their extension, in any case and gzipped", "[models]") {
  for (const char* name : {"a.obj", "a.PLY", "a.stl.gz", "a.b.GLTF", "a.glb", "a.nff.GZ"})
    CHECK(is_model_file(name));
  for (const char* name : {"a.json", "obj", "a.obj.bak", "a.gz", ".obj"}) CHECK_FALSE(is_model_file(name));
  CHECK_THAT(load_error("scene.json", "{}"), ContainsSubstring("not a model file"));
}

TEST_CASE("gzipped models load, and broken gzip data is named with its byte", "[models]") {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string packed = gzipped(text);
  CHECK(load_text("a.obj.gz", packed).meshes.at(0).triangles.size() == 1);
  CHECK(load_text("a.obj.gz", gzipped("v 0 0 0\nv 1 0 0\n") + gzipped("v 0 1 0\nf 1 2 3\n")).meshes.size() ==
        1);
  CHECK_THAT(load_error("a.obj.gz", packed.substr(0, packed.size() - 9)), ContainsSubstring("it ends early"));
  CHECK_THAT(load_error("a.obj.gz", text), ContainsSubstring("byte 2") && ContainsSubstring("gzip"));
  CHECK_THAT(load_error("a.obj.gz", ""), ContainsSubstring("gzip"));
  // Many spaces are no bomb; what would fill the memory is refused long before it does.
  CHECK(load_text("a.obj.gz", gzipped(text + std::string(1 << 20, ' '))).meshes.size() == 1);
  CHECK_THAT(load_error("a.obj.gz", gzipped(std::string(100 << 20, '\n'))),
             ContainsSubstring("unpack to more than 64 MiB") && ContainsSubstring("gunzip"));
  CHECK_THAT(load_error(std::filesystem::path("/nowhere/a.obj")),
             ContainsSubstring("cannot be read: No such file"));
}

TEST_CASE("the angles of corners are arc tangents, thin and blunt corners included", "[models]") {
  std::vector<double> sines, cosines;
  for (const double scale : {1e-30, 1.0, 1e30})
    for (int i = 0; i <= 1800; ++i) {
      const double angle = pi * i / 1800;
      sines.push_back(scale * (i == 0 || i == 1800 ? 1e-12 : std::sin(angle)));
      cosines.push_back(scale * std::cos(angle));
    }
  std::vector<double> angles(sines.size());
  models::angles_of(sines, cosines, angles);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double right = std::atan2(sines[i], cosines[i]);
    if (!(std::abs(angles[i] - right) <= 1e-15 * right))
      FAIL_CHECK(i << ": " << angles[i] << " for " << right);
  }
}
