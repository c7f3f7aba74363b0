// Scenes of solids whose faces coincide, and of the single solid that they form. All scenes of over_a_floor()
// and along() share their kernels on a device and tracer, because compiling takes longer than rendering.
#pragma once
#include <vector>

#include "scenes.h"

namespace touching {

constexpr int size = 40;  // of pictures, in pixels

struct Piece {
  glm::dvec3 lower, upper;
  bool mesh = false;
};

glm::dmat4 at(glm::dvec3 position);

/// A checkered floor at y = -1.2 under a light, seen from above. Mesh 0 is the cube from (0, 0, 0) to (1, 1,
/// 1), mesh 1 that cube with faces of 3 x 3 squares.
sundog::SceneDescription over_a_floor();

/// A line_of_sight() scene for closed forms, with the same kernels.
sundog::SceneDescription along(glm::dvec3 from, glm::dvec3 to, glm::dvec3 up = {0, 1, 0});

/// Glass of index 1.5 that absorbs.
int add_glass(sundog::SceneDescription& scene);

/// Places the pieces; meshes are scaled instances of the scene's two meshes, in turn.
void place_pieces(sundog::SceneDescription& scene, const std::vector<Piece>& pieces, int material,
                  const glm::dmat4& turn = glm::dmat4(1));

/// Adds a cube with the piece's bounds to a mesh.
void add_cube(sundog::Mesh& mesh, const Piece& piece);

/// Eight cubes that form the cube from (-1, -1, -1) to (1, 1, 1).
std::vector<Piece> grid_of_cubes(bool mesh);

/// Renders the scene with a tracer and returns the image's values.
std::vector<float> picture(const sundog::DeviceInfo& device, sundog::Tracer tracer,
                           sundog::SceneDescription scene);

int pixels_that_differ(const std::vector<float>& a, const std::vector<float>& b, float tolerance = 1e-5f);

}  // namespace touching
