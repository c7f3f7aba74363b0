// Fits arcs or splines to the points, and draws them with one of two pens: as short steps or as cubics.
#include "scene/procedural/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/procedural/ice_block.h"

namespace sundog::procedural {

namespace {

using glm::dot;
using glm::dvec2;
using glm::length;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }
dvec2 right_of(const dvec2& direction) { return glm::normalize(dvec2(direction.y, -direction.x)); }
std::string shown(const dvec2& p) { return fmt::format("[{:.6g}, {:.6g}]", p.x, p.y); }

/// A cubic between two points, given by its ends and their tangents (Hermite).
struct Cubic {
  dvec2 p, q, u, v;
  dvec2 at(double t) const {
    const double s = 1 - t;
    return p * (s * s * (1 + 2 * t)) + u * (s * s * t) + q * (t * t * (1 + 2 * s)) - v * (t * t * s);
  }
  /// The normal to the right of the curve's direction; at a cusp, to the right of the chord.
  dvec2 normal(double t) const {
    const double s = 1 - t;
    const dvec2 slope = (q - p) * (6 * t * s) + u * (s * (1 - 3 * t)) + v * (t * (3 * t - 2));
    return right_of(length(slope) > 1e-9 * length(q - p) ? slope : q - p);
  }
};

/// Draws the parts of a curve.
class Pen {
 public:
  virtual ~Pen() = default;
  virtual void line(const dvec2& a, const dvec2& b) = 0;
  /// Draws the arc about `center` between two unit normals; `radius` is negative if they point to the centre.
  virtual void arc(const dvec2& center, double radius, const dvec2& from, const dvec2& till) = 0;
  virtual void cubic(const Cubic& cubic) = 0;
};

/// Halves the arc until each part turns little enough.
void add_arc(const dvec2& center, double radius, const dvec2& from, const dvec2& till, double cos_turn,
             Profile& to) {
  if (dot(from, till) >= cos_turn) {
    to.push_back({center + radius * from, center + radius * till, from, till});
    return;
  }
  const dvec2 middle = glm::normalize(from + till);
  add_arc(center, radius, from, middle, cos_turn, to);
  add_arc(center, radius, middle, till, cos_turn, to);
}

struct Corner {
  double cut = 0;     // length cut off the lines on both sides
  double radius = 0;  // radius of the arc; 0: sharp
};

Corner corner_at(const ProfilePoint& point, const dvec2& before, const dvec2& after) {
  Corner corner;
  const double turn = cross(before, after), half = std::abs(turn) / (1 + dot(before, after));
  if (point.rounding <= 0 || !(half > 1e-6)) return corner;
  corner.radius = point.rounding;
  corner.cut = point.rounding * half;
  return corner;
}

void follow_lines(std::span<const ProfilePoint> points, Pen& pen) {
  const bool closed = points.front().at == points.back().at;
  const std::size_t last = points.size() - 1;
  std::vector<dvec2> directions;
  for (std::size_t i = 0; i < last; ++i)
    directions.push_back(glm::normalize(points[i + 1].at - points[i].at));
  std::vector<Corner> corners(points.size());
  for (std::size_t i = 0; i <= last; ++i) {
    const bool end = i == 0 || i == last;
    if (end && !closed) continue;
    corners[i] = corner_at(points[i], directions[end ? last - 1 : i - 1], directions[end ? 0 : i]);
  }
  for (std::size_t i = 0; i < last; ++i) {
    const double room = length(points[i + 1].at - points[i].at), wanted = corners[i].cut + corners[i + 1].cut;
    if (wanted > room * (1 + 1e-9))
      throw GenerateError(
          fmt::format("the roundings at both ends of the line from {} to {} take {:.4g} of "
                      "its {:.4g}; wanted smaller ones",
                      shown(points[i].at), shown(points[i + 1].at), wanted, room));
    const dvec2 d = directions[i];
    if (room - wanted > 1e-9 * room)
      pen.line(points[i].at + d * corners[i].cut, points[i + 1].at - d * corners[i + 1].cut);
    const Corner& corner = corners[i + 1];
    if (corner.radius == 0) continue;
    const dvec2 next = directions[i + 1 == last ? 0 : i + 1];
    const double radius = cross(d, next) > 0 ? corner.radius : -corner.radius;
    const dvec2 from = right_of(d);
    pen.arc(points[i + 1].at - d * corner.cut - radius * from, radius, from, right_of(next));
  }
}

void add_cubic(const Cubic& cubic, double from, double till, int depth, double cos_turn, Profile& to) {
  const double middle = (from + till) / 2;
  const dvec2 a = cubic.normal(from), b = cubic.normal(till), m = cubic.normal(middle);
  if (depth > 0 && (depth >= 10 || std::min({dot(a, b), dot(a, m), dot(m, b)}) >= cos_turn)) {
    to.push_back({from > 0 ? to.back().b : cubic.p, till < 1 ? cubic.at(till) : cubic.q, a, b});
    return;
  }
  add_cubic(cubic, from, middle, depth + 1, cos_turn, to);
  add_cubic(cubic, middle, till, depth + 1, cos_turn, to);
}

dvec2 mirrored(const dvec2& p) { return {-p.x, p.y}; }

/// Draws the smooth curve through the points between two corners; `before` and `after` shape its ends.
void follow_run(std::span<const dvec2> run, const dvec2& before, const dvec2& after, Pen& pen) {
  const std::size_t last = run.size() - 1;
  const auto point = [&](std::size_t i) { return i == 0 ? before : i > run.size() ? after : run[i - 1]; };
  const auto knot = [&](std::size_t i) { return std::sqrt(length(point(i + 1) - point(i))); };
  for (std::size_t i = 0; i < last; ++i) {
    const dvec2 a = point(i), p = run[i], q = run[i + 1], z = point(i + 3);
    const double ka = knot(i), k = knot(i + 1), kz = knot(i + 2);
    const dvec2 u = (p - a) * (k / ka) - (q - a) * (k / (ka + k)) + (q - p);
    const dvec2 v = (q - p) - (z - p) * (k / (k + kz)) + (z - q) * (k / kz);
    pen.cubic({p, q, u, v});
  }
}

void follow_spline(std::span<const dvec2> points, Pen& pen) {
  const bool closed = points.front() == points.back();
  std::vector<std::vector<dvec2>> runs(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool twice = i > 0 && points[i] == points[i - 1];
    if (twice && runs.back().size() > 1) runs.push_back({points[i]});
    if (!twice) runs.back().push_back(points[i]);
  }
  if (runs.back().size() < 2) runs.pop_back();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::vector<dvec2>& run = runs[i];
    const dvec2 first = run.front(), second = run[1], end = run.back(), last = run[run.size() - 2];
    const bool whole = closed && runs.size() == 1;
    dvec2 before = 2.0 * first - second, after = 2.0 * end - last;
    if (whole) {
      before = last;
      after = second;
    }
    if (i == 0 && first.x == 0 && second.x != 0 && !whole) before = mirrored(second);
    if (i + 1 == runs.size() && end.x == 0 && last.x != 0 && !whole) after = mirrored(last);
    follow_run(run, before, after, pen);
  }
}

