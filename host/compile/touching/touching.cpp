// Sets Instance.touch of instances with a face that may coincide, exactly or up to rounding, with a face of
// another instance or of their own mesh, if at least one of the two has an interior medium. Conservative:
// false positives only cost time. A flat face lies on a convex solid if its plane is a supporting plane of
// the solid; triangles are compared with triangles; curved surfaces are searched in ever smaller cells.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "compile/shapes.h"
#include "compile/steps.h"
#include "compile/touching/box_tree.h"
#include "compile/touching/round_surfaces.h"
#include "compile/touching/touching_triangles.h"

namespace sundog {
namespace {

struct Face {
  dvec3 normal;  // unit
  double at;     // normal . p of its points
  Bounds box;
};

struct Body {
  Instance* instance;
  Bounds box;
  UnitShape unit;
  dmat4 world_from_unit;
  const Mesh* mesh;
  double size;  // largest coordinate, the scale of rounding
  bool transmits, plane;
  std::vector<Face> faces;  // flat faces of a solid
};

double greatest(const Bounds& box) {
  double most = 0;
  for (int axis = 0; axis < 3; ++axis)
    most = std::max({most, std::abs(double(box.lower[axis])), std::abs(double(box.upper[axis]))});
  return most;
}

/// The solid's support along `n`.
double farthest(const Body& body, const dvec3& n) {
  const glm::dmat3 linear(body.world_from_unit);
  return glm::dot(n, dvec3(body.world_from_unit[3])) + reach(body.unit, glm::transpose(linear) * n);
}

Face place(const FlatFace& flat, const dmat4& world_from_unit) {
  const glm::dmat3 linear(world_from_unit);
  Face face;
  face.normal = glm::normalize(glm::transpose(glm::inverse(linear)) * flat.normal);
  face.at = glm::dot(face.normal, dvec3(world_from_unit * glm::dvec4(flat.center, 1)));
  if (flat.unbounded) {
    const float inf = std::numeric_limits<float>::infinity();
    face.box = {lanes(-inf), lanes(inf)};
    return face;
  }
  face.box = Bounds::none();
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      const dvec3 corner(world_from_unit * glm::dvec4(flat.center + a * flat.u + b * flat.v, 1));
      face.box.extend(Lanes{float(corner.x), float(corner.y), float(corner.z), 0});
    }
  return face;
}

Body make_body(const TouchingInputs& in, Instance& instance, const Bounds& box) {
  const Object& object = (*in.objects)[instance.object];
  Body body{&instance,
            box,
            unit_shape(*in.file, object),
            object.world_from_object,
            nullptr,
            0,
            (instance.flags & INSTANCE_TRANSMITS) != 0,
            instance.shape == SHAPE_PLANE,
            {}};
  if (const auto* shape = std::get_if<MeshShape>(&object.shape))
    body.mesh = &(*in.meshes)[static_cast<std::size_t>(shape->mesh)];
  body.world_from_unit[3] -= glm::dvec4(*in.origin, 0);
  const dvec3& s = body.unit.scale;
  body.world_from_unit = body.world_from_unit * dmat4(glm::dmat3(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z));
  if (body.plane)
    body.box = {lanes(-std::numeric_limits<float>::infinity()),
                lanes(std::numeric_limits<float>::infinity())};
  else
    body.size = greatest(body.box);
  for (const FlatFace& face : flat_faces(body.unit)) body.faces.push_back(place(face, body.world_from_unit));
  return body;
}

/// The body's triangles whose boxes overlap `box`.
std::vector<PlacedTriangle> triangles_in(const Body& body, const Bounds& box, double slack) {
  std::vector<dvec3> at;
  at.reserve(body.mesh->positions.size());
  for (const glm::vec3& p : body.mesh->positions)
    at.push_back(dvec3(body.world_from_unit * glm::dvec4(dvec3(p), 1)));
  std::vector<PlacedTriangle> found;
  for (const glm::uvec3& t : body.mesh->triangles) {
    const PlacedTriangle triangle{{at[t.x], at[t.y], at[t.z]}};
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax({at[t.x][axis], at[t.y][axis], at[t.z][axis]});
      apart |= low > double(box.upper[axis]) + slack || high < double(box.lower[axis]) - slack;
    }
    if (!apart) found.push_back(triangle);
  }
  return found;
}

bool leans_on(const Body& solid, const dvec3& normal, double at, double tolerance) {
  return std::abs(farthest(solid, normal) - at) <= tolerance ||
         std::abs(farthest(solid, -normal) + at) <= tolerance;
}

bool face_on_solid(const Body& a, const Body& solid, double tolerance) {
  if (solid.plane) return false;  // its own face is tested
  // A ball on a floor touches it in one point, which is not worth a test at each hit.
  if (solid.unit.shape == SHAPE_SPHERE) return false;
  return std::any_of(a.faces.begin(), a.faces.end(), [&](const Face& face) {
    return overlap(face.box, solid.box, tolerance) && leans_on(solid, face.normal, face.at, tolerance);
  });
}

bool planes_touch(const Face& a, const Face& b, double tolerance) {
  const double along = glm::dot(a.normal, b.normal);
  return std::abs(along) > 1 - 1e-9 && std::abs(a.at - std::copysign(b.at, along * b.at)) <= tolerance;
}

