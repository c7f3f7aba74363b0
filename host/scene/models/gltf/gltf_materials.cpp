// Metallic-roughness materials and their extensions (glTF 2.0, section 3.9; KHR_materials_ior, _transmission,
// _volume, _dispersion; those of layers in gltf_layers.h).
#include "scene/models/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scene/models/gltf/gltf_layers.h"
#include "shared/metal_rough.h"

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

// An index of 0 stands for total reflection.
double reflectance(double ior) { return ior == 0 ? 1 : square((ior - 1) / (ior + 1)); }

/// KHR_materials_specular: what a dielectric reflects straight on, by a factor and a colour.
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

/// KHR_materials_dispersion: 20 over Abbe's number, which is not below 1 here.
Dispersion read_dispersion(const JsonAt& at, double ior) {
  const auto extension = at.extension("KHR_materials_dispersion");
  const double dispersion = extension ? extension->number("dispersion", 0, not_negative) : 0;
  return dispersion > 0 ? cauchy_of_abbe(ior, std::max(20 / dispersion, 1.0)) : Dispersion{};
}

}  // namespace

GltfMaterials::GltfMaterials(const JsonAt& root, GltfTextures& textures) : textures_(textures) {
  for (const JsonAt& at : root.list("materials")) materials_.push_back(read(at));
  const nlohmann::json empty = nlohmann::json::object();
  materials_.push_back(read(JsonAt(Source{}, empty, "")));
  materials_.back().material.name = "default";
  settle_sides();
}

// Files whose materials are all of one side are mostly closed solids, or made without a thought of it: they
// keep both. Where some say that they have two, the others have one.
void GltfMaterials::settle_sides() {
  if (std::ranges::none_of(materials_, &Entry::two_sided)) return;
  for (Entry& entry : materials_) {
    MaterialDescription& m = entry.material;
    if (entry.two_sided || m.transmission != dvec3(0)) continue;
    m.one_sided = true;
  }
}

GltfMaterials::Entry GltfMaterials::read(const JsonAt& at) const {
  Entry entry;
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
  const double ior = read_ior(at), mirror = metal_mirror(metallic, roughness);
  const dvec3 plain = read_specular(at, reflectance(ior));
  m.diffuse = base * (1 - mirror);
  m.ambient = 0.1 * m.diffuse;
  m.specular = glm::mix(plain, base, metallic);
  m.exponent = rough_exponent(roughness);
  m.blinn = true;
  m.reflection = base * mirror;
  entry.values = {base, metallic, roughness, plain.x};
  m.emission = at.vector("emissiveFactor", dvec3(0), unit_range);
  if (const auto strength = at.extension("KHR_materials_emissive_strength"))
    m.emission *= strength->number("emissiveStrength", 1, not_negative);
  transmit(at, entry, base * (1 - metallic), ior);
  entry.two_sided = at.boolean("doubleSided", false);
  read_textures(at, entry);
  add_specular_textures(at, entry);
  add_clearcoat(at, entry);
  add_layers(at, entry, ior, roughness);
  read_unlit(at, entry, base);
  blend(at, entry, alpha);
  return entry;
}

// `base` is the colour of what is no metal: metals let nothing through.
void GltfMaterials::transmit(const JsonAt& at, Entry& entry, dvec3 base, double ior) const {
  const Volume volume = read_volume(at);
  const auto extension = at.extension("KHR_materials_transmission");
  const double factor = extension ? extension->number("transmissionFactor", 0, unit_range) : 0;
  const dvec3 passed = base * factor;
  if (passed == dvec3(0)) return;
  MaterialDescription& m = entry.material;
  if (const auto texture = extension->find("transmissionTexture")) {
    // The diffuse term has the rest, texel by texel: use_transmission().
    entry.transmission = textures_.read(*texture);
    entry.transmission->channel = 0;
    entry.transmitted = std::min(factor * (1 - entry.values.metalness), 1.0);
  } else {
    m.diffuse = glm::max(m.diffuse - passed, dvec3(0));
    m.ambient = 0.1 * m.diffuse;
  }
  if (volume.thickness > 0 && ior >= 1) {
    m.type = MaterialType::dielectric;
    m.reflection = dvec3(1);
    m.transmission = passed;
    entry.has_medium = true;
    entry.medium.name = m.name;
    entry.medium.ior = ior;
    entry.medium.dispersion = read_dispersion(at, ior);
    // A channel of 0 would absorb without bound.
    if (std::isfinite(volume.distance))
      entry.medium.absorption = -glm::log(glm::max(volume.color, dvec3(1e-6))) / volume.distance;
  } else {
    const double mirrored = reflectance(ior);
    m.reflection = glm::min(m.reflection + mirrored, dvec3(1));
    m.transmission = passed * (1 - mirrored);
  }
}

