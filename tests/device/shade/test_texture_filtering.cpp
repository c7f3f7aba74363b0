// How images are spread over things without coordinates, the means of patterns too fine for the pixels,
// and the cones that choose levels against neighbouring rays in double precision.
#include <base/image_io.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "assets.h"
#include "catch.h"
#include "devices.h"
#include "scene/load.h"
#include "scenes.h"
#include "surface_testing.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr double pi = std::numbers::pi;

/// A plane with one image as its emission.
SceneDescription plane_with(StoredImage pixels, Mapping mapping) {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  ImageDescription image;
  image.srgb = false;
  image.pixels = std::move(pixels);
  scene.images.push_back(image);
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = 0;
  texture.mapping = mapping;
  scene.textures.push_back(texture);
  scene.materials[0].textures.emission = 0;
  return scene;
}

/// Red is u, green is v, both over [0, 1].
StoredImage coordinates() {
  StoredImage image;
  image.width = image.height = 128;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      for (const int value : {2 * x + 1, 255 - 2 * y, 0, 255})
        image.data.push_back(static_cast<std::uint8_t>(value));
  return image;
}

/// cos(pi r^2 / edge) about the middle: the frequency grows outwards, to half a turn a texel at the edge.
StoredImage zone_plate(int edge) {
  StoredImage image;
  image.width = image.height = edge;
  image.channels = 1;
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      const double dx = x + 0.5 - edge / 2.0, dy = y + 0.5 - edge / 2.0;
      image.data.push_back(
          static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::cos(pi * (dx * dx + dy * dy) / edge))));
    }
  return image;
}

surfaces::Point point_at(const dvec3& p, const dvec3& n, double footprint = 1e-4) {
  surfaces::Point point;
  point.p = {float(p.x), float(p.y), float(p.z), float(footprint)};
  point.n = {float(n.x), float(n.y), float(n.z), 0};
  point.d = {float(-n.x), float(-n.y), float(-n.z), 0};
  return point;
}

double turns_of(double x, double y) {
  const double angle = std::atan2(y, x) / (2 * pi);
  return angle < 0 ? angle + 1 : angle;
}

}  // namespace

TEST_CASE("images are projected along longitude and latitude, longitude and height, and from six sides") {
  const std::vector<dvec3> points = {
      {0.3, 0.2, 0.4}, {-0.5, 0.31, 0.2}, {-0.2, 0.45, -0.7}, {0.6, 0.1, -0.3}};
  const auto check = [&](const DeviceInfo& info, Mapping mapping, const auto& wanted) {
    const SceneDescription scene = plane_with(coordinates(), mapping);
    for (const dvec3& p : points)
      for (const dvec3& n :
           {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)}) {
        const float4 value = surfaces::shade(info, surfaces::Part::projected, scene, point_at(p, n)).value;
        const glm::dvec2 uv = wanted(p, n);
        INFO(p.x << " " << p.y << " " << p.z << " along " << n.x << " " << n.y << " " << n.z);
        CHECK(double(value.x) == Approx(uv.x - std::floor(uv.x)).margin(6e-3));
        CHECK(double(value.y) == Approx(uv.y - std::floor(uv.y)).margin(6e-3));
      }
  };
  on_every_device([&](const DeviceInfo& info) {
    check(info, Mapping::spherical, [](const dvec3& p, const dvec3&) {
      return glm::dvec2(turns_of(p.x, -p.z), 0.5 + std::asin(p.y / glm::length(p)) / pi);
    });
    check(info, Mapping::cylindrical,
          [](const dvec3& p, const dvec3&) { return glm::dvec2(turns_of(p.x, -p.z), p.y); });
    check(info, Mapping::box, [](const dvec3& p, const dvec3& n) {
      if (n.x != 0) return glm::dvec2(-n.x * p.z, p.y);
      if (n.y != 0) return glm::dvec2(p.x, -n.y * p.z);
      return glm::dvec2(n.z * p.x, p.y);
    });
  });
}

