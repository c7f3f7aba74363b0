// Orients the outline counterclockwise, makes its walls, and triangulates its ends.
#include "scene/procedural/extrusion.h"

#include <algorithm>
#include <numbers>

#include "models/polygon.h"
#include "scene/procedural/ice_block.h"

namespace sundog {

Mesh make_extrusion(const Extrusion& extrusion) {
  std::vector<procedural::ProfilePoint> outline = extrusion.outline;
  if (outline.front().at != outline.back().at) outline.push_back(outline.front());
  procedural::Profile profile = procedural::follow(
      outline, extrusion.curve, procedural::turn_by(1.0 / std::max(extrusion.facets, 8)).x);
  procedural::check_crossings(profile);
  if (procedural::area_of(profile) < 0) profile = procedural::reversed(profile);

  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<glm::uvec3> triangles;
  const auto add = [&](const glm::dvec2& p, double y, const glm::dvec3& normal, const glm::dvec2& uv) {
    positions.emplace_back(p.x, y, -p.y);
    normals.emplace_back(normal);
    uvs.emplace_back(uv);
  };
  double whole = 0, way = 0;
  for (const procedural::ProfileStep& step : profile) whole += glm::length(step.b - step.a);
  for (const procedural::ProfileStep& step : profile) {
    const auto first = static_cast<unsigned>(positions.size());
    const double next = way + glm::length(step.b - step.a);
    for (const double v : {0.0, 1.0}) {
      add(step.a, v * extrusion.height, {step.normal_a.x, 0, -step.normal_a.y}, {way / whole, v});
      add(step.b, v * extrusion.height, {step.normal_b.x, 0, -step.normal_b.y}, {next / whole, v});
    }
    triangles.emplace_back(first, first + 1, first + 3);
    triangles.emplace_back(first, first + 3, first + 2);
    way = next;
  }

  std::vector<glm::vec3> corners;
  for (const procedural::ProfileStep& step : profile) corners.emplace_back(step.a.x, 0, -step.a.y);
  std::vector<glm::uvec3> face;
  if (!models::triangulate(corners, face))
    throw GenerateError("the outline has too many corners for its ends; wanted fewer \"facets\"");
  for (const bool top : {false, true}) {
    const auto first = static_cast<unsigned>(positions.size());
    for (const procedural::ProfileStep& step : profile)
      add(step.a, top ? extrusion.height : 0, {0, top ? 1 : -1, 0}, step.a);
    for (const glm::uvec3& t : face) triangles.push_back(first + (top ? t : glm::uvec3(t.x, t.z, t.y)));
  }
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.normals = std::move(normals);
  mesh.uvs = std::move(uvs);
  mesh.triangles = std::move(triangles);
  return mesh;
}

Mesh make_sweep(const Sweep& sweep) {
  if (sweep.radius > std::min(sweep.size.y, sweep.height))
    throw GenerateError("the curve's \"radius\" is more than the floor's depth or the wall's \"height\"");
  constexpr int facets = 96;
  const glm::dvec2 half = 0.5 * sweep.size;
  const glm::dvec2 centre(sweep.radius, sweep.radius - half.y);  // the curve's, in y and z
  Mesh mesh;
  std::vector<glm::uvec3>& triangles = mesh.triangles.values();
  const auto add_row = [&](const glm::dvec2& at, const glm::dvec2& normal, double way) {
    for (const double x : {-half.x, half.x}) {
      mesh.positions.values().emplace_back(x, at.x, at.y);
      mesh.normals.values().emplace_back(0, normal.x, normal.y);
      mesh.uvs.values().emplace_back(x + half.x, way);
    }
    if (const auto n = static_cast<unsigned>(mesh.positions.size()); n > 2) {
      triangles.emplace_back(n - 4, n - 3, n - 1);
      triangles.emplace_back(n - 4, n - 1, n - 2);
    }
  };
  const double floor = sweep.size.y - sweep.radius;
  add_row({0, half.y}, {1, 0}, 0);
  for (int i = 0; i <= facets; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / facets;
    const glm::dvec2 normal(std::cos(angle), std::sin(angle));
    add_row(centre - sweep.radius * normal, normal, floor + sweep.radius * angle);
  }
  add_row({sweep.height, -half.y}, {0, 1},
          floor + sweep.radius * (0.5 * std::numbers::pi - 1) + sweep.height);
  return mesh;
}

}  // namespace sundog
