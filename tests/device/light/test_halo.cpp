// Halos: light through hexagonal prisms against closed forms (Tape, "Atmospheric Halos", 1994; Greenler
// 1980), and maps of the sky that are the same whoever traces them.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "catch.h"
#include "compile/halo/halo_map.h"
#include "devices.h"
#include "render/device/halo_tracer.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr u32 count = 1u << 14;
constexpr int basal = -1;

/// Follows each ray to its first face inside, which it leaves there or not: where it is seen (world, z up)
/// and its weight; then the faces where it entered and left.
const char* const meet_kernel = R"(
#include "lib/core/lanes.h"
#include "shared/halo.h"
#include "plain/halo/exits.cl"
int face_at(const HaloLaunch* launch, REAL3 o) {
  const REAL3 s = along_sides(o);
  const float most = fmax(fabs(s.x), fmax(fabs(s.y), fabs(s.z)));
  if (fabs(o.z) / launch->half_height > most) return -1;
  return fabs(s.x) == most ? 0 : fabs(s.y) == most ? 1 : 2;
}
__kernel void meet(HaloLaunch launch, __global float4* seen, __global int* faces, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  CrystalRays ray;
  enter_crystal(&launch, i, &ray, ALL_LANES);
  faces[2u * i] = face_at(&launch, ray.o);
  const LeavingLights light = reflect_inside(&launch, &ray, ALL_LANES);
  faces[2u * i + 1u] = face_at(&launch, ray.o);
  const REAL3 d = light.d, x = ray.x, y = ray.y, z = ray.z;
  seen[i] = (float4)(-(d.x * x.x + d.y * y.x + d.z * z.x), -(d.x * x.y + d.y * y.y + d.z * z.y),
                     -(d.x * x.z + d.y * y.z + d.z * z.z), light.weight);
}
)";

struct Seen {
  dvec3 d;
  double from_sun = 0, azimuth = 0, altitude = 0;  // degrees
  int entered = 0, left = 0;
};

/// One kind of crystals under a sun of size 0.
EnvironmentDescription sky_with(u32 shape, double altitude, double index, double ratio = 1) {
  EnvironmentDescription e;
  e.type = EnvironmentType::halo;
  e.sun_altitude = altitude;
  e.sun_size = 0;
  e.halo.ior = index;
  e.halo.crystals = {{shape, ratio, 0, 0, 1}};
  e.halo.rays = 16 * 4000;
  e.halo.cells = 64;
  return e;
}

class Meeting {
 public:
  explicit Meeting(const DeviceInfo& info) : device_(info) {
    kernel_ = build_text(device_, meet_kernel, {{"TILE_W", "1"}, {"TILE_H", "1"}, {"LANES", "1"}})
                  .kernel<HaloLaunch, Buffer<float4>, Buffer<i32>, u32>("meet");
  }

  /// The light that leaves at the first face that it meets inside.
  std::vector<Seen> seen(const EnvironmentDescription& e) {
    const HaloLaunch launch = plan_halo(e).bands.at(0).at(0);
    const auto out = device_.make<float4>(count);
    const auto faces = device_.make<i32>(2 * count);
    device_.run(kernel_, {.x = count}, launch, out, faces, count);
    std::vector<float4> seen(count);
    std::vector<i32> met(2 * count);
    device_.read(out, std::span<float4>(seen));
    device_.read(faces, std::span<i32>(met));
    const dvec3 sun(std::cos(e.sun_altitude * degree), 0, std::sin(e.sun_altitude * degree));
    std::vector<Seen> all;
    for (u32 i = 0; i < count; ++i) {
      if (!(seen[i].w > 0)) continue;
      Seen s{{seen[i].x, seen[i].y, seen[i].z}, 0, 0, 0, met[2 * i], met[2 * i + 1]};
      REQUIRE(glm::length(s.d) == Approx(1).margin(2e-5));
      s.from_sun = std::acos(std::clamp(glm::dot(s.d, sun), -1.0, 1.0)) / degree;
      s.azimuth = std::abs(std::atan2(s.d.y, s.d.x)) / degree;
      s.altitude = std::asin(std::clamp(s.d.z, -1.0, 1.0)) / degree;
      all.push_back(s);
    }
    return all;
  }

 private:
  Device device_;
  Kernel<HaloLaunch, Buffer<float4>, Buffer<i32>, u32> kernel_;
};

/// Between two side faces at 60 degrees; those of one pair are parallel.
bool crosses_sides(const Seen& s) { return s.entered != basal && s.left != basal && s.entered != s.left; }
bool crosses_edge(const Seen& s) { return (s.entered == basal) != (s.left == basal); }
bool from_basal(const Seen& s) { return s.entered == basal && s.left != basal; }

template <class Which, class Member>
std::vector<double> values(const std::vector<Seen>& seen, const Which& which, const Member& member) {
  std::vector<double> found;
  for (const Seen& s : seen)
    if (which(s)) found.push_back(s.*member);
  return found;
}

}  // namespace

