// Bounds smooth objects by balls, shares photons among lights by the light they send to these, and among
// balls by their radii.
#include "compile/lights/photons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "compile/lights/lights.h"
#include "compile/placing/instance_bounds.h"
#include "compile/placing/instances.h"
#include "scene/integrators.h"
#include "scene/lamps.h"

namespace sundog {
namespace {

using std::numbers::pi;
constexpr std::size_t most_targets = 64;  // each costs time for every photon
constexpr double photons_within = 12;     // photons within the first radius, if light is uniform
constexpr double least_share = 0.02;      // of the photons, divided evenly among the emitters

bool is_smooth(const Material& material) {
  return material.flags & (MATERIAL_REFLECTS | MATERIAL_TRANSMITS) && material.reflection.w == 0;
}

bool sends_on(const AllLightsInputs& in, const Instance& instance) {
  if (instance.material != NO_MATERIAL) return is_smooth(in.packed_materials[instance.material]);
  const auto* shape = std::get_if<MeshShape>(&in.objects[instance.object].shape);
  if (!shape) return false;
  return std::ranges::any_of(in.meshes[static_cast<std::size_t>(shape->mesh)].materials, [&](int index) {
    return index >= 0 && is_smooth(in.packed_materials[static_cast<std::size_t>(index)]);
  });
}

glm::dvec3 middle_of(const float4& ball) { return {ball.x, ball.y, ball.z}; }

/// A ball around the instance over its motion; exact for a uniformly scaled sphere.
float4 ball_about(const AllLightsInputs& in, const Instance& instance, const Bounds& box) {
  float4 ball = sphere_around(box);
  if (instance.shape != SHAPE_SPHERE || in.objects[instance.object].moves()) return ball;
  const auto row = [&](int i) { return middle_of(instance.object_from_world[i]); };
  const double square = glm::dot(row(0), row(0)), least = 1e-5 * square;
  for (const int i : {0, 1, 2})
    for (const int k : {0, 1, 2})
      if (std::abs(glm::dot(row(i), row(k)) - (i == k ? square : 0)) > least) return ball;
  ball.w = std::min(ball.w, static_cast<float>(1.0001 / std::sqrt(square)));
  return ball;
}

/// Returns a ball around everything, then balls around smooth objects. A plane is infinite; its relevant part
/// is assumed to be not much farther away than the camera and all other objects.
std::vector<float4> find_balls(const AllLightsInputs& in) {
  Bounds all = Bounds::none(), smooth = Bounds::none();
  std::vector<float4> balls{{}};
  bool plane = false;
  for (std::size_t i = 0; i < in.boxes.size(); ++i) {
    const Instance& instance = in.instances[i];
    const bool sends = sends_on(in, instance), endless = instance.shape == SHAPE_PLANE;
    plane |= sends && endless;
    if (endless) continue;
    all.extend(in.boxes[i]);
    if (!sends) continue;
    smooth.extend(in.boxes[i]);
    balls.push_back(ball_about(in, instance, in.boxes[i]));
  }
  if (balls.size() > most_targets + 1) balls = {{}, sphere_around(smooth)};
  balls[0] = all.lower[0] <= all.upper[0] ? sphere_around(all) : float4{};
  const glm::dvec3 camera = middle_of(in.camera_position);
  const double away = glm::distance(camera, middle_of(balls[0]));
  if (plane) {
    balls[0].w = static_cast<float>(2 * (double(balls[0].w) + away));
    balls.push_back(balls[0]);
  }
  return balls;
}

/// The environment's mean radiance over all directions.
double mean_luminance(const Lights& of_scene) {
  const Environment& e = of_scene.environments[0];
  double sum = 0, weights = 0;
  for (std::size_t y = 0; y < e.height; ++y) {
    const double weight = std::sin(pi * (double(y) + 0.5) / e.height);
    for (std::size_t x = 0; x < e.width; ++x)
      sum += weight * luminance(of_scene.environment[y * e.width + x]);
    weights += weight * e.width;
  }
  return sum / weights;
}

bool has_place(const Light& light) { return PLACED_LIGHTS >> light.kind & 1u; }

/// Estimates the light from a light to a ball.
double light_to_ball(const Light& light, const float4& ball, double environment) {
  const double radius = double(ball.w), across = pi * radius * radius;
  const double bright = luminance(light.color);
  if (light.kind == LIGHT_ENVIRONMENT) return 4 * pi * environment * across;
  if (light.kind == LIGHT_SUN) return 2 * pi * std::abs(double(light.direction.w)) * bright * across;
  if (!has_place(light)) return pi * bright * across;
  const double d = std::max(glm::distance(middle_of(light.position), middle_of(ball)), radius);
  if (LIGHTS_WITHOUT_EXTENT >> light.kind & 1u)
    return pi * bright * across /
           (double(light.falloff_constant) + double(light.falloff_linear) * d +
            double(light.falloff_quadratic) * d * d);
  return bright * lamp_bounds(light).area * across / (d * d);
}

/// Cumulative shares of the lights; empty if none emits.
std::vector<float> share_photons(const std::vector<float4>& balls, const std::vector<Light>& lights,
                                 const Lights& of_scene) {
  const double environment = of_scene.environments.empty() ? 0 : mean_luminance(of_scene);
  std::vector<double> parts;
  for (const Light& light : lights)
    parts.push_back(std::accumulate(balls.begin() + 1, balls.end(), 0.0, [&](double sum, const float4& ball) {
      return sum + light_to_ball(light, ball, environment);
    }));
  const double all = std::reduce(parts.begin(), parts.end());
  if (!(all > 0) || !std::isfinite(all)) return {};
  const double shining = static_cast<double>(std::ranges::count_if(parts, [](double p) { return p > 0; }));
  double sum = 0;
  std::vector<float> sums;
  for (const double part : parts) {
    if (part > 0) sum += (1 - least_share) * part / all + least_share / shining;
    sums.push_back(static_cast<float>(std::min(sum, 1.0)));
  }
  // The last emitter absorbs rounding errors.
  const float last = sums.back();
  for (float& value : sums)
    if (value == last) value = 1;
  return sums;
}

/// Appends planes after the balls, with a negative weight and never sampled
/// (kernels/plain/pathtracer/photon_start.cl): at their positions when the shutter opens and, if they move,
/// when it closes.
void append_planes(const AllLightsInputs& in, std::vector<PhotonTarget>& targets) {
  for (const Instance& instance : in.instances.rows()) {
    if (instance.shape != SHAPE_PLANE) continue;
    float4 plane = instance.object_from_world[1];
    targets.push_back({plane, -1, 2, 0, 0});
    const dvec3 move = in.objects[instance.object].moves_by;
    if (move == dvec3(0)) continue;
    plane.w -= static_cast<float>(glm::dot(middle_of(plane), move));
    targets.push_back({plane, -1, 2, 0, 0});
  }
}

/// Distributes photons to balls in proportion to their radii: small objects cast the sharpest light.
std::vector<PhotonTarget> share_balls(const std::vector<float4>& balls) {
  double sum = 0, all = 0;
  for (std::size_t i = 1; i < balls.size(); ++i) all += double(balls[i].w);
  std::vector<PhotonTarget> targets{{balls[0], 0, 0, 0, 0}};
  for (std::size_t i = 1; i < balls.size(); ++i) {
    const double weight = double(balls[i].w) / all;
    targets.push_back({balls[i], static_cast<float>(weight), static_cast<float>(sum), 0, 0});
    sum += weight;
  }
  return targets;
}

/// A radius that makes the number of photons per estimate independent of their total and of object sizes.
double usual_radius(const std::vector<float4>& balls, double count) {
  double squares = 0;
  for (std::size_t i = 1; i < balls.size(); ++i) squares += double(balls[i].w) * double(balls[i].w);
  return std::sqrt(photons_within * squares / count);
}

bool may_be_inside(const Light& light, const AllLightsInputs& in) {
  return has_place(light) && is_camera_inside(middle_of(light.position), in.instances.rows(), in.boxes);
}

constexpr double least_radius = 1e-15;  // squares of smaller ones vanish in a float

}  // namespace

Photons plan_photons(const AllLightsInputs& in, const std::vector<Light>& lights) {
  const RenderSettings& settings = in.render;
  if (!settings.caustics || !integrator_of(settings.integrator).photons || lights.empty()) return {};
  const std::vector<float4> balls = find_balls(in);
  if (balls.size() < 2 || std::ranges::all_of(balls, [](const float4& ball) { return !(ball.w > 0); }))
    return {};
  std::vector<float> shares = share_photons(balls, lights, in.of_scene);
  if (shares.empty()) return {};
  std::vector<PhotonTarget> targets = share_balls(balls);
  append_planes(in, targets);
  const double radius =
      settings.photon_radius > 0 ? settings.photon_radius : usual_radius(balls, settings.photons);
  const bool inside =
      std::ranges::any_of(lights, [&](const Light& light) { return may_be_inside(light, in); });
  return {std::move(targets),
          std::move(shares),
          {static_cast<u32>(settings.photons), std::max(radius, least_radius), inside}};
}

}  // namespace sundog
