// Kinds of light, one value each: the row in the lights table, power, bounds, and the object that rays meet.
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

constexpr double pi = std::numbers::pi;

double cosine(double degrees) { return std::cos(degrees * pi / 180); }

glm::vec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

float luminance(const Light& row) {
  return 0.2126f * row.color.x + 0.7152f * row.color.y + 0.0722f * row.color.z;
}

dvec3 unit_direction(const NamedLight& named) {
  const dvec3& direction = named.light.direction;
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length))
    throw SceneError(named.file, named.place + "/direction",
                     fmt::format("wanted a direction, found ({}, {}, {}); give the way the light travels",
                                 direction.x, direction.y, direction.z));
  return direction / length;
}

/// Packs a flat light, whose area is `part` of the parallelogram of its axes.
LampAxes pack_flat(const NamedLight& named, double part, Light& row) {
  unit_direction(named);
  const LampAxes axes = lamp_axes(named.light);
  row.direction = pack(axes.normal, glm::length(glm::cross(axes.u, axes.v)) * part);
  row.edge_u = pack(axes.u, glm::length(axes.u));
  row.edge_v = pack(axes.v, glm::length(axes.v));
  return axes;
}

LampBounds flat_bounds(const Light& row, const glm::vec3& lower, const glm::vec3& upper) {
  return {lower, upper, row.direction.w, luminance(row) * row.direction.w};
}

/// The code of one kind. Area lights have bounds, those with a direction axes, those that rays meet a shape.
struct Kind {
  /// Adds to the row what is not common to all kinds.
  void (*pack)(const NamedLight& named, const dvec3& origin, Light& row);
  double (*power)(const LightDescription& light) = nullptr;  // power_of_intensity()
  dvec2 (*axes)(const LightDescription& light) = nullptr;    // lengths of lamp_axes()
  LampBounds (*bounds)(const Light& row) = nullptr;
  Shape (*shape)(const LightDescription& light) = nullptr;  // what rays meet, with the axis +y
};

/// Packs a sun of the given angular diameter with the directional light's irradiance: a surface that faces it
/// sees a projected solid angle of pi sin^2 of half the angle.
void pack_sun(const LightDescription& light, Light& row) {
  const double half = light.angle * pi / 360, sine = std::sin(half);
  const double cap = 2 * std::sin(half / 2) * std::sin(half / 2);
  row.kind = LIGHT_SUN;
  row.color = pack(light.color * light.intensity / (sine * sine));
  row.direction.w = static_cast<float>(light.hidden ? -cap : cap);
  row.position.w = light.visible ? 0.0f : 1.0f;
}
void pack_directional(const NamedLight& named, const dvec3&, Light& row) {
  row.direction = pack(unit_direction(named));
  if (named.light.angle > 0) pack_sun(named.light, row);
}
constexpr Kind directional_light{.pack = pack_directional};

void pack_point(const NamedLight& named, const dvec3&, Light& row) {
  if (named.light.range > 0) row.edge_v.x = static_cast<float>(1 / named.light.range);
}
constexpr Kind point_light{.pack = pack_point, .power = [](const LightDescription&) { return 4 * pi * pi; }};

void pack_spot(const NamedLight& named, const dvec3& origin, Light& row) {
  const LightDescription& light = named.light;
  row.direction = pack(unit_direction(named), cosine(light.outer_angle));
  row.edge_u.z = static_cast<float>(cosine(light.inner_angle));
  row.edge_u.x = light.square_edge ? 1.0f : 3.0f;
  row.edge_u.y = light.square_edge ? 0.0f : 2.0f;
  pack_point(named, origin, row);
}
/// Over the cosine, the soft edge has the mean 1/2, its square 1/3.
double spot_power(const LightDescription& light) {
  const double outer = cosine(light.outer_angle), inner = cosine(light.inner_angle);
  return 2 * pi * pi * (1 - inner + (inner - outer) * (light.square_edge ? 1.0 / 3 : 0.5));
}
constexpr Kind spot_light{.pack = pack_spot, .power = spot_power};

void pack_rectangle(const NamedLight& named, const dvec3& origin, Light& row) {
  const LampAxes axes = pack_flat(named, 1, row);
  row.position = pack(named.light.position - (axes.u + axes.v) / 2.0 - origin);
}
LampBounds rectangle_bounds(const Light& row) {
  const glm::vec3 p = xyz(row.position), u = xyz(row.edge_u), v = xyz(row.edge_v), none(0);
  return flat_bounds(row, p + glm::min(u, none) + glm::min(v, none),
                     p + glm::max(u, none) + glm::max(v, none));
}
constexpr Kind rectangle_light{
    .pack = pack_rectangle,
    .power = [](const LightDescription& light) { return pi * light.size.x * light.size.y; },
    .axes = [](const LightDescription& light) { return light.size; },
    .bounds = rectangle_bounds,
    .shape = [](const LightDescription& light) -> Shape { return RectangleShape{light.size / 2.0}; }};

