// Lathes and the liquid in them: closed, of the right volume, with the profile's normals; bad profiles are
// refused.
#include <algorithm>
#include <cmath>
#include <string>

#include "catch.h"
#include "compile/shapes.h"
#include "mesh_volume.h"
#include "scene/mesh_faults.h"
#include "scene/procedural/ice_block.h"
#include "scene/procedural/lathe.h"

using namespace sundog;
using glm::dvec2;
using glm::dvec3;
using procedural::ProfileCurve;
using procedural::ProfilePoint;

namespace {

constexpr double pi = 3.14159265358979323846;

Lathe lines(std::vector<ProfilePoint> profile, int segments = 256) {
  return {.profile = std::move(profile), .segments = segments};
}
Lathe spline(std::vector<ProfilePoint> profile) {
  return {.profile = std::move(profile), .curve = ProfileCurve::spline};
}

/// Walls and floor 0.2 thick, 2 high.
Lathe beaker() { return lines({{{0, 0}}, {{1, 0}}, {{1, 2}}, {{0.8, 2}}, {{0.8, 0.2}}, {{0, 0.2}}}); }

bool closed(const Mesh& mesh) {
  const MeshFaults faults = find_faults(mesh);
  return faults.open_edges == 0;
}

std::string refusal(const Lathe& lathe) {
  try {
    make_lathe(lathe);
  } catch (const GenerateError& error) {
    return error.what();
  }
  return "";
}
std::string refused_liquid(const Lathe& vessel, double level, double meniscus = 0) {
  try {
    make_lathe_liquid(vessel, level, meniscus);
  } catch (const GenerateError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("turns are those of the library to the last digits") {
  for (int i = -8; i < 200; ++i) {
    const dvec2 turn = procedural::turn_by(i / 97.0);
    CHECK(turn.x == Approx(std::cos(2 * pi * i / 97)).margin(1e-15));
    CHECK(turn.y == Approx(std::sin(2 * pi * i / 97)).margin(1e-15));
  }
}

TEST_CASE("a lathe is closed and has the volume of its profile, whichever way that runs") {
  const std::vector<ProfilePoint> up{{{0, 0}}, {{1, 0}}, {{1, 2}}, {{0, 2}}};
  const Mesh mesh = make_lathe(lines(up)), down = make_lathe(lines({up.rbegin(), up.rend()}));
  CHECK(closed(mesh));
  CHECK(volume(mesh) == Approx(2 * pi).epsilon(2e-4));
  CHECK(volume(down) == Approx(volume(mesh)));
  const Mesh ring = make_lathe(lines({{{2, 0}}, {{3, 0}}, {{3, 1}}, {{2, 1}}, {{2, 0}}}));
  CHECK(closed(ring));
  CHECK(volume(ring) == Approx(5 * pi).epsilon(2e-4));
  CHECK(closed(make_lathe(beaker())));
  CHECK_FALSE(closed(make_lathe(lines({{{1, 0}}, {{1, 2}}}))));
}

TEST_CASE("roundings are arcs, and normals are those of the profile") {
  // Two quarters of a torus on a cylinder: a ball where the roundings meet.
  const Mesh ball = make_lathe(lines({{{0, -1}}, {{1, -1}, 1}, {{1, 1}, 1}, {{0, 1}}}));
  CHECK(volume(ball) == Approx(4 * pi / 3).epsilon(1e-3));
  for (std::size_t i = 0; i < ball.positions.size(); ++i)
    CHECK(glm::length(ball.positions[i] - ball.normals[i]) < 1e-5f);
  // A concave corner keeps more than it loses: (1 - pi / 4) of the square, turned at its middle.
  const std::vector<ProfilePoint> sharp{{{0, 0}}, {{2, 0}}, {{2, 1}}, {{1, 1}}, {{1, 2}}, {{0, 2}}};
  std::vector<ProfilePoint> round = sharp;
  round[3].rounding = 0.5;
  CHECK(volume(make_lathe(lines(round))) > volume(make_lathe(lines(sharp))) + 2 * pi * 0.25 * (1 - pi / 4));
}

TEST_CASE("a spline goes through its points, smooth except at points given twice") {
  const std::vector<ProfilePoint> points{{{0, 0}},     {{0, 0}},     {{1, 0}}, {{1, 0}},
                                         {{1.2, 0.7}}, {{0.8, 1.5}}, {{0, 2}}};
  const auto steps = procedural::follow(points, ProfileCurve::spline, std::cos(0.05));
  double sharpest = 1, elsewhere = 1;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    CHECK(steps[i].a == steps[i - 1].b);
    const double turn = glm::dot(steps[i - 1].normal_b, steps[i].normal_a);
    (steps[i].a == dvec2(1, 0) ? sharpest : elsewhere) =
        std::min(turn, steps[i].a == dvec2(1, 0) ? sharpest : elsewhere);
  }
  CHECK(sharpest < 0.9);
  CHECK(elsewhere > 1 - 1e-9);
  // On the axis it is level.
  CHECK(std::abs(steps.back().normal_b.x) < 1e-12);
  for (const ProfilePoint& point : points)
    CHECK(std::ranges::any_of(steps,
                              [&](const auto& step) { return step.a == point.at || step.b == point.at; }));
  CHECK(closed(make_lathe(spline(points))));
}

TEST_CASE("every normal is one, where a spline runs along the axis or turns back, too") {
  for (const auto& points : {std::vector<ProfilePoint>{{{0, 0}}, {{0, 0.5}}, {{1, 1}}, {{0, 2}}},
                             std::vector<ProfilePoint>{{{0, 0}}, {{1, 1}}, {{2, 2}}, {{1, 1}}, {{0, 3}}}})
    for (const auto& step : procedural::follow(points, ProfileCurve::spline, std::cos(0.05))) {
      CHECK(glm::length(step.normal_a) == Approx(1));
      CHECK(glm::length(step.normal_b) == Approx(1));
    }
}

TEST_CASE("a liquid reaches half way into the wall and up to its level") {
  const Mesh liquid = make_lathe_liquid(beaker(), 1, 0);
  CHECK(closed(liquid));
  CHECK(volume(liquid) == Approx(pi * 0.9 * 0.9 * 0.9).epsilon(2e-4));
  for (const glm::vec3& p : liquid.positions) {
    CHECK(p.y <= 1.0f);
    CHECK(p.y >= Approx(0.1));
  }
  // The meniscus adds the cubic's volume and its rise over the wall.
  const Mesh risen = make_lathe_liquid(beaker(), 1, 0.05);
  CHECK(closed(risen));
  float top = 0;
  for (const glm::vec3& p : risen.positions) top = std::max(top, p.y);
  CHECK(top == Approx(1.05));
  const double w = 0.15, r = 0.8, ring = 2 * pi * 0.05 * w * (r / 4 - w / 20);
  const double in_wall = pi * (0.9 * 0.9 - 0.8 * 0.8) * 0.05;
  CHECK(volume(risen) - volume(liquid) == Approx(ring + in_wall).epsilon(5e-3));
  // Curved walls, a stem and a lip.
  const Lathe glass = spline({{{0, 0}},
                              {{0, 0}},
                              {{0.4, 0}},
                              {{0.4, 0}},
                              {{0.06, 0.1}},
                              {{0.06, 0.1}},
                              {{0.04, 0.8}},
                              {{0.3, 1.02}},
                              {{0.45, 1.3}},
                              {{0.35, 1.9}},
                              {{0.33, 1.9}},
                              {{0.42, 1.3}},
                              {{0.28, 1.06}},
                              {{0, 0.95}}});
  CHECK(closed(make_lathe(glass)));
  CHECK(closed(make_lathe_liquid(glass, 1.4, 0.02)));
}

TEST_CASE("an exact lathe has the profile of its mesh, and so has the liquid in it") {
  const Lathe glass = spline({{{0, 0}},
                              {{0, 0}},
                              {{0.4, 0}},
                              {{0.4, 0}},
                              {{0.06, 0.1}},
                              {{0.3, 1.02}},
                              {{0.45, 1.3}},
                              {{0.35, 1.9}},
                              {{0.33, 1.9}},
                              {{0.42, 1.3}},
                              {{0, 0.95}}});
  Lathe rounded = beaker();
  rounded.profile[2].rounding = rounded.profile[3].rounding = 0.05;
  std::ranges::reverse(rounded.profile);
  const auto check = [](const Mesh& mesh, const ExactLathe& exact) {
    CHECK(exact.shape.closed);
    sundog::Object object;
    object.shape = exact.shape;
    const sundog::UnitShape unit = sundog::unit_shape("", object);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 37) {
      const dvec3 p = dvec3(mesh.positions[i]) - dvec3(0, exact.middle, 0), n = 1e-3 * dvec3(mesh.normals[i]);
      CHECK(std::abs(sundog::unit_distance(unit, p / unit.scale)) < 1e-6);
      CHECK(sundog::unit_distance(unit, (p - n) / unit.scale) <
            sundog::unit_distance(unit, (p + n) / unit.scale));
    }
  };
  check(make_lathe(glass), exact_lathe(glass));
  check(make_lathe(rounded), exact_lathe(rounded));
  check(make_lathe_liquid(glass, 1.4, 0.02), exact_lathe_liquid(glass, 1.4, 0.02));
  CHECK_FALSE(exact_lathe(lines({{{1, 0}}, {{1, 2}}})).shape.closed);
}

TEST_CASE("profiles that make no solid are refused with their place") {
  CHECK_THAT(refusal(lines({{{1, 1}}, {{1, 1}}})), ContainsSubstring("two different points"));
  CHECK_THAT(refusal(lines({{{0, 0}}, {{-1, 1}}, {{0, 2}}})),
             ContainsSubstring("crosses the axis near a height of"));
  CHECK_THAT(refusal(lines({{{0, 0}}, {{2, 0}}, {{2, 2}}, {{1, -1}}, {{0, 3}}})),
             ContainsSubstring("crosses itself after ["));
  CHECK_THAT(refusal(lines({{{0, 0}}, {{1, 0}, 0.7}, {{1, 1}, 0.7}, {{0, 1}}})),
             ContainsSubstring("roundings at both ends of the line from [1, 0] to [1, 1] take 1.4 of its 1"));
  CHECK_THAT(refusal(spline({{{0, 0}}, {{1, 0}, 0.1}, {{0, 1}}})),
             ContainsSubstring("[1, 0] has a rounding"));
  CHECK_THAT(refused_liquid(lines({{{0, 0}}, {{1, 0}}, {{1, 2}}, {{0, 2}}}), 1),
             ContainsSubstring("no vessel"));
  CHECK_THAT(refused_liquid(lines({{{1, 0}}, {{1, 2}}}), 1), ContainsSubstring("no vessel"));
  for (const double level : {0.1, 0.2, 2.0, 3.0})
    CHECK_THAT(refused_liquid(beaker(), level), ContainsSubstring("vessel's floor, 0.2, and its rim, 2"));
  CHECK_THAT(refused_liquid(beaker(), 1.96, 0.05), ContainsSubstring("its rim, 2"));
  std::vector<ProfilePoint> waves{{{0, 0}}};
  for (int i = 1; i < 900; ++i) waves.push_back({{1 + i % 2, 0.01 * i}});
  Lathe fine = spline(waves);
  fine.segments = 2048;
  CHECK_THAT(refusal(fine), ContainsSubstring("steps, and may take 16384"));
  CHECK_THAT(refusal(lines({{{0, 0}}, {{1, 0}, 0.4}, {{1, 1}, 0.4}, {{0, 1}}}, 4096)),
             ContainsSubstring("facets, and may take"));
}
