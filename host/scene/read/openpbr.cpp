// Reads materials of the type "openpbr" (OpenPBR 1.1).
#include <nlohmann/json.hpp>

#include "scene/json/members.h"
#include "scene/read/surface_terms.h"
#include "scene/read/textures.h"

namespace sundog {
namespace {

/// Reads a colour, or a texture's name, which sets the colour to white times the texture.
void read_color(JsonObject& object, std::string_view key, dvec3& to, int& texture, TextureLibrary& textures) {
  const auto color = object.find(key);
  if (!color) return;
  const Pattern pattern = read_plain_color(*color, textures);
  to = pattern.even, texture = pattern.texture;
}

void read_textured(JsonObject& object, OpenPbr& to, MaterialTextures& maps, TextureLibrary& textures) {
  read_color(object, "base_color", to.base_color, maps.diffuse, textures);
  maps.ambient = maps.diffuse;
  read_number(object, "base_metalness", to.base_metalness, maps.metalness, textures);
  read_number(object, "specular_roughness", to.specular_roughness, maps.roughness, textures);
  read_number(object, "transmission_weight", to.transmission_weight, maps.glass, textures);
  read_number(object, "coat_weight", to.coat_weight, maps.coat, textures);
  read_color(object, "emission_color", to.emission_color, maps.emission, textures);
  read_number(object, "geometry_opacity", to.geometry_opacity, maps.opacity, textures);
  const bool partly = to.geometry_opacity < 1 || maps.opacity >= 0,
             dielectric = to.base_metalness < 1 || maps.metalness >= 0;
  if (partly && to.transmission_weight > 0 && dielectric)
    object.at("geometry_opacity").fail("a material with a \"transmission_weight\" is not partly there");
}

}  // namespace

MaterialDescription read_openpbr(const JsonValue& value, std::string name,
                                 std::vector<MediumDescription>& media, TextureLibrary& textures) {
  return value.object("openpbr_material", [&](JsonObject& object) {
    MaterialDescription material;
    material.name = std::move(name);
    OpenPbr values;
    read_members(object, values,
                 {"base_color", "base_metalness", "specular_roughness", "transmission_weight", "coat_weight",
                  "emission_color", "geometry_opacity"});
    read_textured(object, values, material.textures, textures);
    MediumDescription inside;
    if (set_openpbr(values, material, inside)) {
      material.medium = static_cast<int>(media.size());
      media.push_back(inside);
    }
    read_surface(object, material, textures);
    return material;
  });
}

}  // namespace sundog
