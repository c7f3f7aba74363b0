// Reads an object's own motion and appends it to its groups' motion.
#include "scene/read/motion.h"

namespace sundog {
namespace {

/// Returns whether the scene gives the turn's centre.
bool read_turn(const JsonValue& value, const dmat4& world_from_parent, TurnDescription& turn) {
  return value.object("turns_by", [&](JsonObject& object) {
    turn.axis = object.at("axis").direction();
    object.read("degrees", turn.degrees);
    const auto about = object.find("about");
    if (about) turn.about = dvec3(world_from_parent * glm::dvec4(about->vec3(), 1));
    return about.has_value();
  });
}

}  // namespace

void read_motion(JsonObject& object, const dmat4& world_from_parent, Placement& placement) {
  if (const auto moves = object.find("moves_by")) {
    const dvec3 way = glm::dmat3(world_from_parent) * moves->vec3();
    (placement.turns.empty() ? placement.moves_by : placement.turns.back().moves_by) += way;
  }
  TurnDescription turn;
  turn.frame = glm::dmat3(world_from_parent);
  turn.about = dvec3(placement.world_from_object[3]);
  bool placed = false;
  if (const auto turns = object.find("turns_by")) placed = read_turn(*turns, world_from_parent, turn);
  object.read("grows_to", turn.growth);
  placement.turns_about_middle = false;
  if (turn.degrees == 0 && turn.growth == 1) return;
  placement.turns_about_middle = !placed;
  placement.turns.push_back(turn);
}

void turn_about_middle(const dmat4& world_from_object, Placement& placement) {
  if (placement.turns_about_middle) placement.turns.back().about = dvec3(world_from_object[3]);
}

}  // namespace sundog
