// Compares a pixel's footprint at the estimated distance of the surface with the spacing of floats there.
#include "compile/view/field_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "formula/evaluate.h"

namespace sundog {
namespace {

// Relative to the largest coordinate: float estimates are off by a few 1e-7.
constexpr double float_footprint = 4e-6;

double at_repeated(const SdfNode& node, const dvec3& p, double unknown);

/// The estimate at `p`; -unknown if it is only known to be inside, and unknown for native code.
double distance_at(const SdfNode& node, const dvec3& p, double unknown) {
  using Kind = SdfNode::Kind;
  const auto child = [&](std::size_t i) { return distance_at(node.children[i], p, unknown); };
  switch (node.kind) {
    case Kind::formula: {
      const FieldValue value = FormulaEvaluator(node.formula).at(p);
      return value.inside && !(value.distance < 0) ? -unknown : value.distance;
    }
    case Kind::native:
      return unknown;
    case Kind::transform:
      return node.scale * distance_at(node.children[0],
                                      glm::transpose(node.rotation) * (p - node.offset) / node.scale,
                                      unknown / node.scale);
    case Kind::repeat:
      return at_repeated(node, p, unknown);
    case Kind::thicken:
      return child(0) - node.amount;
    case Kind::shell:
      return std::abs(child(0)) - node.amount / 2;
    default:
      break;
  }
  double value = child(0);
  for (std::size_t i = 1; i < node.children.size(); ++i)
    value = node.kind == Kind::unite       ? std::min(value, child(i))
            : node.kind == Kind::intersect ? std::max(value, child(i))
                                           : std::max(value, -child(i));
  return value;
}

/// Evaluates the nearest cell and its neighbours.
double at_repeated(const SdfNode& node, const dvec3& p, double unknown) {
  double least = std::numeric_limits<double>::infinity();
  for (int neighbour = 0; neighbour < 27; ++neighbour) {
    const int step[3] = {neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1};
    dvec3 at = p;
    bool used = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(node.period[axis] > 0)) {
        used &= step[axis] == 0;
        continue;
      }
      double cell = std::floor(p[axis] / node.period[axis] + 0.5) + step[axis];
      if (node.count[axis] > 0) cell = std::clamp(cell, -node.count[axis], node.count[axis]);
      at[axis] -= cell * node.period[axis];
    }
    if (used) least = std::min(least, distance_at(node.children[0], at, unknown));
  }
  return least;
}

/// Distance of `p` from the interval; 0 inside.
double beside_interval(const SdfDescription& field, const dvec3& p) {
  double away = glm::length(glm::max(glm::max(field.lower - p, p - field.upper), dvec3(0)));
  if (field.sphere) away = std::max(away, glm::length(p - dvec3(*field.sphere)) - field.sphere->w);
  return away;
}

}  // namespace

FieldView view_of_field(const SceneDescription& scene, const Object& object) {
  const SdfDescription& field =
      scene.fields[static_cast<std::size_t>(std::get<FieldShape>(object.shape).field)];
  const glm::dmat4 object_from_world = glm::inverse(object.world_from_object);
  const Camera& camera = scene.camera;
  FieldView view;
  view.place = dvec3(object_from_world * glm::dvec4(camera.position, 1));
  const double ahead = glm::length(glm::dmat3(object_from_world) * (camera.target - camera.position));
  double distance = std::max(distance_at(field.root, view.place, ahead), beside_interval(field, view.place));
  if (!(distance > 0)) distance = ahead;  // inside
  const double across = ahead / glm::length(camera.target - camera.position) * camera.orthographic;
  view.footprint =
      (camera.orthographic > 0 ? across : distance * 2 * std::tan(camera.fov * std::numbers::pi / 360)) /
      std::max(scene.image.height, 1);
  return view;
}

bool is_deep(const FieldView& view) {
  const double size = std::max({1.0, std::abs(view.place.x), std::abs(view.place.y), std::abs(view.place.z)});
  return view.footprint > 0 && view.footprint < float_footprint * size;
}

std::vector<FieldView> views_of(const SceneDescription& scene) {
  std::vector<FieldView> views(scene.objects.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    if (std::holds_alternative<FieldShape>(scene.objects[i].shape))
      views[i] = view_of_field(scene, scene.objects[i]);
  return views;
}

bool any_deep(const std::vector<FieldView>& views) { return std::ranges::any_of(views, is_deep); }

}  // namespace sundog