void GltfMaterials::read_textures(const JsonAt& at, Entry& entry) const {
  MaterialDescription& m = entry.material;
  if (const auto pbr = at.find("pbrMetallicRoughness")) {
    if (const auto base = pbr->find("baseColorTexture")) entry.base = textures_.read(*base);
    if (const auto both = pbr->find("metallicRoughnessTexture")) entry.metal_rough = textures_.read(*both);
  }
  if (const auto emission = at.find("emissiveTexture"))
    if (m.emission != dvec3(0)) entry.emission = textures_.read(*emission);
  if (const auto normal = at.find("normalTexture")) {
    entry.normal = textures_.read(*normal);
    m.normal_scale = normal->number("scale", 1, {});
  }
  if (const auto occlusion = at.find("occlusionTexture")) {
    entry.occlusion = textures_.read(*occlusion);
    entry.occlusion->channel = 0;
    m.occlusion = occlusion->number("strength", 1, unit_range);
  }
  const bool half_metal = entry.values.metalness > 0 && entry.values.metalness < 1;
  entry.by_values = (entry.metal_rough || (entry.base && half_metal)) && m.transmission == dvec3(0) &&
                    m.type != MaterialType::dielectric;
}

/// KHR_materials_unlit: the base colour as it stands, under whatever light.
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

/// The textures of KHR_materials_specular: alpha of the one, colour of the other. What is no metal has them.
void GltfMaterials::add_specular_textures(const JsonAt& at, Entry& entry) const {
  const auto extension = at.extension("KHR_materials_specular");
  if (!extension || (!entry.by_values && entry.values.metalness > 0)) return;
  if (const auto strength = extension->find("specularTexture")) {
    entry.specular = textures_.read(*strength);
    entry.specular->channel = 3;
  }
  if (const auto color = extension->find("specularColorTexture"))
    entry.specular_color = textures_.read(*color);
}

/// KHR_materials_clearcoat as a mirror of 4 % above the rest, as far as it is smooth.
void GltfMaterials::add_clearcoat(const JsonAt& at, Entry& entry) const {
  MaterialDescription& material = entry.material;
  const auto extension = at.extension("KHR_materials_clearcoat");
  if (!extension || material.type == MaterialType::dielectric || has_layers(at)) return;
  const double factor = extension->number("clearcoatFactor", 0, unit_range);
  const double coat =
      0.04 * factor * square(1 - extension->number("clearcoatRoughnessFactor", 0, unit_range));
  if (const auto texture = extension->find("clearcoatTexture")) {
    entry.coat = textures_.read(*texture);
    entry.coat->channel = 0;
  }
  if (entry.coat || entry.by_values) {  // the device computes the terms
    material.coat = coat;
    return;
  }
  for (dvec3* part : {&material.ambient, &material.diffuse, &material.specular, &material.reflection})
    *part *= 1 - coat;
  material.reflection += coat;
}

/// The same values as OpenPBR's, of materials that have layers. What they let through stays as it is.
void GltfMaterials::add_layers(const JsonAt& at, Entry& entry, double ior, double roughness) {
  if (!has_layers(at)) return;
  MaterialDescription& m = entry.material;
  OpenPbr values{.base_color = entry.values.base, .base_metalness = entry.values.metalness};
  values.specular_roughness = roughness;
  values.specular_ior = ior < 1 ? 1.5 : ior;
  if (const auto specular = at.extension("KHR_materials_specular")) {
    values.specular_weight = specular->number("specularFactor", 1, unit_range);
    values.specular_color =
        glm::min(specular->vector("specularColorFactor", dvec3(1), not_negative), dvec3(1));
  }
  if (const auto through = at.extension("KHR_materials_transmission"))
    values.transmission_weight = through->number("transmissionFactor", 0, unit_range);
  add_gltf_layers(at, values);
  const MaterialDescription before = m;
  MediumDescription inside;
  set_openpbr(values, m, inside);
  m.type = before.type;
  m.coat = 0;
  m.emission = before.emission;
  const double through = values.transmission_weight * (1 - values.base_metalness);
  m.reflection = through == 0                         ? dvec3(0)
                 : m.type == MaterialType::dielectric ? dvec3(through)
                                                      : dvec3(through * reflectance(ior));
  m.transmission = before.transmission;
  entry.specular = entry.specular_color = std::nullopt;
}

