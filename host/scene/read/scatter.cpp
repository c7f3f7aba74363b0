// Reads the keys with their defaults, and copies objects with a transform.
#include "scene/read/scatter.h"

#include "scene/json/members.h"

namespace sundog {

ScatterKeys read_scatter_keys(JsonObject& object) {
  ScatterKeys keys;
  Scatter& how = keys.how;
  read_members(object, how);
  object.read("limit", keys.limit);
  if (how.scale.x > how.scale.y) object.at("scale").wanted("the least size before the greatest");
  return keys;
}

void add_copies(std::span<const Object> objects, const dmat4& place, const JsonValue& value,
                SceneDescription& scene) {
  const glm::dmat3 linear(place);
  for (Object copy : objects) {
    copy.world_from_object = place * copy.world_from_object;
    check_transform(copy.world_from_object, value);
    copy.moves_by = linear * copy.moves_by;
    for (TurnDescription& turn : copy.turns) {
      turn.frame = linear * turn.frame;
      turn.about = dvec3(place * glm::dvec4(turn.about, 1));
      turn.moves_by = linear * turn.moves_by;
    }
    scene.objects.push_back(std::move(copy));
  }
}

}  // namespace sundog
