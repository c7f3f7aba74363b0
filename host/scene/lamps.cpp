// Switches over the kinds of light: first the shapes of visible objects, then table rows, power and bounds,
// finally the objects with their materials.
#include "scene/lamps.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/error.h"
#include "scene/kinds.h"
#include "scene/pack.h"

namespace sundog {
namespace {

// Visible objects.

bool is_met(const LightDescription& light) { return facts_of(light.type).can_be_met() && !light.hidden; }

/// The transform of an object with axis +y and its centre at the origin.
dmat4 placed_along(const LampAxes& axes, const dvec3& middle) {
  return {glm::dvec4(glm::normalize(axes.u), 0), glm::dvec4(axes.normal, 0),
          glm::dvec4(-glm::normalize(axes.v), 0), glm::dvec4(middle, 1)};
}

Shape lamp_shape(const LightDescription& light) {
  switch (light.type) {
    case LightType::sphere:
      return SphereShape{light.radius};
    case LightType::disk:
      return DiskShape{light.radius, 0};
    case LightType::rectangle:
      return RectangleShape{light.size / 2.0};
    case LightType::ambient:
    case LightType::directional:
    case LightType::point:
    case LightType::spot:
      break;
  }
  throw std::logic_error("a light without a shape that rays meet");
}

// Table rows.

dvec3 unit_direction(const NamedLight& named) {
  const dvec3& direction = named.light.direction;
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length))
    throw SceneError(named.file, named.place + "/direction",
                     fmt::format("wanted a direction, found ({}, {}, {}); give the way the light travels",
                                 direction.x, direction.y, direction.z));
  return direction / length;
}

double cosine(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

void pack_flat(const NamedLight& named, const LampAxes& axes, double area, Light& packed) {
  unit_direction(named);
  packed.direction = pack(axes.normal, area);
  packed.edge_u = pack(axes.u, glm::length(axes.u));
  packed.edge_v = pack(axes.v, glm::length(axes.v));
}

void pack_rectangle(const NamedLight& named, const dvec3& origin, Light& packed) {
  const LampAxes axes = lamp_axes(named.light);
  pack_flat(named, axes, glm::length(glm::cross(axes.u, axes.v)), packed);
  packed.position = pack(named.light.position - (axes.u + axes.v) / 2.0 - origin);
}

void pack_disk(const NamedLight& named, Light& packed) {
  const LampAxes axes = lamp_axes(named.light);
  pack_flat(named, axes, glm::length(glm::cross(axes.u, axes.v)) * std::numbers::pi, packed);
}

/// Packs a sun of the given angular diameter with the directional light's irradiance: a surface facing it
/// sees a projected solid angle of pi sin^2 of half the angle.
void pack_sun(const LightDescription& light, Light& packed) {
  const double half = light.angle * std::numbers::pi / 360, sine = std::sin(half);
  const double cap = 2 * std::sin(half / 2) * std::sin(half / 2);
  packed.kind = LIGHT_SUN;
  packed.color = pack(light.color * light.intensity / (sine * sine));
  packed.direction.w = static_cast<float>(light.hidden ? -cap : cap);
  packed.position.w = light.visible ? 0.0f : 1.0f;
}

void pack_range(const LightDescription& light, Light& packed) {
  if (light.range > 0) packed.edge_v.x = static_cast<float>(1 / light.range);
}

glm::vec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

}  // namespace

LampAxes lamp_axes(const LightDescription& light) {
  LampAxes axes;
  axes.normal = glm::normalize(light.direction);
  dvec3 side = glm::cross(light.up, axes.normal);
  // If "up" is parallel to the light's direction, use z, or x for a light along z.
  if (glm::length(side) < 1e-6 * glm::length(light.up)) side = glm::cross(dvec3(0, 0, 1), axes.normal);
  if (glm::length(side) < 1e-6) side = glm::cross(dvec3(1, 0, 0), axes.normal);
  side = glm::normalize(side);
  const bool round = light.type == LightType::disk;
  axes.u = side * (round ? light.radius : light.size.x);
  axes.v = glm::cross(axes.normal, side) * (round ? light.radius : light.size.y);
  return axes;
}

