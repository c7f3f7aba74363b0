// Coordinates on surfaces: u, v and dpdu of points whose coordinates are known, and of rays' hits on placed
// shapes.
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "every_kind.h"
#include "render/device/device_scene.h"
#include "render/device/kernel_config.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec2;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;
const KernelDefines one_lane{{"TILE_W", "1"}, {"TILE_H", "1"}, {"LANES", "1"}, {"WIDE_VECTORS", "0"}};

/// A solid's part whose points are known by their coordinates.
struct Chart {
  const char* name;
  u32 shape, part;
  glm::vec4 parameters;
  std::function<dvec3(double, double)> point;
};

dvec3 about(double u, double radius, double y) {
  return {radius * std::cos(2 * pi * u), y, -radius * std::sin(2 * pi * u)};
}

std::vector<Chart> charts() {
  const glm::vec4 none(0), block(0.5f, 1.5f, 2.0f, 0.1f);
  const auto face = [](dvec3 half, int axis, int side) {
    return [=](double u, double v) {
      const double a = 2 * u - 1, b = 2 * v - 1;
      const dvec3 q = axis == 0   ? dvec3(side, b, -side * a)
                      : axis == 1 ? dvec3(a, side, -side * b)
                                  : dvec3(side * a, b, side);
      return q * half;
    };
  };
  std::vector<Chart> all{
      {"sphere", SHAPE_SPHERE, 0, none,
       [](double u, double v) { return about(u, std::sin(pi * v), -std::cos(pi * v)); }},
      {"plane", SHAPE_PLANE, 0, none, [](double u, double v) { return dvec3(u, 0, -v); }},
      {"cylinder",
       SHAPE_CYLINDER,
       0,
       {1, 0, 0, 0},
       [](double u, double v) { return about(u, 1, 2 * v - 1); }},
      {"lower cap of a cylinder",
       SHAPE_CYLINDER,
       2,
       {1, 0, 0, 0},
       [](double u, double v) { return dvec3(2 * u - 1, -1, 2 * v - 1); }},
      {"cap of a cylinder",
       SHAPE_CYLINDER,
       1,
       {1, 0, 0, 0},
       [](double u, double v) { return dvec3(2 * u - 1, 1, 1 - 2 * v); }},
      {"cone",
       SHAPE_CONE,
       0,
       {1, 0.25f, 1, 0},
       [](double u, double v) { return about(u, 1 - 0.75 * v, 2 * v - 1); }},
      {"disk", SHAPE_DISK, 0, none, [](double u, double v) { return dvec3(2 * u - 1, 0, 1 - 2 * v); }},
      {"rectangle", SHAPE_RECTANGLE, 0, none,
       [](double u, double v) { return dvec3(2 * u - 1, 0, 1 - 2 * v); }},
      {"torus", SHAPE_TORUS, 0, {0.25f, 0, 0, 0}, [](double u, double v) {
         return about(u, 1 + 0.25 * std::cos(2 * pi * v), 0.25 * std::sin(2 * pi * v));
       }}};
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      all.push_back({"box", SHAPE_BOX, 0, none, face(dvec3(1), axis, side)});
      all.push_back({"round box", SHAPE_ROUNDBOX, 0, block, face(dvec3(0.5, 1.5, 2), axis, side)});
    }
  return all;
}

const char* const chart_kernel = R"(
#include "lib/solids/solids.cl"
__kernel void locate(__global const float4* points, __global float* out, u32 shape, u32 part, float4 parameters, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  Scene scene;
  scene.profiles = (__global const ProfileArc*)points;  // no lathe is asked for; llvmpipe falls over a null pointer
  SurfacePoints at;
  points_on_solid(&scene, shape, parameters, all3(points[i].xyz), (int)part, ALL_LANES, &at);
  __global float* to = out + 5u * i;
  to[0] = at.u; to[1] = at.v; to[2] = at.dpdu.x; to[3] = at.dpdu.y; to[4] = at.dpdu.z;
}
)";

/// Rays that look at a scene, and what is found where they arrive.
struct Found {
  dvec3 p, dpdu;
  dvec2 uv;
};

const char* const look_kernel = R"(
#include "lib/shade/bsdf.cl"
#include "lib/trace/traverse.cl"
__kernel void look(SCENE_PARAMETERS, __global const Ray* rays, __global float* out, u32 count) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const REAL3 o = real3(rays[i].ox, rays[i].oy, rays[i].oz), d = unit3(real3(rays[i].dx, rays[i].dy, rays[i].dz));
  const REAL t_min = 0.0f;
  Hits hits;
  const TraceRays rays_of = {&o, &d, &t_min, &hits, 0, 0};
  trace_batch(&scene, &rays_of, 1e30f, 0.0f, ALL_LANES, false);
  const Faces faces = hit_faces(&scene, d, &hits, hit_anything(&hits));
  SurfaceInteractions s;
  interact(&scene, o, d, &hits, &faces, &s, hit_anything(&hits));
  __global float* to = out + 8u * i;
  to[0] = s.p.x; to[1] = s.p.y; to[2] = s.p.z; to[3] = s.at.u;
  to[4] = s.at.dpdu.x; to[5] = s.at.dpdu.y; to[6] = s.at.dpdu.z; to[7] = s.at.v;
}
)";

