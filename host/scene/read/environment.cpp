// Reads the environment: a picture, or a sky with its sun and its halo.
#include "scene/json/members.h"
#include "scene/kinds.h"
#include "scene/read/parts.h"

namespace sundog {
namespace {

void read_sun(JsonObject& object, EnvironmentDescription& e) {
  object.read("altitude", e.sun_altitude, "azimuth", e.sun_azimuth, "size", e.sun_size);
}

void read_crystals(JsonObject& object, HaloCrystals& crystals) {
  object.read("shape", crystals.shape, halo_shapes);
  read_members(object, crystals, {"shape"});
}

void read_halo(JsonObject& object, HaloDescription& halo) {
  const JsonValue kinds = object.at("crystals");
  double shares = 0;
  for (const JsonValue& kind : kinds.items("kinds of crystals")) {
    kind.object("crystals", [&](JsonObject& inner) { read_crystals(inner, halo.crystals.emplace_back()); });
    shares += halo.crystals.back().share;
  }
  if (!(shares > 0)) kinds.fail("wanted kinds of crystals of a share above 0 in all");
  read_members(object, halo);
}

}  // namespace

EnvironmentDescription read_environment(const JsonValue& value,
                                        const std::function<Image(const JsonValue&)>& read_picture) {
  const std::string type = value.type();
  return value.object("environment", [&](JsonObject& object) {
    EnvironmentDescription e;
    e.type = enumerator_named<EnvironmentType>(type);
    read_members(object, e, {"type", "up"});
    if (const auto up = object.find("up")) e.up = up->direction();
    if (e.type == EnvironmentType::image) {
      e.picture = read_picture(object.at("file"));
    } else if (e.type != EnvironmentType::gradient) {
      if (e.type == EnvironmentType::halo) read_halo(object, e.halo);
      if (const auto sun = object.find("sun"))
        sun->object(e.type == EnvironmentType::halo ? "halo_sun" : "sun",
                    [&](JsonObject& inner) { read_sun(inner, e); });
    }
    return e;
  });
}

}  // namespace sundog