double power_of_intensity(const LightDescription& light) {
  constexpr double pi = std::numbers::pi;
  const double outer = cosine(light.outer_angle), inner = cosine(light.inner_angle);
  switch (light.type) {
    case LightType::point:
      return 4 * pi * pi;
    case LightType::spot:  // over the cosine, the soft edge has the mean 1/2, its square 1/3
      return 2 * pi * pi * (1 - inner + (inner - outer) * (light.square_edge ? 1.0 / 3 : 0.5));
    case LightType::rectangle:
      return pi * light.size.x * light.size.y;
    case LightType::disk:
      return pi * pi * light.radius * light.radius;
    case LightType::sphere:
      return 4 * pi * pi * light.radius * light.radius;
    case LightType::ambient:
    case LightType::directional:
      break;
  }
  throw std::logic_error("a light from everywhere has no power");
}

Light pack_light(const NamedLight& named, const dvec3& origin) {
  const LightDescription& light = named.light;
  Light packed{};
  packed.position = pack(light.position - origin);
  packed.color = pack(light.color * light.intensity);
  packed.falloff_constant = static_cast<float>(light.falloff.x);
  packed.falloff_linear = static_cast<float>(light.falloff.y);
  packed.falloff_quadratic = static_cast<float>(light.falloff.z);
  switch (light.type) {
    case LightType::ambient:
      throw std::logic_error("an ambient light is no entry of the table of lights");
    case LightType::point:
      packed.kind = LIGHT_POINT;
      pack_range(light, packed);
      break;
    case LightType::directional:
      packed.kind = LIGHT_DIRECTIONAL;
      packed.direction = pack(unit_direction(named));
      if (light.angle > 0) pack_sun(light, packed);
      break;
    case LightType::spot:
      packed.kind = LIGHT_SPOT;
      packed.direction = pack(unit_direction(named), cosine(light.outer_angle));
      packed.edge_u.z = static_cast<float>(cosine(light.inner_angle));
      packed.edge_u.x = light.square_edge ? 1.0f : 3.0f;
      packed.edge_u.y = light.square_edge ? 0.0f : 2.0f;
      pack_range(light, packed);
      break;
    case LightType::rectangle:
      packed.kind = LIGHT_RECTANGLE;
      pack_rectangle(named, origin, packed);
      break;
    case LightType::disk:
      packed.kind = LIGHT_DISK;
      pack_disk(named, packed);
      break;
    case LightType::sphere:
      packed.kind = LIGHT_SPHERE;
      packed.edge_u.w = static_cast<float>(light.radius);
      break;
  }
  if (facts_of(light.type).has_extent()) packed.position.w = is_met(light) ? 0.0f : 1.0f;
  return packed;
}

LampBounds lamp_bounds(const Light& light) {
  const glm::vec3 p = xyz(light.position), u = xyz(light.edge_u), v = xyz(light.edge_v), none(0);
  const float luminance = 0.2126f * light.color.x + 0.7152f * light.color.y + 0.0722f * light.color.z;
  const float radius = light.edge_u.w, area = light.direction.w, power = luminance * area;
  switch (static_cast<LightKind>(light.kind)) {
    case LIGHT_SPHERE:
      return {p - radius, p + radius, 4 * std::numbers::pi * double(radius) * double(radius),
              luminance * 4 * std::numbers::pi_v<float> * radius * radius};
    case LIGHT_TRIANGLE:
      return {p + glm::min(none, glm::min(u, v)), p + glm::max(none, glm::max(u, v)), area, power};
    case LIGHT_DISK:
      return {p - glm::abs(u) - glm::abs(v), p + glm::abs(u) + glm::abs(v), area, power};
    case LIGHT_RECTANGLE:
      return {p + glm::min(u, none) + glm::min(v, none), p + glm::max(u, none) + glm::max(v, none), area,
              power};
    case LIGHT_DIRECTIONAL:
    case LIGHT_POINT:
    case LIGHT_SPOT:
    case LIGHT_SUN:
    case LIGHT_ENVIRONMENT:
      break;
  }
  throw std::logic_error("a light without an extent has no bounds");
}

void add_lamps(SceneDescription& scene) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const LightDescription& light = scene.lights[i];
    if (!is_met(light)) continue;
    MaterialDescription material;
    material.name = "lamp";
    material.ambient = material.diffuse = dvec3(0);
    material.emission = light.color * light.intensity;
    material.shadow_opaque = true;
    material.off_camera = !light.visible;
    material.group = light.group;
    const Shape shape = lamp_shape(light);
    const bool aimed = facts_of(light.type).aimed;
    const dmat4 place = aimed ? placed_along(lamp_axes(light), light.position)
                              : dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0),
                                      glm::dvec4(light.position, 1));
    scene.materials.push_back(material);
    scene.objects.push_back({"lamp", shape, static_cast<int>(scene.materials.size()) - 1, place,
                             fmt::format("/lights/{}", i), static_cast<int>(i)});
  }
}

}  // namespace sundog
