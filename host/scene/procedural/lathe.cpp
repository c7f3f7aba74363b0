// Follows the profile in steps for meshes and in cubics for exact lathes. A liquid's profile runs within the
// wall, nearer to its inside where the wall bends.
#include "scene/procedural/lathe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/procedural/ice_block.h"

namespace sundog {

namespace {

using glm::dvec2;
using procedural::Profile;
using procedural::ProfileStep;

bool is_closed(const Profile& profile) {
  const dvec2 first = profile.front().a, last = profile.back().b;
  return (first.x == 0 && last.x == 0) || first == last;
}

/// The profile's steps may turn by twice the angle of the segments around the axis.
struct DirectedProfile {
  Profile steps;
  bool reversed = false;  // so that the solid is on its left
};
DirectedProfile profile_of(const Lathe& lathe) {
  Profile profile = procedural::follow(lathe.profile, lathe.curve,
                                       procedural::turn_by(2.0 / std::max(lathe.segments, 16)).x);
  for (const ProfileStep& step : profile)
    if (step.a.x < 0 || step.b.x < 0)
      throw GenerateError(fmt::format("the profile crosses the axis near a height of {:.4g}", step.a.y));
  procedural::check_crossings(profile);
  if (is_closed(profile) && procedural::area_of(profile) < 0) return {procedural::reversed(profile), true};
  return {std::move(profile)};
}

constexpr std::size_t most_facets = 4'000'000;

class LatheMesh {
 public:
  explicit LatheMesh(int segments) : segments_(static_cast<unsigned>(segments)) {
    for (unsigned k = 0; k < segments_; ++k) circle_.push_back(procedural::turn_by(double(k) / segments_));
    circle_.push_back(circle_.front());
  }

  Mesh turn(const Profile& profile) {
    const std::size_t facets = profile.size() * segments_;
    if (facets > most_facets)
      throw GenerateError(fmt::format("the lathe takes {} facets, and may take {}; wanted fewer \"segments\"",
                                      facets, most_facets));
    double whole = 0, way = 0;
    for (const ProfileStep& step : profile) whole += glm::length(step.b - step.a);
    unsigned end = 0;
    for (std::size_t i = 0; i < profile.size(); ++i) {
      const ProfileStep& step = profile[i];
      const bool smooth = i > 0 && glm::dot(profile[i - 1].normal_b, step.normal_a) > 1 - 1e-9;
      const unsigned start = smooth ? end : add_ring(step.a, step.normal_a, way / whole);
      way += glm::length(step.b - step.a);
      end = add_ring(step.b, step.normal_b, way / whole);
      join(start, step.a.x == 0, end, step.b.x == 0);
    }
    Mesh mesh;
    mesh.positions = std::move(positions_);
    mesh.normals = std::move(normals_);
    mesh.uvs = std::move(uvs_);
    mesh.triangles = std::move(triangles_);
    return mesh;
  }

 private:
  unsigned add_ring(const dvec2& p, const dvec2& normal, double v) {
    const auto first = static_cast<unsigned>(positions_.size());
    for (unsigned k = 0; k <= segments_; ++k) {
      const dvec2 c = circle_[k];
      positions_.emplace_back(p.x * c.x, p.y, -p.x * c.y);
      normals_.emplace_back(normal.x * c.x, normal.y, -normal.x * c.y);
      uvs_.emplace_back(double(k) / segments_, v);
    }
    return first;
  }
  void join(unsigned a, bool a_on_axis, unsigned b, bool b_on_axis) {
    for (unsigned k = 0; k < segments_; ++k) {
      if (!a_on_axis) triangles_.emplace_back(a + k, a + k + 1, b + k + 1);
      if (!b_on_axis) triangles_.emplace_back(a + k, b + k + 1, b + k);
    }
  }

