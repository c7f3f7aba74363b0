// Joins boxes at many times of the shutter, widened by the paths' greatest deviation from their chords, which
// follows from a bound of the acceleration.
#include "compile/placing/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "base/error.h"
#include "scene/pack.h"

namespace sundog {
namespace {

using glm::dmat3;

double farthest(const dvec3& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

/// The cross product with the axis, in the world. If `frame` is not a rotation, neither is the turn.
dmat3 spin_of(const TurnDescription& turn) {
  const dvec3 a = glm::normalize(turn.axis);
  const dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
  return turn.frame * cross * glm::inverse(turn.frame);
}

/// The largest stretch of vectors by a turn: 1 for a rotation in the world.
double stretch_of(const TurnDescription& turn) {
  const dmat3 square = glm::transpose(turn.frame) * turn.frame;
  const double even = (square[0][0] + square[1][1] + square[2][2]) / 3;
  const auto size = [](const dmat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  };
  if (size(square - dmat3(even)) < 1e-9 * even) return 1 + 1e-6;
  return size(turn.frame) * size(glm::inverse(turn.frame));
}

dmat4 turned_at(const TurnDescription& turn, double time) {
  const double angle = time * glm::radians(turn.degrees);
  const dmat3 spin = spin_of(turn);
  const dmat3 linear = (1 + time * (turn.growth - 1)) *
                       (dmat3(1) + std::sin(angle) * spin + (1 - std::cos(angle)) * (spin * spin));
  dmat4 result(linear);
  result[3] = glm::dvec4(turn.about - linear * turn.about, 1);
  return result;
}

/// Upper bounds of a point's distance from one place, its speed and acceleration, per shutter interval.
struct Way {
  double distance = 0, speed = 0, acceleration = 0;
};

/// Composes the motion of a point with a turn, which also moves it. Distances are from the turn's point.
Way turned(const Way& from, const TurnDescription& turn) {
  const double rate = std::abs(glm::radians(turn.degrees)), stretch = stretch_of(turn);
  const double size = stretch * std::max(1.0, turn.growth), growing = stretch * std::abs(turn.growth - 1);
  return {size * from.distance, (growing + size * rate) * from.distance + size * from.speed,
          (size * rate * rate + 2 * growing * rate) * from.distance +
              2 * (growing + size * rate) * from.speed + size * from.acceleration};
}

/// The largest acceleration of the object's points; `box` contains it when the shutter opens.
double greatest_acceleration(const Object& object, const Bounds& box, const dvec3& origin) {
  const float4 ball = sphere_around(box);
  dvec3 middle = origin + dvec3(ball.x, ball.y, ball.z);
  Way way{double(ball.w), 0, 0};
  for (auto turn = object.turns.rbegin(); turn != object.turns.rend(); ++turn) {
    way.distance += glm::distance(middle, turn->about) + glm::length(turn->moves_by);
    way.speed += glm::length(turn->moves_by);
    way = turned(way, *turn);
    middle = turn->about;
  }
  return way.acceleration;
}

void widen(double by, Bounds& box) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::nextafter(static_cast<float>(double(box.lower[axis]) - by),
                                     -std::numeric_limits<float>::infinity());
    box.upper[axis] = std::nextafter(static_cast<float>(double(box.upper[axis]) + by),
                                     std::numeric_limits<float>::infinity());
  }
}

/// The largest coordinate that limits the precision of the object's turns.
double greatest_pivot(const Object& object, const dvec3& origin) {
  double most = 0;
  for (const TurnDescription& turn : object.turns)
    most = std::max(most, farthest(turn.about - origin) + farthest(turn.moves_by));
  return most;
}

Turn pack_turn(const TurnDescription& turn, const dvec3& origin) {
  const dmat3 rows = glm::transpose(spin_of(turn));
  const dvec3 about = turn.about - origin;
  Turn packed{};
  for (int axis = 0; axis < 3; ++axis) packed.spin[axis] = pack(rows[axis], about[axis]);
  packed.turn = {static_cast<float>(turn.degrees / 360), static_cast<float>(turn.growth - 1), 0, 0};
  packed.moves = pack(turn.moves_by);
  return packed;
}

bool holds(const float4& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z) && std::isfinite(a.w);
}

}  // namespace

dmat4 world_at(const Object& object, double time) {
  dmat4 result = glm::translate(dmat4(1), time * object.moves_by);
  for (const TurnDescription& turn : object.turns)
    result = result * turned_at(turn, time) * glm::translate(dmat4(1), time * turn.moves_by);
  return result;
}

Bounds moving_bounds(const Object& object, const UnitShape& unit, std::span<const Bounds> boxes,
                     const dmat4& world_from_unit, const dvec3& origin) {
  const dmat4 from_local = glm::translate(dmat4(1), origin), to_local = glm::translate(dmat4(1), -origin);
  const auto at = [&](double time) {
    return world_bounds(unit, boxes, to_local * world_at(object, time) * from_local * world_from_unit, false);
  };
  Bounds box = at(0);
  if (object.turns.empty()) {
    box.extend(at(1));
    return box;
  }
  // Between two times: the hull of both boxes, widened by the deviation of paths from their chords, h^2 / 8
  // times the acceleration. One piece per 1/400 of the size, up to a limit.
  const double bend = greatest_acceleration(object, box, origin) / 8;
  const double least = std::max(double(sphere_around(box).w) / 400, std::numeric_limits<double>::min());
  const int pieces = static_cast<int>(std::clamp(std::ceil(std::sqrt(bend / least)), 1.0, 4096.0));
  for (int i = 1; i <= pieces; ++i) box.extend(at(double(i) / pieces));
  widen(bend / pieces / pieces + 0x1p-20 * greatest_pivot(object, origin), box);
  return box;
}

float4 add_motion(const std::string& file, const Object& object, const dvec3& origin,
                  std::vector<Turn>& turns) {
  const auto fail = [&](std::string_view key, std::string_view wanted) {
    throw SceneError(file, object.place + std::string(key), std::string(wanted));
  };
  float4 moves = pack(object.moves_by);
  if (!holds(moves)) fail("/moves_by", "wanted a move that single precision holds");
  if (object.turns.empty()) return moves;
  if (turns.size() + object.turns.size() >= std::size_t{1} << 24)
    fail("", "wanted at most 16 million turns in a scene");
  moves.w = static_cast<float>(turns.size() + 1);
  const std::size_t first = turns.size();
  for (const TurnDescription& turn : object.turns) {
    turns.push_back(pack_turn(turn, origin));
    const Turn& packed = turns.back();
    if (!holds(packed.spin[0]) || !holds(packed.spin[1]) || !holds(packed.spin[2]) || !holds(packed.moves))
      fail("/turns_by", "wanted a turn that single precision holds");
  }
  turns[first].turn.z = static_cast<float>(object.turns.size() - 1);
  turns[first].turn.w = static_cast<float>(greatest_pivot(object, origin));
  return moves;
}

}  // namespace sundog
