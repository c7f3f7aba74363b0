// Reads the lights: their kinds, colours and powers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/json/members.h"
#include "scene/kinds.h"
#include "scene/lamps.h"
#include "scene/light_groups.h"
#include "scene/read/parts.h"
#include "scene/spectra/cie.h"

namespace sundog {
namespace {

dvec3 read_falloff(JsonObject& object) {
  dvec3 falloff(0);
  object.read("constant", falloff.x, "linear", falloff.y, "quadratic", falloff.z);
  return falloff;
}

/// Reads the direction of emission, given directly or by a target point.
void read_aim(JsonObject& object, LightDescription& light) {
  if (!object.knows("target") || object.one_of() == "direction") {
    light.direction = object.at("direction").direction();
    return;
  }
  const JsonValue target = object.at("target");
  light.direction = target.vec3() - light.position;
  if (!(glm::length(light.direction) > 1e-12)) target.fail("wanted a point away from the light's position");
  light.direction = glm::normalize(light.direction);
}

void read_spot(JsonObject& object, LightDescription& light) {
  if (!object.has("inner_angle")) light.inner_angle = light.outer_angle * 2 / 3;
  if (light.inner_angle > light.outer_angle)
    object.value().fail(fmt::format("wanted an \"inner_angle\" not above the \"outer_angle\" of {}, found {}",
                                    light.outer_angle, light.inner_angle));
}

/// Computes the intensity from the power of the whole light. Uses the colour's luminance, so that a colour
/// only tints it.
void read_power(JsonObject& object, double unit, LightDescription& light) {
  constexpr double lumens_a_watt = 179;  // for white light, as in Radiance (Ward 1994)
  const auto watts = object.find("watts"), lumens = object.find("lumens");
  if (!watts && !lumens) return;
  const double luminance = glm::dot(light.color, dvec3(0.2126, 0.7152, 0.0722));
  if (!(luminance > 0)) object.value().fail("wanted a \"color\" that is not black with a power");
  const double power = watts ? watts->number() : lumens->number() / lumens_a_watt;
  light.intensity = power / (power_of_intensity(light) * unit * unit * luminance);
  light.falloff = {0, 0, 1};
}

}  // namespace

LightDescription read_light(const JsonValue& value, double unit) {
  const std::string type = value.type();
  return value.object("light", [&](JsonObject& object) {
    LightDescription light;
    light.type = std::ranges::find(light_types, type, &LightTypeFacts::name)->value;
    object.check("name");  // used only by pointers
    read_members(object, light, {"type", "direction", "up", "falloff"});
    if (const auto kelvin = object.find("temperature")) light.color *= black_body_color(kelvin->number());
    if (object.knows("falloff"))
      if (const auto falloff = object.find("falloff"))
        light.falloff = falloff->object("falloff", read_falloff);
    if (object.knows("up"))
      if (const auto up = object.find("up")) light.up = up->direction();
    if (facts_of(light.type).aimed) read_aim(object, light);
    if (light.type == LightType::spot) read_spot(object, light);
    if (object.knows("watts")) read_power(object, unit, light);
    return light;
  });
}

void check_light_groups(const SceneDescription& scene, const JsonValue& root) {
  if (const auto groups = light_groups(scene); groups.size() > most_light_groups)
    root.fail(fmt::format("wanted at most {} groups of lights, found {}: {}", most_light_groups,
                          groups.size(), fmt::join(groups, ", ")));
}

}  // namespace sundog