void GltfMaterials::blend(const JsonAt& at, Entry& entry, double alpha) {
  const std::string mode = at.text("alphaMode");
  const double cutoff = at.number("alphaCutoff", 0.5, not_negative);
  if (mode != "BLEND" && mode != "MASK") return;
  MaterialDescription& m = entry.material;
  if (m.type == MaterialType::dielectric) return;  // its own transmission says more
  if (mode == "MASK" && cutoff == 0) return;
  if (entry.base) {
    m.opacity = alpha;
    if (mode == "MASK") m.cutoff = cutoff;
    entry.opacity = entry.base;
    entry.opacity->channel = 3;
    return;
  }
  // The same everywhere: a thin pane.
  const double opacity = mode == "BLEND" ? alpha : alpha >= cutoff ? 1 : 0;
  if (m.layers) {
    m.opacity = opacity;
    return;
  }
  for (dvec3* part : {&m.ambient, &m.diffuse, &m.specular, &m.reflection, &m.transmission}) *part *= opacity;
  m.emission *= opacity;
  m.transmission += 1 - opacity;
}

void GltfMaterials::use_textures(const Entry& entry, MaterialDescription& material, Model& model) {
  MaterialTextures& to = material.textures;
  if (entry.base && !entry.unlit) {
    to.ambient = to.diffuse = textures_.use(*entry.base, true, model);
    if (material.reflection != dvec3(0) && !entry.has_medium) to.reflection = to.diffuse;
    if (material.transmission != dvec3(0)) to.transmission = to.diffuse;
    if (entry.values.metalness == 1) to.specular = to.diffuse;
  }
  if (entry.transmission && !entry.unlit) use_transmission(entry, material, model);
  if (entry.by_values) {
    material.metal_rough = entry.values;
    to.ambient = to.reflection = to.specular = -1;
    if (entry.metal_rough) to.metal_rough = textures_.use(*entry.metal_rough, false, model);
  }
  if (!entry.unlit) use_specular(entry, material, model);
  if (entry.coat) to.coat = textures_.use(*entry.coat, false, model);
  if (entry.opacity) to.opacity = textures_.use(*entry.opacity, true, model);
  if (entry.emission) to.emission = textures_.use(*entry.emission, true, model);
  if (entry.normal) to.normal = textures_.use(*entry.normal, false, model);
  if (entry.occlusion) to.occlusion = textures_.use(*entry.occlusion, false, model);
}

/// With a texture t of the share f that passes: the transmission times t, the diffuse term times 1 - f t.
void GltfMaterials::use_transmission(const Entry& entry, MaterialDescription& material, Model& model) {
  MaterialTextures& to = material.textures;
  const int passing = textures_.use(*entry.transmission, false, model);
  if (passing < 0) return;
  TextureDescription rest = model.textures[static_cast<std::size_t>(passing)];
  rest.factor = glm::dvec4(-entry.transmitted);
  rest.offset = glm::dvec4(1);
  model.textures.push_back(rest);
  const int remaining = static_cast<int>(model.textures.size()) - 1;
  to.transmission = GltfTextures::product(passing, to.transmission, model);
  to.ambient = to.diffuse = GltfTextures::product(remaining, to.diffuse, model);
}

void GltfMaterials::use_specular(const Entry& entry, MaterialDescription& material, Model& model) {
  const int strength = entry.specular ? textures_.use(*entry.specular, false, model) : -1;
  const int color = entry.specular_color ? textures_.use(*entry.specular_color, true, model) : -1;
  const int both = GltfTextures::product(strength, color, model);
  if (both >= 0) material.textures.specular = both;
}

int GltfMaterials::use(std::size_t index, bool vertex_color, Model& model) {
  const auto [found, added] =
      used_.try_emplace({index, vertex_color}, static_cast<int>(model.materials.size()));
  if (added) {
    const Entry& entry = materials_.at(index);
    model.materials.push_back(entry.material);
    model.materials.back().vertex_color = vertex_color;
    use_textures(entry, model.materials.back(), model);
    if (entry.has_medium) {
      model.materials.back().medium = static_cast<int>(model.media.size());
      model.media.push_back(entry.medium);
    }
  }
  return found->second;
}

}  // namespace sundog::models