// Whoever looks at the outside of things reads the picture: its colours by quarter are those of quarters.png.
TEST_CASE("a picture on solids and by projections reads from left to right") {
  const TemporaryFolder folder;
  Image quarters(2, 2, 3);
  quarters.data = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};  // red and green above blue and white
  write_image(quarters, folder / "quarters.png");
  const auto image = [](const std::string& rest) {
    return R"({"type":"image","file":"quarters.png","filter":"nearest",)" + rest + "}";
  };
  // Half of the longitudes are seen, the third and the fourth quarter of them.
  const std::string half = R"("scale":[0.5,1],"offset":[0.5,0])";
  const std::string plane = R"("type":"plane")";  // behind the others
  const auto things = std::to_array<std::array<std::string, 3>>(
      {{image(half), R"("type":"sphere","radius":0.9)", ""},
       {image(half + R"(,"projection":"spherical")"), R"("type":"sphere","radius":0.9)", ""},
       {image(R"("projection":"cylindrical","scale":[0.5,2],"offset":[0.5,-1])"),
        R"("type":"sphere","radius":0.9)", ""},
       {image(half), R"("type":"cylinder","radius":0.9,"height":1.8)", ""},
       {image(half), R"("type":"cone","bottom_radius":0.9,"top_radius":0.4,"height":1.8)", ""},
       {image(R"("scale":1)"), R"("type":"cylinder","radius":0.9,"height":1.8)", "90"},
       {image(R"("scale":1)"), R"("type":"cylinder","radius":0.9,"height":1.8)", "-90"},
       {image(R"("scale":[0.5,1],"offset":[0.5,0.5])"),
        R"("type":"torus","major_radius":0.6,"minor_radius":0.3)", ""},
       {image(R"("scale":1)"), R"("type":"disk","radius":0.9)", "90"},
       {image(R"("scale":1)"), R"("type":"box","half":[0.9,0.9,0.9])", ""},
       {image(R"("projection":"box","scale":2,"offset":[-1,-1])"), R"("type":"box","half":[0.9,0.9,0.9])",
        "90"},
       {image(R"("projection":"object","scale":2,"offset":[-1,-1])"), R"("type":"sphere","radius":0.9)", ""},
       {image(R"("scale":2,"offset":[-1,-1])"), plane, "90"}});
  std::string textures, materials, objects;
  for (std::size_t i = 0; i < things.size(); ++i) {
    const auto& [texture, shape, turn] = things[i];
    const std::string name = '"' + std::to_string(i) + '"', comma = i ? "," : "";
    const std::string turned = turn.empty() ? "" : R"({"rotate":{"axis":[1,0,0],"degrees":)" + turn + "}},";
    textures += comma + name + ":" + texture;
    materials += comma + name + R"(:{"color":[0,0,0],"emission":)" + name + "}";
    objects += comma + "{" + shape + R"(,"material":)" + name + R"(,"transform":[)" + turned +
               R"({"translate":[)" + std::to_string(2 * i) + (shape == plane ? ",0,-1]}]}" : ",0,0]}]}");
  }
  SceneDescription scene =
      load_scene(folder.write("a.json", R"({"textures":{)" + textures + R"(},"materials":{)" + materials +
                                            R"(},"objects":[)" + objects + R"(],"lights":[]})"));
  scene.image.width = scene.image.height = 8;
  const DeviceInfo& info = test_devices().front();
  for (std::size_t i = 0; i < things.size(); ++i) {
    INFO(i << ": " << things[i][1] << ", " << things[i][0]);
    const double x = 2.0 * static_cast<double>(i);
    scene.camera.position = {x, 0, 200};
    scene.camera.target = {x, 0, 0};
    scene.camera.fov = 0.8 / 200 * 180 / pi;  // 0.8 across: each quarter has 4x4 of the pixels
    const Image seen = scenes::render_on(info, scene).image;
    const auto at = [&](int column, int row) {
      const float* rgb = &seen.data[static_cast<std::size_t>(8 * row + column) * 4];
      return dvec3(rgb[0], rgb[1], rgb[2]);
    };
    // The torus shows its outer equator, which is narrower.
    CHECK(at(1, 2) == dvec3(1, 0, 0));
    CHECK(at(6, 2) == dvec3(0, 1, 0));
    CHECK(at(1, 5) == dvec3(0, 0, 1));
    CHECK(at(6, 5) == dvec3(1, 1, 1));
  }
}

