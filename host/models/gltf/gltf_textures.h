// glTF's textures, samplers and images (glTF 2.0, section 3.8), KHR_texture_transform and EXT_texture_webp.
#pragma once
#include <map>
#include <utility>
#include <vector>

#include "models/gltf/gltf_accessors.h"
#include "models/gltf/gltf_json.h"
#include "models/model.h"

namespace sundog::models {

/// Maximum number of texture coordinate sets.
inline constexpr std::uint64_t most_uv_sets = 4;

/// The source of a material's textures.
class TextureSource {
 public:
  virtual ~TextureSource() = default;

  /// Validates a material's texture reference and returns it without the image (`image` is the document's
  /// index). v points up, as in all models.
  virtual TextureDescription read(const JsonAt& info) const = 0;

  /// Adds a texture returned by read() to a model, its image as colours or data. Returns its index; -1, with
  /// a warning, if the image is unavailable.
  virtual int use(const TextureDescription& texture, bool srgb, Model& model) = 0;
};

class GltfTextures final : public TextureSource {
 public:
  /// Validates the document's textures, samplers and images. Throws SceneError.
  GltfTextures(const JsonAt& root, const GltfAccessors& accessors);

  TextureDescription read(const JsonAt& info) const override;
  int use(const TextureDescription& texture, bool srgb, Model& model) override;

  /// Adds the product of two of a model's textures; returns the other if one is -1.
  static int product(int a, int b, Model& model);

 private:
  struct Entry {
    std::size_t image = 0;
    TextureDescription sampled;  // wrap modes and filter
    bool usable = false;         // its image has a supported format
  };
  Entry read_texture(const JsonAt& at) const;
  ImageDescription load(std::size_t index, std::vector<std::string>& warnings) const;
  int use_image(std::size_t index, bool srgb, Model& model);

  const GltfAccessors& accessors_;
  std::vector<JsonAt> images_;
  std::vector<TextureDescription> samplers_;
  std::vector<Entry> textures_;
  std::map<std::pair<std::size_t, bool>, int> used_;  // the model's images
};

}  // namespace sundog::models
