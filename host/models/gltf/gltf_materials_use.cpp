// Adds a document's materials to a model: textures, media, and variants for path tracing.
#include <utility>

#include "models/gltf/gltf_materials.h"

namespace sundog::models {
namespace {

/// Adds the vertex colour, or one channel of it, to a model as a texture.
int add_vertex_color(int channel, Model& model) {
  TextureDescription texture;
  texture.kind = TEXTURE_VERTEX_COLOR;
  texture.channel = channel;
  model.textures.push_back(texture);
  return static_cast<int>(model.textures.size()) - 1;
}

}  // namespace

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
  if (entry.sheen && material.layers) to.fuzz = textures_.use(*entry.sheen, true, model);
  if (entry.opacity) to.opacity = textures_.use(*entry.opacity, true, model);
  if (entry.fades) to.opacity = GltfTextures::product(to.opacity, add_vertex_color(3, model), model);
  if (entry.emission) to.emission = textures_.use(*entry.emission, true, model);
  if (entry.normal) to.normal = textures_.use(*entry.normal, false, model);
  if (entry.occlusion) to.occlusion = textures_.use(*entry.occlusion, false, model);
}

/// Tints the terms that MaterialDescription::vertex_color does not cover.
void GltfMaterials::use_vertex_colors(const Entry& entry, MaterialDescription& material, Model& model) {
  const auto tint = [&](int& slot) {
    slot = GltfTextures::product(slot, add_vertex_color(-1, model), model);
  };
  MaterialTextures& to = material.textures;
  if (entry.unlit) tint(to.emission);
  if (material.transmission != dvec3(0)) tint(to.transmission);
  if (entry.values.metalness == 0 || entry.unlit || material.metal_rough || material.layers) return;
  if (material.reflection != dvec3(0) && !entry.has_medium) tint(to.reflection);
  if (entry.values.metalness == 1) tint(to.specular);
}

/// With a texture t of the transmitted share f: transmission times t, diffuse times 1 - f t.
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

/// The material for path tracing: its layers, and the shared properties.
MaterialDescription GltfMaterials::use_by_paths(const Entry& entry, const MaterialDescription& material,
                                                Model& model) {
  MaterialDescription other = *entry.by_paths;
  other.name = material.name;
  other.medium = material.medium;
  if (entry.paths_have_medium) {
    other.medium = static_cast<int>(model.media.size());
    model.media.push_back(entry.medium);
  }
  other.one_sided = material.one_sided && other.transmission == glm::dvec3(0);
  other.vertex_color = material.vertex_color;
  MaterialTextures& to = other.textures;
  to = {};
  to.emission = material.textures.emission, to.opacity = material.textures.opacity;
  to.normal = material.textures.normal, to.occlusion = material.textures.occlusion;
  const bool shared = !entry.transmission;  // otherwise the transmitted part is subtracted
  if (shared) to.diffuse = material.textures.diffuse;
  if (!shared && entry.base) to.diffuse = textures_.use(*entry.base, true, model);
  if (const auto& glass = shared ? entry.glass : entry.transmission)
    to.glass = textures_.use(*glass, false, model);
  if (entry.sheen) to.fuzz = textures_.use(*entry.sheen, true, model);
  if (entry.coat_weight) to.coat = textures_.use(*entry.coat_weight, false, model);
  use_specular(entry, other, model);
  to.ambient = to.diffuse;
  if (other.transmission != dvec3(0)) to.transmission = to.diffuse;
  if (other.vertex_color) use_vertex_colors(entry, other, model);
  if (entry.metal_rough) {
    TextureDescription packed = *entry.metal_rough;
    if (packed.channel < 0) packed.channel = 1;
    to.roughness = textures_.use(packed, false, model);
    packed.channel = 2;
    if (entry.values.metalness > 0) to.metalness = textures_.use(packed, false, model);
  }
  return other;
}

void GltfMaterials::use_specular(const Entry& entry, MaterialDescription& material, Model& model) {
  const int strength = entry.specular ? textures_.use(*entry.specular, false, model) : -1;
  const int color = entry.specular_color ? textures_.use(*entry.specular_color, true, model) : -1;
  const int both = GltfTextures::product(strength, color, model);
  if (both >= 0) material.textures.specular = both;
}

/// Vertex alpha replaces the terms that blend() derived from a uniform alpha.
GltfMaterials::Entry GltfMaterials::of_colors(std::size_t index, VertexColors colors) const {
  Entry entry = materials_.at(index);
  if (colors != VertexColors::with_alpha || index >= document_.size()) return entry;
  const bool one_sided = entry.material.one_sided;
  entry = read(document_[index], colors);
  entry.material.one_sided = one_sided;
  return entry;
}

int GltfMaterials::use(std::size_t index, VertexColors colors, Model& model) {
  const auto [found, added] = used_.try_emplace({index, colors}, static_cast<int>(model.materials.size()));
  if (added) {
    const Entry entry = of_colors(index, colors);
    model.materials.push_back(entry.material);
    model.materials.back().vertex_color = colors != VertexColors::none;
    use_textures(entry, model.materials.back(), model);
    if (colors != VertexColors::none) use_vertex_colors(entry, model.materials.back(), model);
    if (entry.has_medium) {
      model.materials.back().medium = static_cast<int>(model.media.size());
      model.media.push_back(entry.medium);
    }
    if (for_paths_ && entry.by_paths)
      model.materials.back() = use_by_paths(entry, model.materials.back(), model);
  }
  return found->second;
}

}  // namespace sundog::models
