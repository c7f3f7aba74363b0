// The textures of a scene file: named, and used by materials in place of colours and numbers.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// What a texture is wanted for: colours (its images are sRGB), or numbers (its images are data; the first
/// channel unless the texture says which), or data of several channels (normals).
enum class TextureUse { color, number, data };

class TextureLibrary {
 public:
  /// Adds to `scene`, which must outlive the library. With `known` images it reads no file: what is not among
  /// them is lacking.
  explicit TextureLibrary(SceneDescription& scene, const std::vector<ImageDescription>* known = nullptr)
      : scene_(scene), known_(known) {}

  /// Reads an entry of `textures`. Throws SceneError.
  void read(const JsonValue& value, const std::string& name);

  /// After all have been read: whether the names that they use are there. Throws SceneError.
  void check_names() const;

  /// The index in the scene of a texture that `name` names. Throws SceneError.
  int use(const JsonValue& name, TextureUse use);

  /// Of known images: whether one was wanted that is not among them.
  bool lacks_images() const { return lacks_images_; }

 private:
  struct Entry {
    TextureDescription texture;
    std::string file;  // of an image
    std::string place;
    std::string of[2];  // textures that it works on
    bool made = false;  // for a colour
    enum class Encoding { by_use, srgb, linear } encoding = Encoding::by_use;
  };
  Entry read_image(JsonObject& object) const;
  static Entry read_vertex_color(JsonObject& object);
  Entry read_pattern(JsonObject& object, const std::string& type);
  Entry read_ramp(JsonObject& object);
  Entry read_product(JsonObject& object);
  /// A name in a texture, to be checked later.
  std::string refer(const JsonValue& name);
  void check_depth(const std::string& name, unsigned depth) const;
  /// The name of a texture that has been read.
  std::string named(const JsonValue& name) const;
  /// The name of a texture of one colour.
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
