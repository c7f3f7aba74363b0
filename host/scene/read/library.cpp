// Reads each file once, shifts its indices to the scene's, and places copies.
#include "scene/read/library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/materials/conserve_light.h"
#include "scene/read/frame_cache.h"

namespace sundog {
namespace fs = std::filesystem;

namespace {

template <class Value>
void append(std::vector<Value>& to, std::vector<Value>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

void shift(int& index, int by) {
  if (index >= 0) index += by;
}

void shift_textures(MaterialDescription& material, int by) {
#define SUNDOG_SHIFT_MAP(constant, name) shift(material.textures.name, by);
  MAP_SLOTS(SUNDOG_SHIFT_MAP)
#undef SUNDOG_SHIFT_MAP
  shift(material.displaced_by, by);
}

/// A key that is equal for all paths to the same file.
std::string file_key(const fs::path& file) {
  std::error_code ignored;
  const fs::path canonical = fs::weakly_canonical(file, ignored);
  return (ignored ? file : canonical).string();
}

}  // namespace

ModelLibrary::Parts ModelLibrary::add(Model model, const std::string& name) {
  const int first_mesh = static_cast<int>(scene_.meshes.size());
  const int first_material = static_cast<int>(scene_.materials.size());
  const int first_medium = static_cast<int>(scene_.media.size());
  for (MediumDescription& medium : model.media) medium.name = fmt::format("{}: {}", name, medium.name);
  for (MaterialDescription& material : model.materials) {
    material.name = fmt::format("{}: {}", name, material.name);
    if (material.medium >= 0) material.medium += first_medium;
  }
  for (Mesh& mesh : model.meshes)
    for (int& material : mesh.materials) material += first_material;
  for (const std::string& warning : model.warnings)
    scene_.warnings.push_back(fmt::format("{}: {}", name, warning));
  if (model.objects.empty()) scene_.warnings.push_back(fmt::format("{}: holds no surfaces", name));
  const int first_texture = static_cast<int>(scene_.textures.size());
  const int first_image = static_cast<int>(scene_.images.size());
  for (TextureDescription& texture : model.textures) {
    shift(texture.image, first_image);
    for (int& other : texture.of) shift(other, first_texture);
  }
  for (MaterialDescription& material : model.materials) shift_textures(material, first_texture);
  append(scene_.images, model.images);
  append(scene_.textures, model.textures);
  append(scene_.media, model.media);
  append(scene_.materials, model.materials);
  append(scene_.meshes, model.meshes);
  for (Object& object : model.objects) {
    auto* mesh = std::get_if<MeshShape>(&object.shape);
    if (mesh) mesh->mesh += first_mesh;
    if (object.material >= 0)
      object.material += first_material;
    else if (!mesh || scene_.meshes[static_cast<std::size_t>(mesh->mesh)].materials.empty())
      object.material = grey();
  }
  return std::move(model.objects);
}

Model ModelLibrary::read(const std::string& key, const fs::path& file, const ModelOptions& options,
                         const std::string& place) {
  if (const auto kept = kept_.find(key); kept != kept_.end() && !options.crease_angle) return kept->second;
  const auto read = [&] { return load_model(file, options); };
  if (!cache_) return read();
  return cache_->model(
      fmt::format("{} {} {}", key, options.crease_angle.value_or(-1), options.for_paths.value_or(true)),
      place, read);
}

const ModelLibrary::Parts& ModelLibrary::load(JsonObject& object, const JsonValue& from, const fs::path& file,
                                              const ModelOptions& options, bool conserve) {
  Playing playing;
  object.read("animation", playing.animation, "cycle", playing.cycle);
  const auto name = object.find("animation"), cycle = object.find("cycle");
  const std::tuple key(file_key(file), options.crease_angle, playing.animation, playing.cycle, conserve);
  if (const auto found = loaded_.find(key); found != loaded_.end()) return found->second;
  Model model = read(std::get<0>(key), file, options, from.pointer());
  if (conserve && model.for_paths) std::ranges::for_each(model.materials, conserve_light);
  const std::vector<std::string>& known = model.animations;
  if (const auto& asked = name ? name : cycle; asked && known.empty() && (name || playing.cycle))
    asked->fail(fmt::format("{} has no animations", file.filename().string()));
  if (name && std::ranges::count(known, playing.animation) == 0)
    name->wanted(fmt::format("an animation of {}: {}", file.filename().string(), fmt::join(known, ", ")));
  scene_.has_models = true;
  if (model.pose) scene_.plays = true;
  if (model.pose && seconds_) {
    playing.seconds = *seconds_;
    model = posed(std::move(model), file, playing);
  }
  return loaded_.emplace(key, add(std::move(model), file.filename().string())).first->second;
}

void ModelLibrary::keep(const fs::path& file, Model model) {
  scene_.has_models = true;
  const std::string key = file_key(file);
  if (model.pose) {
    kept_.emplace(key, std::move(model));
    return;
  }
  if (model.for_paths) std::ranges::for_each(model.materials, conserve_light);
  loaded_.emplace(std::tuple(key, std::nullopt, "", false, true),
                  add(std::move(model), file.filename().string()));
}

void ModelLibrary::place(const Parts& parts, const Placement& placement) {
  for (Object part : parts) {
    part.world_from_object = placement.world_from_object * part.world_from_object;
    if (placement.material >= 0) part.material = placement.material;
    if (part.name.empty())
      part.name = placement.name;
    else if (!placement.name.empty())
      part.name = fmt::format("{}: {}", placement.name, part.name);
    part.place = placement.place;
    part.moves_by = placement.moves_by;
    part.turns = placement.turns;
    scene_.objects.push_back(std::move(part));
  }
}

int ModelLibrary::grey() {
  if (grey_ < 0) {
    grey_ = static_cast<int>(scene_.materials.size());
    scene_.materials.push_back({.name = "grey"});
  }
  return grey_;
}

}  // namespace sundog