bool mesh_on_solid(const Body& mesh, const Body& solid, double tolerance) {
  for (const PlacedTriangle& t : triangles_in(mesh, solid.box, tolerance)) {
    const dvec3 normal = glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const double size = glm::length(normal);
    if (!(size > 0)) continue;
    if (!solid.plane) {
      if (leans_on(solid, normal / size, glm::dot(normal, t.corner[0]) / size, tolerance)) return true;
      continue;
    }
    const Face& face = solid.faces[0];
    const auto on_plane = [&](const dvec3& p) {
      return std::abs(glm::dot(face.normal, p) - face.at) <= tolerance;
    };
    if (on_plane(t.corner[0]) && on_plane(t.corner[1]) && on_plane(t.corner[2])) return true;
  }
  return false;
}

Bounds common(const Bounds& a, const Bounds& b) {
  return {lanes_max(a.lower, b.lower), lanes_min(a.upper, b.upper)};
}

bool touch(const Body& a, const Body& b, double tolerance) {
  if (a.mesh && b.mesh) {
    const Bounds box = common(a.box, b.box);
    const auto of_b = triangles_in(b, box, tolerance);
    return !of_b.empty() && any_lies_on(triangles_in(a, box, tolerance), of_b, tolerance);
  }
  if (a.mesh) return mesh_on_solid(a, b, tolerance);
  if (b.mesh) return mesh_on_solid(b, a, tolerance);
  if (a.plane && b.plane) return planes_touch(a.faces[0], b.faces[0], tolerance);
  if (face_on_solid(a, b, tolerance) || face_on_solid(b, a, tolerance)) return true;
  return round_surfaces_touch({a.unit, a.world_from_unit}, {b.unit, b.world_from_unit}, common(a.box, b.box),
                              tolerance);
}

/// Searches pairs of bodies and marks those that touch.
class Search {
 public:
  /// `instances`: the instances to mark.
  Search(const TouchingInputs& in, std::span<Instance> instances) : camera_(in.camera_reach) {
    for (std::size_t i = 0; i < in.instances->instance_count; ++i)
      bodies_.push_back(make_body(in, instances[i], in.instances->boxes[i]));
  }

  bool run() {
    std::sort(bodies_.begin(), bodies_.end(),
              [](const Body& a, const Body& b) { return a.box.lower[0] < b.box.lower[0]; });
    std::vector<LooseBox> boxes;
    for (const Body& body : bodies_) boxes.push_back({body.box, tolerance(body, body)});
    const BoxTree tree(boxes);
    std::vector<u32> others;
    for (u32 i = 0; i < bodies_.size(); ++i) {
      look_within(bodies_[i]);
      tree.find(boxes[i], i, others);
      for (const u32 k : others) look_between(bodies_[i], bodies_[k], tolerance(bodies_[i], bodies_[k]));
    }
    return found_;
  }

 private:
  // Secondary rays start this far off a surface: offset_distance() in kernels/plain/shade/interaction.cl.
  double tolerance(const Body& a, const Body& b) const {
    return 0x1p-19 * std::max({a.size, b.size, camera_, 1e-30});
  }

  void mark(Body& body, double size) {
    body.instance->touch = std::max(body.instance->touch, std::max(float(size * 0x1p-21), 1e-30f));
    found_ = true;
  }

  void look_within(Body& body) {
    if (!body.mesh || !body.transmits) return;
    const auto known = within_.find(body.mesh);
    const bool touches = known != within_.end() ? known->second : any_lies_on_itself(body);
    within_[body.mesh] = touches;
    if (touches) mark(body, body.size);
  }

  bool any_lies_on_itself(const Body& body) const {
    return any_lies_on(triangles_in(body, body.box, body.size), {}, tolerance(body, body));
  }

  void look_between(Body& a, Body& b, double slack) {
    const double size = std::max(a.size, b.size);
    const auto marked = [&](const Body& body) {
      return double(body.instance->touch) >= size * 0x1p-21 * 0.999 && body.instance->touch > 0;
    };
    if (!(a.transmits || b.transmits) || (marked(a) && marked(b))) return;
    if (!touch(a, b, slack)) return;
    mark(a, size);
    mark(b, size);
  }

  std::vector<Body> bodies_;
  std::map<const Mesh*, bool> within_;
  double camera_;
  bool found_ = false;
};

/// The largest coordinate for rounding at the camera, rounded up to a power of two so that an orbiting camera
/// causes no new search.
double camera_reach(const SceneDescription& scene, const dvec3& origin) {
  const dvec3 camera = glm::abs(scene.camera.position - origin);
  const double reach = std::max({camera.x, camera.y, camera.z});
  return reach > 0 ? std::exp2(std::ceil(std::log2(reach))) : 0;
}

}  // namespace

TouchingInputs touching_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Instances>& instances) {
  return {.instances = instances,
          .camera_reach = camera_reach(scene, origin),
          .file = file_of(scene),
          .origin = {origin},
          .objects = {scene.objects},
          .meshes = {scene.meshes}};
}

Touching compile_touching(const TouchingInputs& in) {
  Touching out;
  out.instances = in.instances->instances;
  out.any = Search(in, out.instances.edit()).run();
  return out;
}

}  // namespace sundog