/// Draws a curve in steps that turn by at most an angle.
class StepPen final : public Pen {
 public:
  explicit StepPen(double cos_turn) : cos_turn_(cos_turn) {}
  void line(const dvec2& a, const dvec2& b) override {
    const dvec2 normal = right_of(b - a);
    steps.push_back({a, b, normal, normal});
  }
  void arc(const dvec2& center, double radius, const dvec2& from, const dvec2& till) override {
    add_arc(center, radius, from, till, cos_turn_, steps);
  }
  void cubic(const Cubic& cubic) override { add_cubic(cubic, 0, 1, 0, cos_turn_, steps); }

  Profile steps;

 private:
  double cos_turn_;
};

/// Draws a curve in cubics.
class CubicPen final : public Pen {
 public:
  void line(const dvec2& a, const dvec2& b) override {
    cubics.push_back({a, a + (b - a) / 3.0, b - (b - a) / 3.0, b});
  }
  void arc(const dvec2& center, double radius, const dvec2& from, const dvec2& till) override {
    Profile parts;
    add_arc(center, radius, from, till, std::cos(0.4), parts);
    for (const ProfileStep& part : parts) {
      const dvec2 &m = part.normal_a, &n = part.normal_b;
      const double arm = std::abs(radius) * 4 / 3 * std::tan(std::acos(std::min(dot(m, n), 1.0)) / 4);
      cubics.push_back({part.a, part.a + arm * dvec2(-m.y, m.x), part.b - arm * dvec2(-n.y, n.x), part.b});
    }
  }
  void cubic(const Cubic& c) override { cubics.push_back({c.p, c.p + c.u / 3.0, c.q - c.v / 3.0, c.q}); }

