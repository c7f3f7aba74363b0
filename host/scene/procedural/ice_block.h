// Generates an irregular block of ice, optionally hollow, and the liquid in it, as closed triangle meshes.
// Each surface is a distance from the block's origin per direction, over a shared grid of directions. So no
// surface intersects itself, and a surface that is nearer at every grid point lies inside the other
// everywhere (in each cone, both are planar triangles).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <stdexcept>

#include "scene/description.h"

namespace sundog {

/// One surface: a box with tilted sides, cut by random planes and hollowed by random balls, softened and
/// rippled. The scene reader enforces the ranges given here.
struct IceSurface {
  glm::dvec3 size{2, 2, 2};    // size of the original box, > 0
  glm::dvec3 offset{0, 0, 0};  // from the block's origin to its centre; the origin must stay well inside
  int chips = 12;              // planes that cut off edges and corners
  int dents = 6;               // shallow hollows
  int softness = 1;            // softness of the edges, 0 (sharp) .. 4 (a pebble)
  double tilt = 0.1;           // maximum slope of the sides
  double roughness = 0.02;     // height of ripples relative to the distance from the origin
};

struct IceBlock {
  std::uint64_t seed = 1;
  int subdivision = 64;  // grid cells per side: 12 * subdivision^2 triangles per surface
  IceSurface outer;
  bool hollow = false;
  IceSurface cavity;
};

/// Thrown if a mesh cannot be generated; the message gives the remedy, the caller adds file and place.
struct GenerateError : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The solid ice: its outer surface and, for a hollow block, the cavity's surface, facing into the cavity.
/// Closed, consistently wound, with smooth normals. Throws GenerateError if the wall is thinner than 1/50 of
/// the distance to the outside, or the origin is not well inside a surface.
Mesh make_ice(const IceBlock& block);

/// A body that fills the cavity up to the plane y = level and extends into the ice by `wall` (0..1) of the
/// ice's thickness. The ice has the higher priority and cuts the liquid off at the wall, so no two surfaces
/// coincide. Throws GenerateError like make_ice, and for a solid block or a level outside the cavity.
Mesh make_ice_liquid(const IceBlock& block, double level, double wall = 0.5);

/// The cavity's lowest and highest points on the vertical axis, which bound the level.
glm::dvec2 cavity_levels(const IceBlock& block);

}  // namespace sundog
