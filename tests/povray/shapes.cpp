// Writes sundog's shapes in POV-Ray's language.
#include "shapes.h"

#include <limits>

#include "povray_from_scene.h"
#include "text.h"

namespace sundog::povray {

namespace {

constexpr int julia_precision = 60;  // of the 20 that POV-Ray starts from: with fewer its surface shows steps

// Three boxes, twelve cylinders along the edges and eight balls at the corners.
std::string open_round_box(const RoundBoxShape& s) {
  const dvec3 inner = s.half - dvec3(s.radius);
  std::string out = "merge { ";
  for (int axis = 0; axis < 3; axis++) {
    dvec3 half = inner;
    half[axis] = s.half[axis];
    out += fmt::format("box {{ {}, {} }} ", text(-half), text(half));
  }
  for (int corner = 0; corner < 8; corner++) {
    const dvec3 at{corner & 1 ? inner.x : -inner.x, corner & 2 ? inner.y : -inner.y,
                   corner & 4 ? inner.z : -inner.z};
    out += fmt::format("sphere {{ {}, {} }} ", text(at), text(s.radius));
    for (int axis = 0; axis < 3; axis++) {
      if (corner & (1 << axis)) continue;
      dvec3 end = at;
      end[axis] = -at[axis];
      out += fmt::format("cylinder {{ {}, {}, {} }} ", text(at), text(end), text(s.radius));
    }
  }
  return out;
}

/// A distance field in POV-Ray, which knows only the quaternion Julia set of a square or a cube.
std::string open_field(const SdfDescription& field) {
  const bool is_leaf = field.root.kind == SdfNode::Kind::formula && field.root.formula.steps.size() == 1;
  const FormulaStep* step = is_leaf ? &field.root.formula.steps[0] : nullptr;
  if (!step || step->definition.name != "julia" || field.sphere)
    throw Unsupported("POV-Ray has no counterpart of this distance field");
  const std::vector<double>& v = step->values;  // power, seed, slice
  if (v.at(0) != 2 && v.at(0) != 3) throw Unsupported("POV-Ray has squares and cubes alone");
  return fmt::format(
      "julia_fractal {{ <{},{},{},{}> quaternion {} max_iteration {} precision {} slice <0,0,0,1>, {} ",
      text(v[1]), text(v[2]), text(v[3]), text(v[4]), v[0] == 2 ? "sqr" : "cube",
      field.root.formula.iterations, julia_precision, text(v.at(5)));
}

struct OpenShape {
  const SceneDescription& scene;
  std::string operator()(const MeshShape& s) const { return "object { " + mesh_name(s.mesh) + " "; }
  std::string operator()(const FieldShape& s) const {
    return open_field(scene.fields.at(static_cast<std::size_t>(s.field)));
  }
  std::string operator()(const SphereShape& s) const {
    return fmt::format("sphere {{ 0, {} ", text(s.radius));
  }
  std::string operator()(const PlaneShape&) const { return "plane { y, 0 "; }
  std::string operator()(const BoxShape& s) const {
    return fmt::format("box {{ {}, {} ", text(-s.half), text(s.half));
  }
  std::string operator()(const CylinderShape& s) const {
    return fmt::format("cylinder {{ <0,{},0>, <0,{},0>, {}{} ", text(-s.half_height), text(s.half_height),
                       text(s.radius), s.capped ? "" : " open");
  }
  std::string operator()(const ConeShape& s) const {
    return fmt::format("cone {{ <0,{},0>, {}, <0,{},0>, {}{} ", text(-s.half_height), text(s.bottom_radius),
                       text(s.half_height), text(s.top_radius), s.capped ? "" : " open");
  }
  std::string operator()(const DiskShape& s) const {
    return fmt::format("disc {{ 0, y, {}, {} ", text(s.radius), text(s.inner_radius));
  }
  std::string operator()(const RectangleShape& s) const {  // two triangles
    const dvec3 a(s.half.x, 0, s.half.y), b(-s.half.x, 0, s.half.y);
    return fmt::format("mesh {{ triangle {{ {}, {}, {} }} triangle {{ {}, {}, {} }} ", text(a), text(b),
                       text(-a), text(a), text(-a), text(-b));
  }
  std::string operator()(const TorusShape& s) const {
    return fmt::format("torus {{ {}, {} sturm ", text(s.major_radius), text(s.minor_radius));
  }
  std::string operator()(const RoundBoxShape& s) const { return open_round_box(s); }
  std::string operator()(const LatheShape& s) const {
    std::string points;
    for (const ProfileCubic& cubic : s.profile)
      for (const glm::dvec2& p : {cubic.a, cubic.b, cubic.c, cubic.d})
        points += fmt::format(", <{}, {}>", text(p.x), text(p.y));
    return fmt::format("lathe {{ bezier_spline {}{} sturm ", 4 * s.profile.size(), points);
  }
};

struct HalfSize {
  dvec3 operator()(const MeshShape&) const { return dvec3(0); }   // has bounds of its own
  dvec3 operator()(const FieldShape&) const { return dvec3(2); }  // where a Julia set lies
  dvec3 operator()(const PlaneShape&) const { return dvec3(std::numeric_limits<double>::infinity()); }
  template <class Solid>
  dvec3 operator()(const Solid& solid) const {
    return solid.half_size();
  }
};

void extend(Bounds& bounds, const dvec3& p) {
  bounds.lower = glm::min(bounds.lower, p);
  bounds.upper = glm::max(bounds.upper, p);
}

}  // namespace

std::string mesh_name(int mesh) { return fmt::format("Mesh{}", mesh); }

std::string declare_mesh(const SceneDescription& scene, int index) {
  const Mesh& mesh = scene.meshes.at(static_cast<std::size_t>(index));
  std::string out =
      fmt::format("#declare {} = mesh2 {{\nvertex_vectors {{ {}", mesh_name(index), mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) out += ',' + text(p);
  if (!mesh.normals.empty()) {
    out += fmt::format(" }}\nnormal_vectors {{ {}", mesh.normals.size());
    for (const glm::vec3& n : mesh.normals) out += ',' + text(n);
  }
  out += fmt::format(" }}\nface_indices {{ {}", mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) out += fmt::format(",<{},{},{}>", t.x, t.y, t.z);
  return out + " }\ninside_vector <0.31,0.85,0.42> }\n";
}

std::string open_shape(const SceneDescription& scene, const Shape& shape) {
  return std::visit(OpenShape{scene}, shape);
}

bool Bounds::overlaps(const Bounds& other) const {
  for (int axis = 0; axis < 3; axis++)
    if (upper[axis] <= other.lower[axis] || other.upper[axis] <= lower[axis]) return false;
  return true;
}

Bounds world_bounds(const SceneDescription& scene, const Object& object) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (std::holds_alternative<PlaneShape>(object.shape)) return {dvec3(-infinity), dvec3(infinity)};
  Bounds bounds{dvec3(infinity), dvec3(-infinity)};
  const auto add = [&](const dvec3& p) {
    extend(bounds, dvec3(object.world_from_object * glm::dvec4(p, 1)));
  };
  if (const auto* mesh = std::get_if<MeshShape>(&object.shape)) {
    for (const glm::vec3& p : scene.meshes.at(static_cast<std::size_t>(mesh->mesh)).positions) add(dvec3(p));
    return bounds;
  }
  const dvec3 half = std::visit(HalfSize{}, object.shape);
  for (int corner = 0; corner < 8; corner++)
    add({corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z});
  return bounds;
}

}  // namespace sundog::povray
