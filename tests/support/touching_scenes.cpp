// Builds solids whose faces touch; renders and compares their pictures.
#include "touching_scenes.h"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "every_kind.h"

namespace touching {

using namespace sundog;
using glm::dmat4;
using glm::dvec3;

namespace {

using Quad = std::array<glm::vec3, 4>;

/// The faces of the box from (0, 0, 0) to (1, 1, 1).
std::vector<Quad> faces_of_cube() {
  std::vector<Quad> faces;
  for (const glm::uvec4& f : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                              glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
    const auto corner = [](unsigned i) { return glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1); };
    faces.push_back({corner(f.x), corner(f.y), corner(f.z), corner(f.w)});
  }
  return faces;
}

/// The cube with n x n squares on each face, cut along one diagonal or, with `other`, the other.
Mesh cube_of_squares(int n, bool other) {
  Mesh mesh;
  mesh.name = "cube";
  for (const Quad& face : faces_of_cube())
    for (int i = 0; i < n * n; ++i) {
      const auto first = static_cast<unsigned>(mesh.positions.size());
      for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        mesh.positions.push_back(face[0] + float(i % n + u) / float(n) * (face[1] - face[0]) +
                                 float(i / n + v) / float(n) * (face[3] - face[0]));
      const unsigned turn = other ? 1 : 0;
      mesh.triangles.push_back({first + turn, first + turn + 1, first + turn + 2});
      mesh.triangles.push_back({first + turn, first + turn + 2, first + (turn + 3) % 4});
    }
  return mesh;
}

/// Adds one of each solid and two that touch, far away, so that all scenes need the same kernels.
void add_bystanders(SceneDescription& scene) {
  scene.meshes = {cube_of_squares(1, false), cube_of_squares(3, true)};
  const int material = scenes::add_glow(scene, {0, 0, 0});
  double x = 300;
  for (const Shape& shape : with_every_solid({MeshShape{0}, MeshShape{1}}))
    scenes::place(scene, shape, material, at({x += 5, 0, 300}));
  scenes::place(scene, PlaneShape{}, material, at({0, -500, 0}));
  const int glass = add_glass(scene);
  scenes::place(scene, BoxShape{}, glass, at({300, 0, -300}));
  scenes::place(scene, BoxShape{}, glass, at({300, 2, -300}));
  LightDescription point;
  point.position = {-4, 6, 4};
  scene.lights.push_back(point);
  scene.render.max_depth = 8;
}

}  // namespace

dmat4 at(dvec3 position) { return glm::translate(dmat4(1), position); }

SceneDescription over_a_floor() {
  SceneDescription scene = scenes::line_of_sight({2.4, 2.0, 4.6}, {0, 0, 0});
  scene.camera.fov = 36;
  scene.image.width = scene.image.height = size;
  scene.image.background_bottom = {0.7, 0.75, 0.8};
  scene.image.background_top = {0.15, 0.3, 0.6};
  scene.render.cutoff = 1e-3;
  const int floor = scenes::add_white(scene);
  MaterialDescription& material = scene.materials[static_cast<std::size_t>(floor)];
  material.checker = true;
  material.checker_diffuse = {0.1, 0.15, 0.3};
  material.checker_size = 0.55;
  scenes::place(scene, PlaneShape{}, floor, at({0, -1.2, 0}));
  add_bystanders(scene);
  return scene;
}

SceneDescription along(dvec3 from, dvec3 to, dvec3 up) {
  SceneDescription scene = scenes::line_of_sight(from, to, up);
  scene.render.cutoff = 0.2;  // keeps the straight path and drops echoes
  add_bystanders(scene);
  return scene;
}

int add_glass(SceneDescription& scene) { return scenes::add_dielectric(scene, 1.5, {0.3, 0.1, 0.05}); }

void place_pieces(SceneDescription& scene, const std::vector<Piece>& pieces, int material,
                  const dmat4& turn) {
  int mesh = 0;
  for (const Piece& piece : pieces) {
    if (piece.mesh)
      scenes::place(scene, MeshShape{mesh++ % 2}, material,
                    turn * glm::scale(at(piece.lower), piece.upper - piece.lower));
    else
      scenes::place(scene, BoxShape{0.5 * (piece.upper - piece.lower)}, material,
                    turn * at(0.5 * (piece.lower + piece.upper)));
  }
}

void add_cube(Mesh& mesh, const Piece& piece) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const Mesh unit = cube_of_squares(1, false);
  for (const glm::vec3& p : unit.positions)
    mesh.positions.push_back(glm::vec3(piece.lower + dvec3(p) * (piece.upper - piece.lower)));
  for (const glm::uvec3& t : unit.triangles) mesh.triangles.push_back(t + first);
}

std::vector<Piece> grid_of_cubes(bool mesh) {
  std::vector<Piece> pieces;
  for (int i = 0; i < 8; ++i) {
    const dvec3 lower((i & 1) - 1, (i >> 1 & 1) - 1, (i >> 2 & 1) - 1);
    pieces.push_back({lower, lower + 1.0, mesh});
  }
  return pieces;
}

std::vector<float> picture(const DeviceInfo& device, Tracer tracer, SceneDescription scene) {
  scene.render.tracer = tracer;
  return scenes::render_on(device, scene).image.data;
}

int pixels_that_differ(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
  REQUIRE(a.size() == b.size());
  const std::size_t channels = a.size() / (size * size);
  int count = 0;
  for (std::size_t i = 0; i < a.size(); i += channels) {
    bool differs = false;
    for (std::size_t k = 0; k < channels; ++k) differs |= !(std::abs(a[i + k] - b[i + k]) <= tolerance);
    count += differs;
  }
  return count;
}

}  // namespace touching