TEST_CASE("halos begin at the least angle by which light is turned, at 22 and 46 degrees") {
  on_every_device([&](const DeviceInfo& device) {
    Meeting meeting(device);
    const double edges[3][3] = {{1.306, 21.54, 44.88}, {1.31, 21.84, 45.73}, {1.317, 22.37, 47.26}};
    for (const auto& [index, inner, outer] : edges) {
      const std::vector<Seen> seen = meeting.seen(sky_with(HALO_RANDOM, 20, index));
      const std::vector<double> sides = values(seen, crosses_sides, &Seen::from_sun),
                                across = values(seen, crosses_edge, &Seen::from_sun);
      REQUIRE(sides.size() > 500);
      REQUIRE(across.size() > 100);
      CHECK(*std::ranges::min_element(sides) == Approx(inner).margin(0.03));
      CHECK(*std::ranges::min_element(across) == Approx(outer).margin(0.2));
      CHECK(*std::ranges::min_element(across) > outer - 0.02);
    }
  });
}

TEST_CASE("sundogs stand beside the sun as far as its height says, and vanish above 60.75 degrees") {
  on_every_device([&](const DeviceInfo& device) {
    Meeting meeting(device);
    const double expected[] = {21.84, 22.14, 23.07, 24.79, 27.63, 32.43};
    for (int i = 0; i < 6; ++i) {
      const double height = 10.0 * i * degree, n = 1.31;
      const double across = std::sqrt(n * n - std::pow(std::sin(height), 2)) / std::cos(height);
      const std::vector<Seen> seen = meeting.seen(sky_with(HALO_PLATE, 10.0 * i, n, 8));
      const std::vector<double> from_sun = values(seen, crosses_sides, &Seen::from_sun);
      INFO("sun at " << 10 * i);
      REQUIRE(from_sun.size() > 100);
      CHECK(*std::ranges::min_element(from_sun) == Approx(expected[i]).margin(0.03));
      const std::vector<double> azimuth = values(seen, crosses_sides, &Seen::azimuth);
      CHECK(*std::ranges::min_element(azimuth) ==
            Approx(2 * std::asin(across / 2) / degree - 60).margin(0.03));
      for (const double altitude : values(seen, crosses_sides, &Seen::altitude))
        REQUIRE(std::abs(altitude) == Approx(10.0 * i).margin(0.02));
    }
    CHECK(!values(meeting.seen(sky_with(HALO_PLATE, 60.5, 1.31, 30)), crosses_sides, &Seen::azimuth).empty());
    CHECK(values(meeting.seen(sky_with(HALO_PLATE, 60.9, 1.31, 30)), crosses_sides, &Seen::azimuth).empty());
  });
}

TEST_CASE("the circumzenithal arc needs a sun below 32.2 degrees, and is 57.8 high for one on the horizon") {
  on_every_device([&](const DeviceInfo& device) {
    Meeting meeting(device);
    for (const double height : {0.5, 15.0, 30.0}) {
      const std::vector<double> altitude =
          values(meeting.seen(sky_with(HALO_PLATE, height, 1.31, 0.5)), from_basal, &Seen::altitude);
      REQUIRE(altitude.size() > 10);
      const double sine = std::sqrt(1.31 * 1.31 - std::pow(std::cos(height * degree), 2));
      for (const double a : altitude) REQUIRE(a == Approx(std::asin(sine) / degree).margin(0.05));
      if (height < 1) CHECK(altitude[0] == Approx(57.8).margin(0.05));
    }
    CHECK(!values(meeting.seen(sky_with(HALO_PLATE, 32.1, 1.31, 0.5)), from_basal, &Seen::altitude).empty());
    CHECK(values(meeting.seen(sky_with(HALO_PLATE, 32.3, 1.31, 0.5)), from_basal, &Seen::altitude).empty());
  });
}

TEST_CASE("a halo's map has the same bits from every device, number of lanes, work-group and from the host") {
  EnvironmentDescription e = sky_with(HALO_PLATE, 25, 0, 0.4);
  e.sun_size = 0.53;
  e.halo.crystals = {{HALO_PLATE, 0.4, 2, 1, 1},
                     {HALO_COLUMN, 2, 1, 1, 1},
                     {HALO_PARRY, 2, 1, 2, 1},
                     {HALO_RANDOM, 1, 1, 1, 1}};
  e.halo.rays = 16 * 1000;
  const HaloPlan plan = plan_halo(e);
  const HaloMap host = trace_halo(plan);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto check = [&](const HaloLaunchSizes& sizes) {
      const HaloMap map = trace_halo_on(device, plan, {}, sizes);
      INFO(sizes.lanes << " lanes, groups of " << sizes.local);
      CHECK(map.cells == host.cells);
      CHECK(map.passed == host.passed);
      CHECK(map.kept == host.kept);
    };
    check({});
    check({.lanes = 0, .local = 3});
  });
  Device first(test_devices().front());
  for (const unsigned lanes : {1u, 4u, 8u, 16u})
    CHECK(trace_halo_on(first, plan, {}, {.lanes = lanes, .local = 2}).cells == host.cells);
}