std::vector<Found> look(Device& device, const SceneDescription& scene, const std::vector<Ray>& rays) {
  const CompiledScene flat = compile(scene);
  const DeviceScene tables = upload_scene(device, flat);
  KernelDefines defines = one_lane;
  defines["WIDE_VECTORS"] = traces_compact(flat, device.info()) ? "0" : "1";
  defines["HAS_OBJECT_MOTION"] = defines["HAS_TURNS"] = "0";  // what rests has no row in the table of moves
  auto kernel =
      scene_kernel<Buffer<Ray>, Buffer<float>, u32>(build_text(device, look_kernel, defines), "look");
  const auto in = device.upload<Ray>(rays);
  const auto out = device.make<float>(8 * rays.size());
  run_scene_kernel(device, kernel, {.x = rays.size()}, tables, in, out, static_cast<u32>(rays.size()));
  std::vector<float> v(8 * rays.size());
  device.read(out, std::span<float>(v));
  std::vector<Found> found;
  for (std::size_t i = 0; i < v.size(); i += 8)
    found.push_back({{v[i] + flat.origin.x, v[i + 1] + flat.origin.y, v[i + 2] + flat.origin.z},
                     {v[i + 4], v[i + 5], v[i + 6]},
                     {v[i + 3], v[i + 7]}});
  return found;
}

/// Rays straight down on a grid over [-0.8, 0.8]^2.
std::vector<Ray> rays_down() {
  std::vector<Ray> rays;
  for (int i = 0; i < 81; ++i)
    rays.push_back({float(i % 9) * 0.2f - 0.8f, 5, float(i / 9) * 0.2f - 0.79f, 0, 0, -1, 0, INFINITY});
  return rays;
}

}  // namespace

TEST_CASE("each kind of solid has points whose coordinates are known") {
  for (const Shape& solid : every_solid()) {
    if (std::holds_alternative<LatheShape>(solid)) continue;  // needs its scene's table: below
    INFO(name_of(solid));
    const std::vector<Chart> all = charts();
    CHECK(std::any_of(all.begin(), all.end(),
                      [&](const Chart& chart) { return chart.shape == solid.index(); }));
  }
}

TEST_CASE("who looks at the outside of a solid sees u to the right of v") {
  for (const Chart& chart : charts()) {
    INFO(chart.name);
    const double h = 1e-4, u = 0.3, v = 0.6;
    const dvec3 p = chart.point(u, v), along_u = chart.point(u + h, v) - p,
                along_v = chart.point(u, v + h) - p;
    // Away from the middle of the solid, or of a torus's tube; flat ones are looked at from above.
    dvec3 outside = p;
    if (chart.shape == SHAPE_PLANE || chart.shape == SHAPE_DISK || chart.shape == SHAPE_RECTANGLE)
      outside = {0, 1, 0};
    if (chart.shape == SHAPE_TORUS) outside -= about(u, 1, 0);
    CHECK(glm::dot(glm::cross(along_u, along_v), outside) > 0);
  }
}

TEST_CASE("points on solids have the coordinates that they were made from, and dpdu is their derivative") {
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto kernel = build_text(device, chart_kernel, one_lane)
                      .kernel<Buffer<float4>, Buffer<float>, u32, u32, float4, u32>("locate");
    for (const Chart& chart : charts()) {
      INFO(chart.name);
      std::vector<float4> points;
      std::vector<dvec2> made;
      for (int i = 0; i < 64; ++i) {
        made.push_back({(i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8});
        const dvec3 p = chart.point(made.back().x, made.back().y);
        points.push_back({float(p.x), float(p.y), float(p.z), 0});
      }
      const auto in = device.upload<float4>(points);
      const auto out = device.make<float>(5 * points.size());
      const glm::vec4& q = chart.parameters;
      device.run(kernel, {.x = points.size()}, in, out, chart.shape, chart.part, float4{q.x, q.y, q.z, q.w},
                 static_cast<u32>(points.size()));
      std::vector<float> v(5 * points.size());
      device.read(out, std::span<float>(v));
      for (std::size_t i = 0; i < made.size(); ++i) {
        const double h = 1e-4, a = made[i].x, b = made[i].y;
        const dvec3 slope = (chart.point(a + h, b) - chart.point(a - h, b)) / (2 * h);
        const dvec3 dpdu(v[5 * i + 2], v[5 * i + 3], v[5 * i + 4]);
        REQUIRE(double(v[5 * i]) == Approx(a).margin(1e-5));
        REQUIRE(double(v[5 * i + 1]) == Approx(b).margin(1e-5));
        REQUIRE(glm::distance(dpdu, slope) < 1e-4 * (1 + glm::length(slope)));
      }
    }
  });
}