  std::vector<ProfileCubic> cubics;
};

/// Whether two lines cross or touch.
bool meet(const ProfileStep& s, const ProfileStep& t) {
  const auto apart = [](double p, double q) { return (p > 0 && q > 0) || (p < 0 && q < 0); };
  const dvec2 d = s.b - s.a, e = t.b - t.a;
  if (std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) || std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) ||
      std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) || std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y))
    return false;
  return !apart(cross(d, t.a - s.a), cross(d, t.b - s.a)) && !apart(cross(e, s.a - t.a), cross(e, s.b - t.a));
}

void draw(std::span<const ProfilePoint> points, ProfileCurve curve, Pen& pen) {
  const bool spline = curve == ProfileCurve::spline;
  std::vector<ProfilePoint> places;
  for (const ProfilePoint& point : points) {
    if (spline && point.rounding > 0)
      throw GenerateError(fmt::format(
          "the point {} has a rounding, which is for lines; a spline is smooth except at points given twice",
          shown(point.at)));
    if (spline || places.empty() || places.back().at != point.at) places.push_back(point);
  }
  std::vector<dvec2> all;
  for (const ProfilePoint& place : places) all.push_back(place.at);
  if (all.empty() || std::ranges::all_of(all, [&](const dvec2& p) { return p == all.front(); }))
    throw GenerateError("wanted at least two different points");
  if (spline)
    follow_spline(all, pen);
  else
    follow_lines(places, pen);
}

}  // namespace

dvec2 turn_by(double share) {
  // Within an eighth of a turn of the nearest axis, the series lose no digits.
  const double quarters = std::floor(share * 4 + 0.5),
               x = (share - quarters / 4) * 2 * 3.14159265358979323846;
  double sine = 0, cosine = 0, power = 1;
  for (int i = 0; i < 20; ++i) {
    (i % 2 ? sine : cosine) += i % 4 < 2 ? power : -power;
    power *= x / (i + 1);
  }
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

Profile follow(std::span<const ProfilePoint> points, ProfileCurve curve, double cos_turn) {
  StepPen pen(cos_turn);
  draw(points, curve, pen);
  Profile& profile = pen.steps;
  if (curve == ProfileCurve::lines) {
    for (std::size_t i = 1; i < profile.size(); ++i) profile[i].a = profile[i - 1].b;
    profile.back().b = points.front().at == points.back().at ? profile.front().a : points.back().at;
  }
  if (profile.size() > most_steps)
    throw GenerateError(
        fmt::format("the curve takes {} steps, and may take {}; wanted fewer facets or points",
                    profile.size(), most_steps));
  return std::move(profile);
}

std::vector<ProfileCubic> follow_exactly(std::span<const ProfilePoint> points, ProfileCurve curve) {
  CubicPen pen;
  draw(points, curve, pen);
  std::vector<ProfileCubic>& cubics = pen.cubics;
  for (std::size_t i = 1; i < cubics.size(); ++i) cubics[i].a = cubics[i - 1].d;
  cubics.back().d = points.front().at == points.back().at ? cubics.front().a : points.back().at;
  return std::move(cubics);
}

Profile reversed(const Profile& profile) {
  Profile back;
  for (auto step = profile.rbegin(); step != profile.rend(); ++step)
    back.push_back({step->b, step->a, -step->normal_b, -step->normal_a});
  return back;
}

double area_of(const Profile& profile) {
  const dvec2 origin = profile.front().a;
  double sum = 0;
  for (const ProfileStep& step : profile) sum += cross(step.a - origin, step.b - origin) / 2;
  return sum;
}

std::optional<glm::dvec2> crossing_of(const Profile& profile) {
  const bool closed = profile.front().a == profile.back().b;
  for (std::size_t i = 0; i < profile.size(); ++i)
    for (std::size_t k = i + 2; k < profile.size(); ++k)
      if (!(closed && i == 0 && k + 1 == profile.size()) && meet(profile[i], profile[k])) return profile[k].a;
  return std::nullopt;
}

void check_crossings(const Profile& profile) {
  if (const auto place = crossing_of(profile))
    throw GenerateError(fmt::format("the curve crosses itself after {}", shown(*place)));
}

}  // namespace sundog::procedural