LampBounds disk_bounds(const Light& row) {
  const glm::vec3 p = xyz(row.position), u = glm::abs(xyz(row.edge_u)), v = glm::abs(xyz(row.edge_v));
  return flat_bounds(row, p - u - v, p + u + v);
}
constexpr Kind disk_light{
    .pack = [](const NamedLight& named, const dvec3&, Light& row) { pack_flat(named, pi, row); },
    .power = [](const LightDescription& light) { return pi * pi * light.radius * light.radius; },
    .axes = [](const LightDescription& light) { return dvec2(light.radius); },
    .bounds = disk_bounds,
    .shape = [](const LightDescription& light) -> Shape { return DiskShape{light.radius, 0}; }};

void pack_sphere(const NamedLight& named, const dvec3&, Light& row) {
  row.edge_u.w = static_cast<float>(named.light.radius);
}
LampBounds sphere_bounds(const Light& row) {
  const float radius = row.edge_u.w;
  const glm::vec3 middle = xyz(row.position);
  return {middle - radius, middle + radius, 4 * pi * double(radius) * double(radius),
          luminance(row) * 4 * static_cast<float>(pi) * radius * radius};
}
constexpr Kind sphere_light{
    .pack = pack_sphere,
    .power = [](const LightDescription& light) { return 4 * pi * pi * light.radius * light.radius; },
    .bounds = sphere_bounds,
    .shape = [](const LightDescription& light) -> Shape { return SphereShape{light.radius}; }};

#define KIND_OF_LIGHT_ROW(constant, name, placed, aimed, extent) name##_light,
/// By LIGHT_* constant.
constexpr std::array kinds{LIGHTS(KIND_OF_LIGHT_ROW)};
#undef KIND_OF_LIGHT_ROW

constexpr bool is_complete(const Kind& kind, bool placed, bool aimed, LightExtent extent) {
  const bool area = extent != LightExtent::none;
  return (!placed || kind.power) && (!area || kind.bounds) && (!area || !aimed || kind.axes) &&
         (extent != LightExtent::met || kind.shape);
}
#define COMPLETE_LIGHT(constant, name, placed, aimed, extent) \
  static_assert(is_complete(name##_light, placed, aimed, LightExtent::extent), "the light " #name);
LIGHTS(COMPLETE_LIGHT)
#undef COMPLETE_LIGHT

/// Throws std::logic_error for an ambient light, which has no row in the table.
std::size_t row_kind(const LightDescription& light) {
  if (light.type == LightType::ambient) throw std::logic_error("an ambient light has no place and no power");
  return static_cast<std::size_t>(light.type) - 1;
}

bool is_met(const LightDescription& light) { return facts_of(light.type).can_be_met() && !light.hidden; }

/// The transform of an object with axis +y and its centre at the origin.
dmat4 placed_along(const LampAxes& axes, const dvec3& middle) {
  return {glm::dvec4(glm::normalize(axes.u), 0), glm::dvec4(axes.normal, 0),
          glm::dvec4(-glm::normalize(axes.v), 0), glm::dvec4(middle, 1)};
}

}  // namespace

LampAxes lamp_axes(const LightDescription& light) {
  LampAxes axes;
  axes.normal = glm::normalize(light.direction);
  dvec3 side = glm::cross(light.up, axes.normal);
  // If "up" is parallel to the light's direction, use z, or x for a light along z.
  if (glm::length(side) < 1e-6 * glm::length(light.up)) side = glm::cross(dvec3(0, 0, 1), axes.normal);
  if (glm::length(side) < 1e-6) side = glm::cross(dvec3(1, 0, 0), axes.normal);
  side = glm::normalize(side);
  const dvec2 lengths = kinds.at(row_kind(light)).axes(light);
  axes.u = side * lengths.x;
  axes.v = glm::cross(axes.normal, side) * lengths.y;
  return axes;
}

double power_of_intensity(const LightDescription& light) {
  const auto power = kinds.at(row_kind(light)).power;
  if (!power) throw std::logic_error("a light from everywhere has no power");
  return power(light);
}

Light pack_light(const NamedLight& named, const dvec3& origin) {
  const LightDescription& light = named.light;
  Light row{};
  row.kind = static_cast<u32>(row_kind(light));
  row.position = pack(light.position - origin);
  row.color = pack(light.color * light.intensity);
  row.falloff_constant = static_cast<float>(light.falloff.x);
  row.falloff_linear = static_cast<float>(light.falloff.y);
  row.falloff_quadratic = static_cast<float>(light.falloff.z);
  kinds.at(row.kind).pack(named, origin, row);
  if (facts_of(light.type).has_extent()) row.position.w = is_met(light) ? 0.0f : 1.0f;
  return row;
}

LampBounds lamp_bounds(const Light& row) {
  if (row.kind == LIGHT_TRIANGLE) {
    const glm::vec3 p = xyz(row.position), u = xyz(row.edge_u), v = xyz(row.edge_v), none(0);
    return flat_bounds(row, p + glm::min(none, glm::min(u, v)), p + glm::max(none, glm::max(u, v)));
  }
  if (row.kind >= kinds.size() || !kinds.at(row.kind).bounds)
    throw std::logic_error("a light without an extent has no bounds");
  return kinds.at(row.kind).bounds(row);
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
    const Shape shape = kinds.at(row_kind(light)).shape(light);
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