TEST_CASE("hits on a placed sphere have coordinates of its own space and dpdu in the world") {
  const glm::dmat4 place =
      glm::rotate(glm::scale(glm::translate(glm::dmat4(1), dvec3(0.1, 0.2, -0.1)), dvec3(1.5, 1, 2)), 0.7,
                  glm::normalize(dvec3(1, 2, 3)));
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scenes::place(scene, SphereShape{1}, scenes::add_white(scene), place);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (const Found& found : look(device, scene, rays_down())) {
      const dvec3 p = dvec3(glm::inverse(place) * glm::dvec4(found.p, 1));
      REQUIRE(glm::length(p) == Approx(1).epsilon(1e-4));
      const double turn = std::atan2(-p.z, p.x) / (2 * pi);
      CHECK(found.uv.x == Approx(turn - std::floor(turn)).margin(1e-4));
      CHECK(found.uv.y == Approx(0.5 + std::asin(p.y) / pi).margin(1e-4));
      const dvec3 expected = glm::dmat3(place) * (2 * pi * dvec3(p.z, 0, -p.x));
      CHECK(glm::distance(found.dpdu, expected) < 1e-3);
    }
  });
}

TEST_CASE("hits on a lathe have its angle and the share of its profile's length, and dpdu in the world") {
  const double r = 1.3, whole = 2 * r + 2;
  LatheShape lathe;
  lathe.profile = {{{0, -1}, {0, -1}, {r, -1}, {r, -1}},
                   {{r, -1}, {r, -1}, {r, 1}, {r, 1}},
                   {{r, 1}, {r, 1}, {0, 1}, {0, 1}}};
  lathe.radius = r;
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scenes::place(scene, lathe, scenes::add_white(scene));
  std::vector<Ray> rays = rays_down();
  const std::size_t down = rays.size();
  for (int i = 0; i < 40; ++i)
    rays.push_back({5, float(i % 8) * 0.25f - 0.9f, float(i / 8) * 0.5f - 0.99f, 0, -1, 0, 0, INFINITY});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const std::vector<Found> found = look(device, scene, rays);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const dvec3 p = found[i].p;
      const double turn = std::atan2(-p.z, p.x) / (2 * pi), away = std::hypot(p.x, p.z);
      const double along = i < down ? whole - away : r + p.y + 1;
      REQUIRE((i < down ? p.y : away) == Approx(i < down ? 1 : r).epsilon(1e-5));
      CHECK(found[i].uv.x == Approx(turn - std::floor(turn)).margin(1e-4));
      CHECK(found[i].uv.y == Approx(along / whole).margin(1e-4));
      CHECK(glm::distance(found[i].dpdu, 2 * pi * dvec3(p.z, 0, -p.x)) < 1e-3);
    }
  });
}

TEST_CASE("on a mesh u and v are the vertices', and dpdu is the direction in which u grows alone") {
  // A bumpy sheet whose u is half of x and whose v is a third of z, so that dpdu goes along x: (2, slope, 0).
  Mesh mesh;
  constexpr int n = 12;
  const auto height = [](double x, double z) { return 0.2 * std::sin(3 * x) * std::cos(2 * z); };
  for (int i = 0; i < n * n; ++i) {
    const double x = 2.0 * (i % n) / (n - 1) - 1, z = 2.0 * (i / n) / (n - 1) - 1;
    mesh.positions.push_back({float(x), float(height(x, z)), float(z)});
    mesh.uvs.push_back({float(x / 2), float(z / 3)});
  }
  for (u32 row = 0; row + 1 < n; ++row)
    for (u32 column = 0; column + 1 < n; ++column) {
      const u32 a = row * n + column;
      mesh.triangles.push_back({a, a + n, a + 1});
      mesh.triangles.push_back({a + 1, a + n, a + n + 1});
    }
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scene.meshes.push_back(mesh);
  scenes::place(scene, MeshShape{0}, scenes::add_white(scene));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const std::vector<Ray> rays = rays_down();
    const std::vector<Found> found = look(device, scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CHECK(found[i].uv.x == Approx(rays[i].ox / 2).margin(1e-5));
      CHECK(found[i].uv.y == Approx(rays[i].oz / 3).margin(1e-5));
      CHECK(found[i].dpdu.x == Approx(2).epsilon(1e-4));
      CHECK(found[i].dpdu.z == Approx(0).margin(1e-3));
      CHECK(std::abs(found[i].dpdu.y) < 1.3);  // 2 times the greatest slope
    }
  });
}
