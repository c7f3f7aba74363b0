// Reads sections in order of dependency; later sections refer to earlier ones by name.
#include "scene/read/surfaces.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/materials/presets.h"
#include "scene/read/textures.h"

namespace sundog {
using nlohmann::json;

namespace {

constexpr std::array<std::string_view, 4> sections{"media", "world", "textures", "materials"};

/// Gives the world a copy of the named medium, with the lowest priority.
void read_world(const JsonValue& value, const NameTable& media, SceneDescription& scene) {
  value.object("world", [&](JsonObject& object) {
    if (const auto name = object.find("medium")) {
      scene.media[0] = scene.media[static_cast<std::size_t>(find_name(*name, media, "medium"))];
      scene.media[0].priority = world_priority;
    }
    if (const auto fog = object.find("fog")) scene.fog = read_fog(*fog);
  });
}

/// A document's own surfaces, which precede those of models in a scene.
struct Head {
  SceneDescription scene;
  SurfaceNames names;
  std::vector<std::string> warnings;
  bool lacks_images = false;
};

Head read_head(const json& document, const JsonContext& context, const SceneDescription& known) {
  Head head;
  JsonContext own = context;
  own.warnings = &head.warnings;
  head.scene.file = context.file;
  head.scene.media.push_back(outer_vacuum());
  TextureLibrary textures(head.scene, &known.images);
  const auto find = [&](std::string_view key) -> std::optional<JsonValue> {
    const auto found = document.find(key);
    if (found == document.end()) return std::nullopt;
    return JsonObject::section("scene", key, *found, own);
  };
  head.names = read_surfaces(JsonValue(document, own), find, head.scene, textures);
  head.lacks_images = textures.lacks_images();
  return head;
}

bool displaces(const SceneDescription& scene) {
  return std::ranges::any_of(scene.materials,
                             [](const auto& material) { return material.displaced_by >= 0; });
}

bool is_halved(const ImageDescription& image) {
  return image.pixels.width != image.file_width || image.pixels.height != image.file_height;
}

/// Whether a texture of a model has one of the document's own images, because decode_images() merged them.
bool shares_images(const SceneDescription& scene, const SceneDescription& head) {
  return std::any_of(scene.textures.begin() + static_cast<std::ptrdiff_t>(head.textures.size()),
                     scene.textures.end(), [&](const TextureDescription& texture) {
                       return texture.image >= 0 && texture.image < std::ssize(head.images);
                     });
}

void shift(int& index, std::size_t from, std::size_t to) {
  if (index >= static_cast<int>(from)) index += static_cast<int>(to) - static_cast<int>(from);
}

/// Replaces the first `before` rows of `table` with `now`.
template <class Row>
void replace_head(std::vector<Row>& table, std::size_t before, std::vector<Row> now) {
  now.insert(now.end(), std::make_move_iterator(table.begin() + static_cast<std::ptrdiff_t>(before)),
             std::make_move_iterator(table.end()));
  table = std::move(now);
}

/// Adjusts the indices in rows after the document's own.
void shift_rest(SceneDescription& scene, const SceneDescription& from, const SceneDescription& to) {
  for (std::size_t i = from.textures.size(); i < scene.textures.size(); ++i) {
    shift(scene.textures[i].image, from.images.size(), to.images.size());
    for (int& other : scene.textures[i].of) shift(other, from.textures.size(), to.textures.size());
  }
  for (std::size_t i = from.materials.size(); i < scene.materials.size(); ++i) {
    MaterialDescription& material = scene.materials[i];
    shift(material.medium, from.media.size(), to.media.size());
#define SUNDOG_SHIFT_MAP(constant, name) \
  shift(material.textures.name, from.textures.size(), to.textures.size());
    MAP_SLOTS(SUNDOG_SHIFT_MAP)
#undef SUNDOG_SHIFT_MAP
  }
}

}  // namespace

Names surface_sections() { return sections; }

SurfaceNames read_surfaces(const JsonValue& root, const FindSection& find_own, SceneDescription& scene,
                           TextureLibrary& textures) {
  SurfaceNames names;
  const json with_presets = preset_sections(root.json(), root.context());
  const auto find = [&](std::string_view key) {
    const auto own = find_own(key);
    const auto found = with_presets.find(key);
    return found == with_presets.end() ? own : JsonObject::section("scene", key, *found, root.context());
  };
  if (const auto media = find("media"))
    for (const auto& [name, value] : media->members("media")) {
      names.media.emplace(name, static_cast<int>(scene.media.size()));
      const bool own = root.json().contains("media") && root.json()["media"].contains(name);
      // The medium inside a preset belongs to its material.
      const std::string place = own ? value.pointer() : join_pointer("/materials", name);
      scene.media.push_back(read_medium(JsonValue(value.json(), value.context(), place), name));
    }
  if (const auto world = find("world")) read_world(*world, names.media, scene);
  if (const auto named = find("textures")) {
    for (const auto& [name, value] : named->members("textures")) textures.read(value, name);
    textures.check_names();
  }
  if (const auto materials = find("materials"))
    for (const auto& [name, value] : materials->members("materials")) {
      names.materials.emplace(name, static_cast<int>(scene.materials.size()));
      scene.materials.push_back(read_material(value, name, names.media, scene.media, textures));
    }
  return names;
}

bool change_surfaces(SceneDescription& scene, const json& before, const json& after,
                     const JsonContext& context) {
  if (displaces(scene) || std::ranges::any_of(scene.images, is_halved)) return false;
  const Head from = read_head(before, context, scene);
  Head to = read_head(after, context, scene);
  if (from.lacks_images || to.lacks_images || from.warnings != to.warnings || displaces(to.scene))
    return false;
  if (from.names.materials != to.names.materials || shares_images(scene, from.scene)) return false;
  shift_rest(scene, from.scene, to.scene);
  replace_head(scene.media, from.scene.media.size(), std::move(to.scene.media));
  replace_head(scene.images, from.scene.images.size(), std::move(to.scene.images));
  replace_head(scene.textures, from.scene.textures.size(), std::move(to.scene.textures));
  replace_head(scene.materials, from.scene.materials.size(), std::move(to.scene.materials));
  scene.fog = to.scene.fog;
  return true;
}

}  // namespace sundog
