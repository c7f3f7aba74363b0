// Models whose own coordinates lie far from their origin keep the digits that their files have.
#include <cmath>

#include "catch.h"
#include "gltf_text.h"
#include "model_files.h"
#include "models/far_mesh.h"

using namespace sundog;

namespace {

/// The corners of the only object, in the file's space, triangle by triangle.
std::vector<dvec3> corners_of(const Model& model) {
  REQUIRE(model.objects.size() == 1);
  std::vector<dvec3> corners;
  for (const glm::uvec3& t : model.meshes.at(0).triangles)
    for (int k = 0; k < 3; ++k)
      corners.emplace_back(model.objects[0].world_from_object *
                           glm::dvec4(dvec3(model.meshes[0].positions[t[k]]), 1));
  return corners;
}

void check_corners(const Model& model, const std::vector<dvec3>& expected, double tolerance) {
  const std::vector<dvec3> found = corners_of(model);
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(glm::length(found[i] - expected[i]) <= tolerance);
}

}  // namespace

TEST_CASE("text far from the origin keeps its digits", "[models]") {
  const std::vector<dvec3> quad = {{100000.001, -200000.002, 3}, {100000.011, -200000.002, 3},
                                   {100000.011, -199999.992, 3}, {100000.001, -200000.002, 3},
                                   {100000.011, -199999.992, 3}, {100000.001, -199999.992, 3}};
  const std::string vertices[] = {"100000.001 -200000.002 3", "100000.011 -200000.002 3",
                                  "100000.011 -199999.992 3", "100000.001 -199999.992 3"};
  std::string obj, ply =
                       "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
                       "property double z\nelement face 1\nproperty list uchar int vertex_indices\n"
                       "end_header\n";
  for (const std::string& v : vertices) obj += "v " + v + "\n", ply += v + "\n";
  const auto facet = [&](int a, int b, int c) {
    return "facet normal 0 0 1\nouter loop\nvertex " + vertices[a] + "\nvertex " + vertices[b] + "\nvertex " +
           vertices[c] + "\nendloop\nendfacet\n";
  };
  check_corners(load_text("a.obj", obj + "f 1 2 3 4\n"), quad, 1e-8);
  check_corners(load_text("a.ply", ply + "4 0 1 2 3\n"), quad, 1e-8);
  check_corners(load_text("a.stl", "solid a\n" + facet(0, 1, 2) + facet(0, 2, 3) + "endsolid a\n"), quad,
                1e-8);
}

TEST_CASE("floats far from the origin stay what they are", "[models]") {
  const float x = 100000.03f, y = 99999.98f;
  std::string bytes = "binary" + std::string(74, ' ');
  put<std::uint32_t>(bytes, {1});
  put<float>(bytes, {0, 0, 1, x, 0, 0, y, 0, 0, x, 0.5f, 0});
  bytes += std::string(2, '\0');
  const Model model = load_text("a.stl", bytes);
  check_corners(model, {{double(x), 0, 0}, {double(y), 0, 0}, {double(x), 0.5, 0}}, 0);
  CHECK(std::abs(model.meshes[0].positions[0].x) <= 1);
}

TEST_CASE("a model near its origin is placed as it is", "[models]") {
  const Model model = load_text("a.obj", "v 3 0 0\nv 4 0 0\nv 3 1 0\nf 1 2 3\n");
  CHECK(model.objects.at(0).world_from_object == dmat4(1));
  CHECK(model.meshes.at(0).positions[0] == glm::vec3(3, 0, 0));
}

TEST_CASE("a far mesh's origin is a multiple of a power of two above its size, one axis at a time") {
  CHECK(models::near_origin({100, 0, 0}, {103, 1, 3}) == dvec3(100, 0, 0));
  CHECK(models::near_origin({9, 0, -200}, {13, 1, -199}) == dvec3(0, 0, -200));
  CHECK(models::near_origin({7, 7, 7}, {7, 7, 7}) == dvec3(0));
  CHECK(models::near_origin({1, 1, 1}, {-1, -1, -1}) == dvec3(0));
}
