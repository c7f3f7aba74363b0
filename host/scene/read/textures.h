// Reads a scene file's textures, which materials use by name in place of colours and numbers.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// The use of a texture: colours (sRGB images), a number (data images; the first channel unless the texture
/// selects another), or several channels of data (normals).
enum class TextureUse { color, number, data };
enum class ImageEncoding { automatic, srgb, linear };

class TextureLibrary {
 public:
  /// Adds to `scene`, which must outlive this. With `known` images it reads no file; other images are
  /// missing.
  explicit TextureLibrary(SceneDescription& scene, const std::vector<ImageDescription>* known = nullptr)
      : scene_(scene), known_(known) {}

  /// Reads an entry of `textures`. Throws SceneError.
  void read(const JsonValue& value, const std::string& name);

  /// Call after reading all textures: checks that the names that they use exist. Throws SceneError.
  void check_names() const;

  /// The scene's index of the texture `name` for this use. Throws SceneError.
  int use(const JsonValue& name, TextureUse use);

  /// Whether any image was not among the known ones.
  bool lacks_images() const { return lacks_images_; }

 private:
  struct Entry {
    TextureDescription texture;
    std::string file;  // an image's
    std::string place;
    std::string of[2];  // names of texture operands
    bool made = false;  // generated for a colour
    ImageEncoding encoding = ImageEncoding::automatic;
  };
  Entry read_image_texture(JsonObject& object) const;
  static Entry read_vertex_color(JsonObject& object);
  Entry read_pattern(JsonObject& object, const std::string& type);
  Entry read_ramp(JsonObject& object);
  Entry read_product(JsonObject& object);
  /// Notes a texture name inside a texture, to be checked later.
  std::string refer(const JsonValue& name);
  void check_depth(const std::string& name, std::vector<std::string> inside) const;
  /// The name, checked to be a texture that was read.
  std::string named(const JsonValue& name) const;
  /// Adds a generated single-colour texture; returns its name.
  std::string add_color(const dvec3& color);
  int use(const std::string& name, TextureUse use);
  int use_image(const Entry& entry, bool srgb);
  void add_known_image(const std::string& file, bool srgb);

  SceneDescription& scene_;
  const std::vector<ImageDescription>* known_;
  bool lacks_images_ = false;
  std::vector<JsonValue> references_;
  std::map<std::string, Entry, std::less<>> entries_;
  std::map<std::pair<std::string, TextureUse>, int> used_;
  std::map<std::pair<std::string, bool>, int> images_;
};

}  // namespace sundog