  unsigned segments_;
  std::vector<dvec2> circle_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::vector<glm::uvec3> triangles_;
};

double distance_to(const ProfileStep& step, const dvec2& p) {
  const dvec2 along = step.b - step.a;
  const double share = std::clamp(glm::dot(p - step.a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(p - step.a - share * along);
}

/// The point where a line that begins below a height reaches it.
dvec2 at_height(const dvec2& low, const dvec2& high, double height) {
  return {low.x + (high.x - low.x) * ((height - low.y) / (high.y - low.y)), height};
}

/// A vessel's inside from its floor on the axis to its rim; `outside`: the rest of the profile.
struct Vessel {
  std::vector<ProfileStep> inside, outside;
};
Vessel vessel_of(const Profile& profile) {
  const char* wanted =
      "the profile is no vessel: it must go from the axis around the rim and back to the axis";
  if (profile.front().a.x != 0 || profile.back().b.x != 0) throw GenerateError(wanted);
  const auto rim = std::ranges::max_element(profile, {}, [](const ProfileStep& step) { return step.b.y; });
  if (profile.back().b.y >= rim->b.y) throw GenerateError(wanted);
  return {procedural::reversed(Profile(rim + 1, profile.end())), Profile(profile.begin(), rim + 1)};
}

/// The part of a vessel's inside below a height.
Profile below(const Profile& inside, double height) {
  Profile wall;
  for (const ProfileStep& step : inside) {
    wall.push_back(step);
    if (step.b.y < height) continue;
    wall.back().b = at_height(step.a, step.b, height);
    break;
  }
  return wall;
}

/// Continues a curve in a straight line to a point.
void go_to(const dvec2& p, Profile& to) {
  const dvec2 at = to.back().b;
  if (p == at) return;
  const dvec2 along = p - at, normal = glm::normalize(dvec2(along.y, -along.x));
  to.push_back({at, p, normal, normal});
}

/// The wall from the axis up to `top`, moved by `depth` into the glass on its right.
Profile moved_right(const Profile& wall, double depth, double top) {
  const dvec2 start{0, wall.front().a.y - depth};
  Profile body{{start, start, {0, -1}, {0, -1}}};
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const dvec2 normal = wall[i].normal_b, next = i + 1 < wall.size() ? wall[i + 1].normal_a : normal;
    const double miter = 1 + glm::dot(normal, next);  // the lines beside a corner meet behind it
    std::vector<dvec2> moved{wall[i].b + normal * depth};
    if (miter > 0.5)
      moved.front() = wall[i].b + (normal + next) * (depth / miter);
    else
      moved.push_back(wall[i].b + next * depth);
    for (const dvec2& p : moved) {
      if (p.x <= 0) continue;
      go_to(p.y < top ? p : at_height(body.back().b, p, top), body);
      if (p.y >= top) break;
    }
    if (body.back().b.y >= top) break;
  }
  if (body.back().b.y < top) go_to({body.back().b.x, top}, body);
  body.erase(body.begin());
  return body;
}

double meniscus_width(double radius, double meniscus) { return std::min(radius, 3 * meniscus); }

/// Adds the liquid's top from within the wall to the axis. The meniscus is a cubic with slope 1 at the wall
/// (more in a narrow vessel) and 0 where it ends.
void add_surface(double radius, double level, double meniscus, Profile& body) {
  constexpr int steps = 24;
  const double width = meniscus_width(radius, meniscus);
  if (meniscus > 0) go_to({radius, level + meniscus}, body);
  for (int i = 0; meniscus > 0 && i < steps; ++i) {
    const double from = 1 - double(i) / steps, till = 1 - double(i + 1) / steps;
    const auto normal = [&](double left) {
      return glm::normalize(dvec2(-3 * meniscus * left * left, width));
    };
    const dvec2 end(radius - width * (1 - till), level + meniscus * till * till * till);
    body.push_back({body.back().b, end, normal(from), normal(till)});
  }
  go_to({0, level}, body);
}

/// A liquid's profile: `wall` follows the wall up to the liquid's top; `body` also includes the top.
struct LiquidProfile {
  Profile wall, body;
  double radius;  // radius of the vessel's inside at the liquid's top
};
LiquidProfile liquid_profile(const Lathe& lathe, double level, double meniscus) {
  const auto [inside, outside] = vessel_of(profile_of(lathe).steps);
  const double top = level + meniscus, floor = inside.front().a.y, rim = inside.back().b.y;
  if (!(level > floor && top < rim))
    throw GenerateError(fmt::format(
        "the liquid would stand from {:.6g} to {:.6g}; wanted it between the vessel's floor, {:.6g}, and its "
        "rim, {:.6g}",
        level, top, floor, rim));
  const Profile wall = below(inside, top);
  const double radius = wall.back().b.x;
  double thickness = INFINITY;
  for (const ProfileStep& step : wall)
    for (const ProfileStep& other : outside) thickness = std::min(thickness, distance_to(other, step.b));
  // Where the wall bends sharply, the liquid must extend less far into it.
  for (double depth = thickness / 2;; depth /= 2) {
    LiquidProfile made{moved_right(wall, depth, top), {}, radius};
    made.body = made.wall;
    add_surface(radius, level, meniscus, made.body);
    if (depth < thickness / 64) procedural::check_crossings(made.body);
    if (!procedural::crossing_of(made.body)) return made;
  }
}

ProfileCubic straight(const dvec2& a, const dvec2& b) { return {a, a + (b - a) / 3.0, b - (b - a) / 3.0, b}; }

/// Shifts the profile so that its middle height is 0.
ExactLathe centred(std::vector<ProfileCubic> profile, bool closed) {
  double low = INFINITY, high = -INFINITY, radius = 0;
  for (const ProfileCubic& cubic : profile)
    for (const ProfileCubic& part : monotone_parts(cubic))
      for (const dvec2& end : {part.a, part.d}) {
        low = std::min(low, end.y);
        high = std::max(high, end.y);
        radius = std::max(radius, end.x);
      }
  const double middle = (low + high) / 2;
  for (ProfileCubic& cubic : profile)
    for (dvec2* point : {&cubic.a, &cubic.b, &cubic.c, &cubic.d}) point->y -= middle;
  return {{std::move(profile), closed, radius, (high - low) / 2}, middle};
}

}  // namespace

Mesh make_lathe(const Lathe& lathe) { return LatheMesh(lathe.segments).turn(profile_of(lathe).steps); }

ExactLathe exact_lathe(const Lathe& lathe) {
  const DirectedProfile known = profile_of(lathe);
  std::vector<ProfileCubic> profile = procedural::follow_exactly(lathe.profile, lathe.curve);
  if (known.reversed) {
    std::ranges::reverse(profile);
    for (ProfileCubic& cubic : profile) cubic = cubic.reversed();
  }
  return centred(std::move(profile), is_closed(known.steps));
}

Mesh make_lathe_liquid(const Lathe& lathe, double level, double meniscus) {
  return LatheMesh(lathe.segments).turn(liquid_profile(lathe, level, meniscus).body);
}

ExactLathe exact_lathe_liquid(const Lathe& lathe, double level, double meniscus) {
  const LiquidProfile liquid = liquid_profile(lathe, level, meniscus);
  std::vector<ProfileCubic> profile;
  for (const ProfileStep& step : liquid.wall) profile.push_back(straight(step.a, step.b));
  const auto go_to = [&](const dvec2& p) {
    if (profile.back().d != p) profile.push_back(straight(profile.back().d, p));
  };
  if (meniscus > 0) {
    const double r = liquid.radius, width = meniscus_width(r, meniscus);
    go_to({r, level + meniscus});
    profile.push_back(
        {{r, level + meniscus}, {r - width / 3, level}, {r - 2 * width / 3, level}, {r - width, level}});
  }
  go_to({0, level});
  return centred(std::move(profile), true);
}

}  // namespace sundog
