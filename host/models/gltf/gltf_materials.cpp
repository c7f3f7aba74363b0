// Metallic-roughness materials and their extensions (glTF 2.0, section 3.9; KHR_materials_ior, _transmission,
// _volume, _dispersion; layers in gltf_layers.h).
#include "models/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "models/gltf/gltf_layers.h"
#include "models/values/lowering.h"
#include "shared/scene.h"

namespace sundog::models {
namespace {

double square(double x) { return x * x; }

double read_ior(const JsonAt& at) {
  const auto extension = at.extension("KHR_materials_ior");
  const auto found = extension ? extension->find("ior") : std::nullopt;
  if (!found) return 1.5;
  const double ior = found->number(not_negative);
  if (ior != 0 && ior < 1) found->fail("an index of refraction of 1 or more, or 0, wanted");
  return ior;
}

// An index of 0 means total reflection.
double reflectance(double ior) { return ior == 0 ? 1 : square((ior - 1) / (ior + 1)); }

/// KHR_materials_specular: a dielectric's normal reflectance, by a factor and a colour.
dvec3 read_specular(const JsonAt& at, double reflectance) {
  const auto extension = at.extension("KHR_materials_specular");
  if (!extension) return dvec3(reflectance);
  const double factor = extension->number("specularFactor", 1, unit_range);
  const dvec3 color = extension->vector("specularColorFactor", dvec3(1), not_negative);
  return glm::min(reflectance * color, dvec3(1)) * factor;
}

struct Volume {
  double thickness = 0, distance = std::numeric_limits<double>::infinity();
  dvec3 color{1};
};

Volume read_volume(const JsonAt& at) {
  Volume volume;
  if (const auto extension = at.extension("KHR_materials_volume")) {
    volume.thickness = extension->number("thicknessFactor", 0, not_negative);
    volume.distance = extension->number("attenuationDistance", volume.distance, positive);
    volume.color = extension->vector("attenuationColor", volume.color, unit_range);
  }
  return volume;
}

/// KHR_materials_dispersion: 20 over the Abbe number, which is at least 1 here.
Dispersion read_dispersion(const JsonAt& at, double ior) {
  const auto extension = at.extension("KHR_materials_dispersion");
  const double dispersion = extension ? extension->number("dispersion", 0, not_negative) : 0;
  return dispersion > 0 ? cauchy_of_abbe(ior, std::max(20 / dispersion, 1.0)) : Dispersion{};
}

/// Subtracts the energy of a rough highlight from the transmission. Clear glass is unchanged.
void take_highlight_from_transmission(MaterialDescription& material) {
  const dvec3 returned = material.specular * lowering::highlight_energy(material.exponent);
  if (!material.layers && std::max({returned.x, returned.y, returned.z}) > 1e-3)
    material.transmission *= 1.0 - returned;
}

bool is_partly_there(const JsonAt& at) {
  const std::string mode = at.text("alphaMode");
  return mode == "BLEND" || mode == "MASK";
}

/// KHR_materials_transmission without a volume is a thin wall. Partly opaque materials have the fixed shares
/// of GltfMaterials::transmit() with every integrator.
bool is_wall(const JsonAt& at, const MaterialDescription& material, double ior) {
  return material.type == MaterialType::phong && material.transmission != dvec3(0) && ior >= 1 &&
         !is_partly_there(at);
}

/// In path tracing, the Fresnel equations replace the share `mirrored`.
void make_wall(OpenPbr& values, MaterialDescription& material, double mirrored) {
  values.geometry_thin_walled = true;
  material.type = MaterialType::dielectric;
  material.transmission /= 1 - mirrored;
}

}  // namespace

GltfMaterials::GltfMaterials(const JsonAt& root, TextureSource& textures, bool for_paths)
    : textures_(textures), for_paths_(for_paths), document_(root.list("materials")) {
  for (const JsonAt& at : document_) materials_.push_back(read(at, VertexColors::none));
  const nlohmann::json empty = nlohmann::json::object();
  materials_.push_back(read(JsonAt(Source{}, empty, ""), VertexColors::none));
  materials_.back().material.name = "default";
  settle_sides();
}

// If all materials of a file are single-sided, it is mostly closed solids or made without regard to sides:
// they stay double-sided. If some are declared double-sided, the others are single-sided.
void GltfMaterials::settle_sides() {
  if (std::ranges::none_of(materials_, &Entry::two_sided)) return;
  for (Entry& entry : materials_) {
    MaterialDescription& m = entry.material;
    if (entry.two_sided || m.transmission != dvec3(0)) continue;
    m.one_sided = true;
  }
}

GltfMaterials::Entry GltfMaterials::read(const JsonAt& at, VertexColors colors) const {
  Entry entry;
  entry.fades = colors == VertexColors::with_alpha;
  MaterialDescription& m = entry.material;
  m.name = at.text("name");
  dvec3 base{1};
  double alpha = 1, metallic = 1, roughness = 1;
  if (const auto pbr = at.find("pbrMetallicRoughness")) {
    if (const auto factor = pbr->find("baseColorFactor")) {
      const std::vector<double> rgba = factor->numbers(4, unit_range);
      base = {rgba[0], rgba[1], rgba[2]};
      alpha = rgba[3];
    }
    metallic = pbr->number("metallicFactor", 1, unit_range);
    roughness = pbr->number("roughnessFactor", 1, unit_range);
  }
  const double ior = read_ior(at), mirror = lowering::metal_mirror(metallic, roughness);
  const dvec3 plain = read_specular(at, reflectance(ior));
  m.exponent = lowering::rough_exponent(roughness);
  const double energy = lowering::highlight_energy(m.exponent),
               lobe = lowering::metal_highlight(energy, mirror);
  m.diffuse = base * glm::max(1 - mirror - lobe * glm::mix(plain, dvec3(1), metallic), dvec3(0));
  m.ambient = 0.1 * m.diffuse;
  m.specular = glm::mix(plain, base, metallic) * (lobe / energy);
  m.blinn = true;
  m.reflection = base * mirror;
  entry.values = {base, metallic, roughness, plain.x};
  m.emission = at.vector("emissiveFactor", dvec3(0), unit_range);
  if (const auto strength = at.extension("KHR_materials_emissive_strength"))
    m.emission *= strength->number("emissiveStrength", 1, {0, 1e30, false});
  transmit(at, entry, base * (1 - metallic), ior);
  entry.two_sided = at.boolean("doubleSided", false);
  read_textures(at, entry);
  add_specular_textures(at, entry);
  add_clearcoat(at, entry);
  add_layers(at, entry, ior);
  take_highlight_from_transmission(m);
  read_unlit(at, entry, base);
  blend(at, entry, alpha);
  return entry;
}

// `base` is the colour of the non-metal part: metals transmit nothing.
void GltfMaterials::transmit(const JsonAt& at, Entry& entry, dvec3 base, double ior) const {
  const Volume volume = read_volume(at);
  const auto extension = at.extension("KHR_materials_transmission");
  const double factor = extension ? extension->number("transmissionFactor", 0, unit_range) : 0;
  const dvec3 passed = base * factor;
  if (passed == dvec3(0)) return;
  MaterialDescription& m = entry.material;
  if (extension->find("transmissionTexture")) {
    // The diffuse term gets the rest, per texel: use_transmission().
    entry.transmission = read_texture(extension, "transmissionTexture", 0);
    entry.transmitted = std::min(factor * (1 - entry.values.metalness), 1.0);
  } else {
    m.diffuse = glm::max(m.diffuse - passed, dvec3(0));
    m.ambient = 0.1 * m.diffuse;
  }
  if (volume.thickness > 0 && ior >= 1) {
    m.type = MaterialType::dielectric;
    m.reflection = dvec3(factor);
    m.transmission = passed;
    entry.has_medium = true;
    entry.medium.name = m.name;
    entry.medium.ior = ior;
    entry.medium.dispersion = read_dispersion(at, ior);
    // A component of 0 would absorb infinitely.
    if (std::isfinite(volume.distance))
      entry.medium.absorption = -glm::log(glm::max(volume.color, dvec3(1e-6))) / volume.distance;
  } else {
    const double mirrored = reflectance(ior);
    m.diffuse *= 1 - mirrored;
    m.ambient *= 1 - mirrored;
    m.reflection = glm::min(m.reflection + mirrored, dvec3(1));
    m.transmission = passed * (1 - mirrored);
  }
}

/// Reads the texture `name`; only its channel `channel`, unless that is -1.
std::optional<TextureDescription> GltfMaterials::read_texture(const std::optional<JsonAt>& of,
                                                              const char* name, int channel) const {
  const auto found = of ? of->find(name) : std::nullopt;
  if (!found) return std::nullopt;
  TextureDescription texture = textures_.read(*found);
  texture.channel = channel;
  return texture;
}

void GltfMaterials::read_textures(const JsonAt& at, Entry& entry) const {
  MaterialDescription& m = entry.material;
  const auto pbr = at.find("pbrMetallicRoughness");
  entry.base = read_texture(pbr, "baseColorTexture");
  entry.metal_rough = read_texture(pbr, "metallicRoughnessTexture");
  entry.sheen = read_texture(at.extension("KHR_materials_sheen"), "sheenColorTexture");
  const auto gloss = at.extension("KHR_materials_pbrSpecularGlossiness");
  if (gloss && entry.metal_rough) {  // see convert_specular_glossiness()
    entry.metal_rough->channel = 3;
    entry.metal_rough->factor = glm::dvec4(-gloss->number("glossinessFactor", 1, unit_range));
    entry.metal_rough->offset = glm::dvec4(1);
  }
  if (m.emission != dvec3(0)) entry.emission = read_texture(at, "emissiveTexture");
  entry.normal = read_texture(at, "normalTexture");
  if (entry.normal) m.normal_scale = at.member("normalTexture").number("scale", 1, {});
  entry.occlusion = read_texture(at, "occlusionTexture", 0);
  if (entry.occlusion) m.occlusion = at.member("occlusionTexture").number("strength", 1, unit_range);
  const bool half_metal = entry.values.metalness > 0 && entry.values.metalness < 1;
  entry.by_values = (entry.metal_rough || (entry.base && half_metal)) && m.transmission == dvec3(0) &&
                    m.type != MaterialType::dielectric;
}

/// KHR_materials_unlit: the base colour, whatever the light.
void GltfMaterials::read_unlit(const JsonAt& at, Entry& entry, dvec3 base) {
  entry.unlit = at.extension("KHR_materials_unlit").has_value();
  if (!entry.unlit) return;
  MaterialDescription& m = entry.material;
  m.ambient = m.diffuse = m.specular = m.reflection = m.transmission = dvec3(0);
  m.type = MaterialType::phong;
  m.layers = std::nullopt;
  m.emission = base;
  entry.has_medium = entry.by_values = false;
  entry.emission = entry.base;
  entry.normal = entry.occlusion = entry.coat = std::nullopt;
  m.coat = 0;
}

/// The textures of KHR_materials_specular: one's alpha and the other's colour. Only non-metals use them.
void GltfMaterials::add_specular_textures(const JsonAt& at, Entry& entry) const {
  const auto extension = at.extension("KHR_materials_specular");
  if (!extension || (!entry.by_values && entry.values.metalness > 0)) return;
  entry.specular = read_texture(extension, "specularTexture", 3);
  entry.specular_color = read_texture(extension, "specularColorTexture");
}

/// The texture whose red channel multiplies the coat's weight.
std::optional<TextureDescription> GltfMaterials::read_coat_texture(const JsonAt& at) const {
  return read_texture(at.extension("KHR_materials_clearcoat"), "clearcoatTexture", 0);
}

/// KHR_materials_clearcoat as a 4 % mirror on top, weighted by its smoothness.
void GltfMaterials::add_clearcoat(const JsonAt& at, Entry& entry) const {
  MaterialDescription& material = entry.material;
  const auto extension = at.extension("KHR_materials_clearcoat");
  if (!extension || material.type == MaterialType::dielectric || has_layers(at)) return;
  const double factor = extension->number("clearcoatFactor", 0, unit_range);
  const double coat =
      0.04 * factor * square(1 - extension->number("clearcoatRoughnessFactor", 0, unit_range));
  entry.coat = read_coat_texture(at);
  if (entry.coat || entry.by_values) {  // the device computes the terms
    material.coat = coat;
    return;
  }
  for (dvec3* part : {&material.ambient, &material.diffuse, &material.specular, &material.reflection})
    *part *= 1 - coat;
  material.reflection += coat;
}

/// Adds the material's values as OpenPBR layers. Every integrator uses them for materials with layers; only
/// path tracing does for others.
void GltfMaterials::add_layers(const JsonAt& at, Entry& entry, double ior) const {
  const bool metal_map = entry.metal_rough && entry.values.metalness > 0;
  const bool always = has_layers(at);
  if (at.extension("KHR_materials_unlit")) return;
  OpenPbr values = gltf_openpbr(at, entry.values, ior);
  if (always) {
    const bool wall = is_wall(at, entry.material, ior);
    MaterialDescription other = entry.material;
    set_gltf_layers(values, reflectance(ior), entry.material);
    if (!wall) return;
    make_wall(values, other, reflectance(ior));
    set_gltf_layers(values, reflectance(ior), other);
    entry.by_paths = other;
    return;
  }
  MaterialDescription other;
  // A texture on a full metal also determines where it is not metal, and so may transmit.
  Entry passing = entry;
  if (metal_map && entry.values.metalness == 1 && !is_partly_there(at)) {
    transmit(at, passing, entry.values.base, ior);
    entry.medium = passing.medium;
    entry.paths_have_medium = passing.has_medium;
    entry.glass = passing.transmission;
  }
  const MaterialDescription& m = passing.material;
  other.type = m.type, other.emission = m.emission, other.transmission = m.transmission;
  other.normal_scale = m.normal_scale, other.occlusion = m.occlusion;
  if (m.transmission == dvec3(0)) values.transmission_weight = 0;
  // Kernels subtract the metal's share, and the texture's, from the transmission. Set in use_by_paths().
  if (metal_map && entry.values.metalness < 1) other.transmission /= 1 - entry.values.metalness;
  if (metal_map) other.textures.metalness = 0;
  if (passing.transmission) other.textures.glass = 0;
  if (values.coat_weight > 0) entry.coat_weight = read_coat_texture(at);
  if (is_wall(at, m, ior)) make_wall(values, other, reflectance(ior));
  set_gltf_layers(values, reflectance(ior), other);
  entry.by_paths = other;
}

void GltfMaterials::blend(const JsonAt& at, Entry& entry, double alpha) {
  const std::string mode = at.text("alphaMode");
  const double cutoff = at.number("alphaCutoff", 0.5, not_negative);
  MaterialDescription& m = entry.material;
  // A dielectric's own transmission takes precedence.
  if ((mode != "BLEND" && mode != "MASK") || m.type == MaterialType::dielectric ||
      (mode == "MASK" && cutoff == 0)) {
    entry.fades = false;
    return;
  }
  if (entry.base || entry.fades) {
    m.opacity = alpha;
    if (mode == "MASK") m.cutoff = cutoff;
    if (entry.by_paths) entry.by_paths->opacity = m.opacity, entry.by_paths->cutoff = m.cutoff;
    entry.opacity = entry.base;
    if (entry.opacity) entry.opacity->channel = 3;
    return;
  }
  // A uniform opacity makes a thin pane.
  const double opacity = mode == "BLEND" ? alpha : alpha >= cutoff ? 1 : 0;
  if (entry.by_paths) entry.by_paths->opacity = opacity;
  if (m.layers) {
    m.opacity = opacity;
    return;
  }
  for (dvec3* part : {&m.ambient, &m.diffuse, &m.specular, &m.reflection, &m.transmission}) *part *= opacity;
  m.emission *= opacity;
  m.transmission += 1 - opacity;
}

}  // namespace sundog::models
