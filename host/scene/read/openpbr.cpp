// Reads materials of the type "openpbr" (OpenPBR 1.1).
#include <nlohmann/json.hpp>

#include "scene/read/surface_terms.h"
#include "scene/read/textures.h"

namespace sundog {
namespace {

constexpr Range weight_range{.low = 0, .high = 10};

void read_base(JsonObject& object, OpenPbr& to, MaterialDescription& material, TextureLibrary& textures) {
  to.base_weight = object.number("base_weight", to.base_weight, zero_to_one);
  if (const auto color = object.find("base_color")) {
    const Pattern base = read_plain_color(*color, textures, zero_to_one);
    to.base_color = base.even;
    material.textures.diffuse = material.textures.ambient = base.texture;
  }
  if (const auto metalness = object.find("base_metalness"))
    to.base_metalness = read_number(*metalness, textures, zero_to_one, &material.textures.metalness);
  to.base_diffuse_roughness = object.number("base_diffuse_roughness", to.base_diffuse_roughness, zero_to_one);
  to.specular_weight = object.number("specular_weight", to.specular_weight, weight_range);
  to.specular_color = object.color("specular_color", to.specular_color, zero_to_one);
  if (const auto roughness = object.find("specular_roughness"))
    to.specular_roughness = read_number(*roughness, textures, zero_to_one, &material.textures.roughness);
  to.specular_roughness_anisotropy =
      object.number("specular_roughness_anisotropy", to.specular_roughness_anisotropy, zero_to_one);
  to.specular_ior = object.number("specular_ior", to.specular_ior, ior_range);
}

void read_transmission(JsonObject& object, OpenPbr& to, MaterialDescription& material,
                       TextureLibrary& textures) {
  if (const auto weight = object.find("transmission_weight"))
    to.transmission_weight = read_number(*weight, textures, zero_to_one, &material.textures.glass);
  to.transmission_color = object.color("transmission_color", to.transmission_color, zero_to_one);
  to.transmission_depth = object.number("transmission_depth", to.transmission_depth, at_least_0);
  to.transmission_scatter = object.color("transmission_scatter", to.transmission_scatter, zero_to_one);
  to.transmission_scatter_anisotropy =
      object.number("transmission_scatter_anisotropy", to.transmission_scatter_anisotropy, mean_cosines);
  to.transmission_dispersion_scale =
      object.number("transmission_dispersion_scale", to.transmission_dispersion_scale, zero_to_one);
  to.transmission_dispersion_abbe_number = object.number(
      "transmission_dispersion_abbe_number", to.transmission_dispersion_abbe_number, {.low = 1, .high = 1e4});
}

void read_above(JsonObject& object, OpenPbr& to, MaterialDescription& material, TextureLibrary& textures) {
  if (const auto weight = object.find("coat_weight"))
    to.coat_weight = read_number(*weight, textures, zero_to_one, &material.textures.coat);
  to.coat_color = object.color("coat_color", to.coat_color, zero_to_one);
  to.coat_roughness = object.number("coat_roughness", to.coat_roughness, zero_to_one);
  to.coat_roughness_anisotropy =
      object.number("coat_roughness_anisotropy", to.coat_roughness_anisotropy, zero_to_one);
  to.coat_ior = object.number("coat_ior", to.coat_ior, {.low = 1, .high = 3});
  to.coat_darkening = object.number("coat_darkening", to.coat_darkening, zero_to_one);
  to.fuzz_weight = object.number("fuzz_weight", to.fuzz_weight, zero_to_one);
  to.fuzz_color = object.color("fuzz_color", to.fuzz_color, zero_to_one);
  to.fuzz_roughness = object.number("fuzz_roughness", to.fuzz_roughness, zero_to_one);
  to.thin_film_weight = object.number("thin_film_weight", to.thin_film_weight, zero_to_one);
  to.thin_film_thickness =
      object.number("thin_film_thickness", to.thin_film_thickness, {.low = 0, .high = 100});
  to.thin_film_ior = object.number("thin_film_ior", to.thin_film_ior, {.low = 1, .high = 3});
}

void read_emission(JsonObject& object, OpenPbr& to, MaterialDescription& material, TextureLibrary& textures) {
  to.emission_luminance = object.number("emission_luminance", to.emission_luminance, color_range);
  const auto color = object.find("emission_color");
  if (!color) return;
  const Pattern emission = read_plain_color(*color, textures);
  to.emission_color = emission.even;
  material.textures.emission = emission.texture;
}

void read_geometry(JsonObject& object, OpenPbr& to, MaterialDescription& material, TextureLibrary& textures) {
  to.geometry_tangent = object.number("geometry_tangent", to.geometry_tangent, {.low = -360, .high = 360});
  to.geometry_thin_walled = object.boolean("geometry_thin_walled", to.geometry_thin_walled);
  const auto opacity = object.find("geometry_opacity");
  if (!opacity) return;
  to.geometry_opacity = read_number(*opacity, textures, zero_to_one, &material.textures.opacity);
  const bool partly = to.geometry_opacity < 1 || material.textures.opacity >= 0,
             dielectric = to.base_metalness < 1 || material.textures.metalness >= 0;
  if (partly && to.transmission_weight > 0 && dielectric)
    opacity->fail("a material with a \"transmission_weight\" is not partly there");
}

}  // namespace

MaterialDescription read_openpbr(const JsonValue& value, std::string name,
                                 std::vector<MediumDescription>& media, TextureLibrary& textures) {
  return value.object("openpbr_material", [&](JsonObject& object) {
    MaterialDescription material;
    material.name = std::move(name);
    object.text("type", "openpbr");
    OpenPbr values;
    read_base(object, values, material, textures);
    read_transmission(object, values, material, textures);
    read_above(object, values, material, textures);
    read_emission(object, values, material, textures);
    read_geometry(object, values, material, textures);
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
