// Metallic-roughness materials and their extensions (glTF 2.0, section 3.9; KHR_materials_ior, _transmission,
// _volume).
#include "scene/models/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

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

}  // namespace

GltfMaterials::GltfMaterials(const JsonAt& root) {
  for (const JsonAt& at : root.list("materials")) materials_.push_back(read(at));
  const nlohmann::json empty = nlohmann::json::object();
  materials_.push_back(read(JsonAt(Source{}, empty, "")));
  materials_.back().material.name = "default";
}

GltfMaterials::Entry GltfMaterials::read(const JsonAt& at) {
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
  const double ior = read_ior(at), mirror = metallic * square(1 - roughness);
  m.diffuse = base * (1 - mirror);
  m.ambient = 0.1 * m.diffuse;
  m.specular = glm::mix(dvec3(reflectance(ior)), base, metallic);
  m.exponent = std::clamp(2 / std::max(square(square(roughness)), 1e-9) - 2, 1.0, 1e5);
  m.blinn = true;
  m.reflection = base * mirror;
  transmit(at, entry, base * (1 - metallic), ior);
  blend(at, entry, alpha);
  return entry;
}

// `base` is the colour of what is no metal: metals let nothing through.
void GltfMaterials::transmit(const JsonAt& at, Entry& entry, dvec3 base, double ior) {
  const Volume volume = read_volume(at);
  const auto extension = at.extension("KHR_materials_transmission");
  const double factor = extension ? extension->number("transmissionFactor", 0, unit_range) : 0;
  const dvec3 passed = base * factor;
  if (passed == dvec3(0)) return;
  MaterialDescription& m = entry.material;
  m.diffuse = glm::max(m.diffuse - passed, dvec3(0));
  m.ambient = 0.1 * m.diffuse;
  if (volume.thickness > 0 && ior >= 1) {
    m.type = MaterialType::dielectric;
    m.reflection = dvec3(1);
    m.transmission = passed;
    entry.has_medium = true;
    entry.medium.name = m.name;
    entry.medium.ior = ior;
    // A channel of 0 would absorb without bound.
    if (std::isfinite(volume.distance))
      entry.medium.absorption = -glm::log(glm::max(volume.color, dvec3(1e-6))) / volume.distance;
  } else {
    const double mirrored = reflectance(ior);
    m.reflection = glm::min(m.reflection + mirrored, dvec3(1));
    m.transmission = passed * (1 - mirrored);
  }
}

void GltfMaterials::blend(const JsonAt& at, Entry& entry, double alpha) {
  const std::string mode = at.text("alphaMode");
  const double cutoff = at.number("alphaCutoff", 0.5, not_negative);
  double opacity = 1;
  if (mode == "BLEND") opacity = alpha;
  if (mode == "MASK") opacity = alpha >= cutoff ? 1 : 0;
  if (opacity == 1) return;
  MaterialDescription& m = entry.material;
  if (m.type == MaterialType::dielectric) return;  // its own transmission says more
  for (dvec3* part : {&m.ambient, &m.diffuse, &m.specular, &m.reflection, &m.transmission}) *part *= opacity;
  m.transmission += 1 - opacity;
}

int GltfMaterials::use(std::size_t index, bool vertex_color, Model& model) {
  const auto [found, added] =
      used_.try_emplace({index, vertex_color}, static_cast<int>(model.materials.size()));
  if (added) {
    const Entry& entry = materials_.at(index);
    model.materials.push_back(entry.material);
    model.materials.back().vertex_color = vertex_color;
    if (entry.has_medium) {
      model.materials.back().medium = static_cast<int>(model.media.size());
      model.media.push_back(entry.medium);
    }
  }
  return found->second;
}

}  // namespace sundog::models