TEST_CASE("a zone plate shows no moire: what is finer than the pixels is grey") {
  constexpr int edge = 256, step = 4;
  const CompiledScene flat = compile(plane_with(zone_plate(edge), Mapping::uv));
  // The energy about the mean where the plate's period is below the pixels' spacing.
  const auto energy = [&](const DeviceInfo& info, double footprint) {
    std::vector<surfaces::Point> points;
    for (int y = step / 2; y < edge; y += step)
      for (int x = step / 2; x < edge; x += step)
        if (std::hypot(x - edge / 2.0, y - edge / 2.0) > double(edge) / step)
          points.push_back(point_at({double(x) / edge, 0, double(y) / edge}, {0, 1, 0}, footprint));
    double sum = 0;
    for (const surfaces::Shaded& shaded : surfaces::shade(info, surfaces::Part::value, flat, points))
      sum += std::pow(double(shaded.value.x) - 0.5, 2);
    return sum / double(points.size());
  };
  on_every_device([&](const DeviceInfo& info) {
    CHECK(energy(info, 0) > 0.012);  // of 0.125: texels alone show it
    CHECK(energy(info, double(step) / edge) < 0.0025);
  });
}

// --- cones ---

namespace {

const char* const cone_text = R"(
#include "lib/shade/bsdf.cl"
#include "plain/shade/cones.cl"
typedef struct ConeIn { float curvature, width, spread, eta, cos_i, cos_t; } ConeIn;
__kernel void run(__global const ConeIn* in, __global float4* out, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const REAL curvature = (REAL)(in[i].curvature), spread = (REAL)(in[i].spread);
  SceneRays rays;
  rays.cone_width = (REAL)(in[i].width);
  rays.cone_spread = spread;
  SceneRays child = rays;
  spread_reflected(curvature, &child, ALL_LANES);
  const float reflected = REAL_LANE(child.cone_spread, 0);
  Interfaces interface;
  interface.eta = (REAL)(in[i].eta);
  interface.cos_i = (REAL)(in[i].cos_i);
  interface.cos_t = (REAL)(in[i].cos_t);
  child = rays;
  spread_transmitted(curvature, &interface, &child, ALL_LANES);
  out[i] = (float4)(reflected, REAL_LANE(child.cone_spread, 0), 0.0f, 0.0f);
}
)";

struct ConeIn {
  float curvature, width, spread, eta, cos_i, cos_t;
};

struct DoubleRay {
  dvec3 o, d;
};

dvec3 refracted(const dvec3& d, const dvec3& n, double eta) {
  const double cos_i = -glm::dot(d, n), k = 1 - (1 - cos_i * cos_i) / (eta * eta);
  return d / eta + (cos_i / eta - std::sqrt(k)) * n;
}

/// Where a ray meets the sphere of radius `r` about the origin: the far side from inside.
DoubleRay at_sphere(const DoubleRay& ray, double r, bool inside) {
  const double b = glm::dot(ray.o, ray.d), root = std::sqrt(b * b - glm::dot(ray.o, ray.o) + r * r);
  return {ray.o + (inside ? -b + root : -b - root) * ray.d, ray.d};
}

/// How fast neighbours across the ray part: the change of the directions by the change of the places, `apart`
/// at the surface.
double parting(const DoubleRay& a, const DoubleRay& b, const dvec3& across) {
  return glm::dot(b.d - a.d, across);
}

}  // namespace

