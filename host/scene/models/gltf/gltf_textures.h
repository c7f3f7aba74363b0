// glTF's textures, samplers and images (glTF 2.0, section 3.8), KHR_texture_transform and EXT_texture_webp.
#pragma once
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "scene/model.h"
#include "scene/models/gltf/gltf_accessors.h"
#include "scene/models/gltf/gltf_json.h"

namespace sundog::models {

/// Sets of texture coordinates that are read.
inline constexpr std::uint64_t most_uv_sets = 4;

class GltfTextures {
 public:
  /// Checks the document's textures, samplers and images. Throws SceneError.
  GltfTextures(const JsonAt& root, const GltfAccessors& accessors);

  /// Checks a material's reference to a texture; returns it without its image (`image` counts the
  /// document's). Its coordinates have v up, as all of a model's.
  TextureDescription read(const JsonAt& info) const;

  /// Adds a texture that read() gave to a model, its image as colours or as data. Returns its index;
  /// -1, and a warning, where the image cannot be had.
  int use(const TextureDescription& texture, bool srgb, Model& model);

  /// Adds the product of two of a model's textures; where one is -1 the other is it.
  static int product(int a, int b, Model& model);

 private:
  struct Entry {
    std::size_t image = 0;
    TextureDescription sampled;  // wraps and filter
    bool usable = false;         // it has an image of a format that may be read
  };
  Entry read_texture(const JsonAt& at) const;
  ImageDescription load(std::size_t index) const;
  int use_image(std::size_t index, bool srgb, Model& model);

  const GltfAccessors& accessors_;
  std::vector<JsonAt> images_;
  std::vector<TextureDescription> samplers_;
  std::vector<Entry> textures_;
  std::map<std::pair<std::size_t, bool>, int> used_;  // images of the model
};

}  // namespace sundog::models