TEST_CASE("the cones of a mirror ball and of glass are those of neighbouring rays") {
  constexpr double r = 2, width = 1e-4, glass = 1.5;
  std::vector<ConeIn> in;
  std::vector<glm::dvec2> wanted;
  for (const double cosine : {0.95, 0.8, 0.6}) {
    const double sine = std::sqrt(1 - cosine * cosine);
    // Rays along -x that meet the ball at the angle; the neighbours are parallel, across and in the plane.
    const dvec3 d(-1, 0, 0), z(0, 0, 1);
    const auto met = [&](double dy, double dz) { return at_sphere({{9, sine * r + dy, dz}, d}, r, false); };
    const DoubleRay middle = met(0, 0), beside = met(0, width), above = met(width, 0);
    const auto mirrored = [&](const DoubleRay& ray) {
      return DoubleRay{ray.o, glm::reflect(ray.d, ray.o / r)};
    };
    const auto through = [&](const DoubleRay& ray) {
      return DoubleRay{ray.o, refracted(ray.d, ray.o / r, glass)};
    };
    // The cone is round: its spread is the mean of both, as areas go.
    const dvec3 out = mirrored(middle).d, in_plane = glm::normalize(glm::cross(out, z));
    const double sagittal = parting(mirrored(middle), mirrored(beside), z),
                 tangential = std::abs(parting(mirrored(middle), mirrored(above), in_plane));
    const double entering = parting(through(middle), through(beside), z);
    in.push_back({float(1 / r), float(width), 0, float(glass), float(cosine),
                  float(std::sqrt(1 - sine * sine / (glass * glass)))});
    wanted.push_back({std::sqrt(sagittal * tangential), entering});
    // Out of the ball again, where the surface is hollow and the cone has the spread that it came by.
    const DoubleRay inside = through(middle), next = through(beside);
    const DoubleRay leaving = at_sphere(inside, r, true), other = at_sphere(next, r, true);
    const double apart = glm::dot(other.o - leaving.o, z);
    const dvec3 n = -leaving.o / r;
    const auto leave = [&](const DoubleRay& ray) {
      return DoubleRay{ray.o, refracted(ray.d, -ray.o / r, 1 / glass)};
    };
    const double cos_in = -glm::dot(inside.d, n);
    in.push_back(
        {float(-1 / r), float(apart), float(entering), float(1 / glass), float(cos_in), float(cosine)});
    wanted.push_back({0, parting(leave(leaving), leave(other), z)});
  }
  // A slab's second side undoes the first.
  const double slanted = std::sqrt(1 - 0.36 / (glass * glass));
  in.push_back({0, float(width), 0.01f, float(glass), 0.8f, float(slanted)});
  in.push_back({0, float(width), float(0.01 / glass), float(1 / glass), float(slanted), 0.8f});
  wanted.push_back({0.01, 0.01 / glass});
  wanted.push_back({0.01 / glass, 0.01});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto out = run_text<float4>(device, cone_text, in);
    for (std::size_t i = 0; i < in.size(); ++i) {
      INFO(i);
      if (wanted[i].x != 0) CHECK(double(out[i].x) == Approx(wanted[i].x).epsilon(5e-3));
      CHECK(double(out[i].y) == Approx(wanted[i].y).epsilon(5e-3));
    }
  });
}

TEST_CASE("bumps add no energy: in a white furnace a white bumpy ball is no brighter than the furnace") {
  SceneDescription scene = scenes::line_of_sight({0, 0, 3}, {0, 0, 0});
  scene.camera.fov = 30;
  scene.lights.clear();
  scene.image.width = scene.image.height = 12;
  scene.render.integrator = "path";
  scene.render.samples = 64;
  scene.render.max_depth = 32;
  scene.environment.type = EnvironmentType::gradient;
  scene.environment.bottom = scene.environment.top = dvec3(1);
  const int material = scenes::add_white(scene);
  scene.materials.back().diffuse = dvec3(1);
  TextureDescription noise;
  noise.kind = TEXTURE_NOISE;
  noise.mapping = Mapping::object;
  noise.placement = glm::scale(glm::dmat4(1), dvec3(6));
  noise.parameter[0] = 1, noise.parameter[1] = 0.5, noise.parameter[2] = 1;
  scene.textures.push_back(noise);
  scene.materials.back().textures.height = 0;
  scene.materials.back().bump = 0.3;
  scenes::place(scene, SphereShape{1}, material);
  const DeviceInfo& info = test_devices().front();
  if (info.native_vector_width == 1) return;  // whose drivers compile so many features for minutes
  const Image image = scenes::render_on(info, scene).image;
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) sum += double(image.data[i]);
  const double mean = sum / (double(image.data.size()) / 4);
  CHECK(mean < 1.005);
  CHECK(mean > 0.5);
}
