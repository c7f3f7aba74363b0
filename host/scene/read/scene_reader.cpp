// Reads the document's sections in order of dependency: media, textures, materials, meshes, objects.
#include "scene/read/scene_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/image_io.h"
#include "base/input.h"
#include "scene/animate.h"
#include "scene/bounds.h"
#include "scene/dark_world.h"
#include "scene/decode_images.h"
#include "scene/displace.h"
#include "scene/integrators.h"
#include "scene/json/parse.h"
#include "scene/lamps.h"
#include "scene/light_groups.h"
#include "scene/materials/presets.h"
#include "scene/procedural/procedural.h"
#include "scene/read/fields.h"
#include "scene/read/focus.h"
#include "scene/read/frame_cache.h"
#include "scene/read/library.h"
#include "scene/read/motion.h"
#include "scene/read/parts.h"
#include "scene/read/scatter.h"
#include "scene/read/surfaces.h"
#include "scene/read/textures.h"
#include "scene/read/tracks.h"

namespace sundog {
namespace fs = std::filesystem;

namespace {

class SceneReader {
 public:
  SceneReader(const JsonValue& root, std::optional<Model> known, const NamedMeshes& made)
      : root_(root), made_(made), library_(scene_, cache(), root.context().seconds) {
    scene_.file = root.context().file;
    scene_.media.push_back(outer_vacuum());
    if (known) library_.keep(scene_.file, std::move(*known));
  }

  SceneDescription read() {
    root_.object("scene", [&](JsonObject& object) { read_root(object); });
    decode_images(scene_, cache());
    if (!cache() || !cache()->checks()) displace_meshes(scene_);
    return std::move(scene_);
  }

 private:
  void read_root(JsonObject& object) {
    object.check("$schema");
    const auto animate = object.find("animate");
    if (animate) read_tracks(*animate);  // only a check: animate.cpp has already applied them
    object.read("frames_per_second", scene_.frames_per_second, "unit", scene_.unit);
    const auto find = [&](std::string_view key) { return object.find(key); };
    const bool placed = read_view_sections(find, scene_);
    if (const auto environment = object.find("environment"))
      scene_.environment =
          read_environment(*environment, [&](const JsonValue& file) { return read_picture(file); });
    read_tables(object, find);
    for (const JsonValue& item : object.at("objects").items("objects")) read_object(item, Placement{});
    if (const bool* plays = root_.context().plays) scene_.plays = scene_.plays || *plays;
    if (root_.context().seconds && !animate && !scene_.plays)
      root_.member("animate", "an array of tracks: what the frames change");
    if (!placed)
      scene_.camera = frame(bounds_of(scene_.objects, scene_.meshes, scene_.fields),
                            static_cast<double>(scene_.image.width) / scene_.image.height, scene_.camera);
    if (!scene_.camera.lens.focus_on.empty()) focus_on_object(scene_, in_focus_);
    check_light_groups(scene_, root_);
    add_lamps(scene_);
    warn_of_dark_world(scene_);
  }

  void read_tables(JsonObject& object, const FindSection& find) {
    names_ = read_surfaces(root_, find, scene_, textures_);
    mesh_table_ = object.find("meshes");
    if (mesh_table_)
      for (const auto& [name, value] : mesh_table_->members("meshes"))
        meshes_.emplace(name, read_mesh(value, name, *mesh_table_));
    add_made_meshes();
    if (const auto fields = object.find("fields"))
      for (const auto& [name, value] : fields->members("fields")) {
        fields_.emplace(name, static_cast<int>(scene_.fields.size()));
        scene_.fields.push_back(read_named_field(value, name));
      }
  }

  static fs::path find_model(const JsonValue& value) {
    fs::path file = find_file(value);
    if (!is_model_file(file)) value.wanted("a model file (" SUNDOG_MODEL_EXTENSIONS ", each also .gz)");
    return file;
  }

  FrameCache* cache() const { return root_.context().cache; }

  Image read_picture(const JsonValue& value) const {
    const fs::path file = find_file(value);
    const auto read = [&] { return read_finite(file); };
    return cache() ? cache()->picture(file.string(), read) : read();
  }

  /// Reads an image file whose pixels must be finite.
  static Image read_finite(const fs::path& file) {
    Image image = read_image(file);
    for (std::size_t i = 0; i < image.data.size(); ++i)
      if (!std::isfinite(image.data[i])) {
        const auto pixel = i / static_cast<std::size_t>(image.channels);
        const auto width = static_cast<std::size_t>(image.width);
        throw SceneError(file.string(), "",
                         fmt::format("the pixel ({}, {}) is not finite; wanted a picture of finite light",
                                     pixel % width, pixel / width));
      }
    return image;
  }

  ModelOptions model_options() const {
    return {.outside_files = root_.context().outside_files,
            .for_paths = integrator_of(scene_.render.integrator).own_materials};
  }

  ModelLibrary::Parts read_mesh(const JsonValue& value, const std::string& name, const JsonValue& meshes) {
    return value.object("mesh", [&](JsonObject& object) {
      const std::string source = object.one_of();
      const JsonValue from = *object.find(source);
      if (source == "file") {
        const fs::path file = find_model(from);
        ModelOptions options = model_options();
        object.read("crease_angle", options.crease_angle);
        return library_.load(object, from, file, options);
      }
      const auto generate = [&] {
        return model_of(
            generate_mesh(from, meshes, [&](const JsonValue& picture) { return read_picture(picture); }),
            name);
      };
      if (!cache()) return library_.add(generate(), name);
      if (cache()->checks()) check_recipe(from, meshes);
      return library_.add(cache()->model(recipe_key(from, meshes), from.pointer(), generate), name);
    });
  }

  static Model model_of(Mesh mesh, const std::string& name) {
    Model made;
    made.meshes.push_back(std::move(mesh));
    made.meshes.back().name = name;
    made.objects.emplace_back().shape = MeshShape{0};
    return made;
  }

  void add_made_meshes() {
    for (const auto& [name, mesh] : made_) {
      if (meshes_.contains(name))
        throw SceneError(scene_.file.string(), join_pointer("/meshes", name),
                         "the program has made a mesh of that name too; wanted two names");
      meshes_.emplace(name, library_.add(model_of(*mesh, name), name));
    }
  }

  int add_field(JsonObject& object, const std::string& type) {
    scene_.fields.push_back(read_field(object, type));
    return static_cast<int>(scene_.fields.size()) - 1;
  }

  void read_object(const JsonValue& value, const Placement& parent) {
    const std::string type = value.type(), &wanted = scene_.camera.lens.focus_on;
    const std::size_t first = scene_.objects.size();
    value.object("object", [&](JsonObject& object) {
      const Placement placement = read_placement(object, parent);
      if (type == "group") {
        for (const JsonValue& item : object.at("objects").items("objects")) read_object(item, placement);
      } else if (type == "scatter") {
        read_scatter(object, placement);
      } else if (type == "mesh") {
        const JsonValue name = object.at("mesh");
        library_.place(find_mesh(name), placement);
      } else if (type == "model") {
        const JsonValue file = object.at("file");
        bool conserve = false;
        object.read("conserve", conserve);
        library_.place(library_.load(object, file, find_model(file), model_options(), conserve), placement);
      } else if (type == "field") {
        place_field(object, find_name(object.at("field"), fields_, "field"), placement);
      } else if (std::ranges::find(field_types(), type) != field_types().end()) {
        place_field(object, add_field(object, type), placement);
      } else {
        place_solid(object, type, placement);
      }
    });
    if (const auto name = value.json().find("name"); !wanted.empty() && name != value.json().end())
      if (*name == wanted)
        in_focus_.insert(in_focus_.end(), scene_.objects.begin() + std::ptrdiff_t(first),
                         scene_.objects.end());
  }

  /// Reads each of the objects once and scatters copies.
  void read_scatter(JsonObject& object, const Placement& placement) {
    const auto [how, limit] = read_scatter_keys(object);
    std::vector<Ground> grounds;
    for (const Object& part : find_mesh(object.at("on")))
      if (const auto* mesh = std::get_if<MeshShape>(&part.shape))
        grounds.push_back({scene_.meshes[static_cast<std::size_t>(mesh->mesh)], part.world_from_object});
    const std::size_t first = scene_.objects.size();
    std::vector<std::vector<Object>> kinds;
    Placement at_origin = placement;
    at_origin.world_from_object = dmat4(1);
    for (const JsonValue& item : object.at("objects").items("objects")) {
      read_object(item, at_origin);
      kinds.emplace_back(scene_.objects.begin() + std::ptrdiff_t(first), scene_.objects.end());
      scene_.objects.erase(scene_.objects.begin() + std::ptrdiff_t(first), scene_.objects.end());
    }
    double wanted = 0;
    const std::vector<ScatteredPlace> places = scatter(how, grounds, limit, wanted);
    if (wanted > static_cast<double>(limit))
      object.value().fail(
          fmt::format("wanted at most the \"limit\" of {} copies, found {:.0f}: lower the "
                      "\"density\" or raise the \"limit\"",
                      limit, wanted));
    for (const ScatteredPlace& place : places)
      add_copies(kinds[static_cast<std::size_t>(place.index * static_cast<double>(kinds.size()))],
                 placement.world_from_object * place.place, object.value(), scene_);
  }

  const ModelLibrary::Parts& find_mesh(const JsonValue& name) const {
    NameTable names;
    for (const auto& [key, parts] : meshes_) names.emplace(key, 0);
    find_name(name, names, "mesh");
    return meshes_.find(name.text())->second;
  }

  Placement read_placement(JsonObject& object, const Placement& parent) {
    Placement placement = parent;
    placement.place = object.value().pointer();
    object.read("name", placement.name);
    if (const auto material = object.find("material"))
      placement.material = find_name(*material, names_.materials, "material");
    if (const auto transform = object.find("transform")) {
      placement.world_from_object = parent.world_from_object * read_transform(*transform);
      check_transform(placement.world_from_object, *transform);
    }
    read_motion(object, parent.world_from_object, placement);
    return placement;
  }

  void place_solid(JsonObject& object, const std::string& type, const Placement& placement) {
    if (placement.material < 0) object.at("material", "the name of a material, here or in a group around it");
    const PlacedShape solid = read_solid(object, type, mesh_table_ ? &*mesh_table_ : nullptr);
    Placement placed = placement;
    placed.world_from_object = placement.world_from_object * solid.placed;
    turn_about_middle(placed.world_from_object, placed);
    add_object(solid.shape, placed);
    check_transform(scene_.objects.back().world_from_object, object.value());
  }

  void place_field(JsonObject& object, int field, const Placement& placement) {
    if (placement.material < 0) object.at("material", "the name of a material, here or in a group around it");
    add_object(FieldShape{field}, placement);
  }

  void add_object(const Shape& shape, const Placement& placement) {
    scene_.objects.push_back({placement.name, shape, placement.material, placement.world_from_object,
                              placement.place, -1, placement.moves_by, placement.turns});
  }

  const JsonValue& root_;
  const NamedMeshes& made_;
  SceneDescription scene_;
  ModelLibrary library_;
  TextureLibrary textures_{scene_};
  SurfaceNames names_;
  NameTable fields_;
  std::vector<Object> in_focus_;  // the objects under the name on which the camera focuses
  std::optional<JsonValue> mesh_table_;
  std::map<std::string, ModelLibrary::Parts, std::less<>> meshes_;
};

}  // namespace

fs::path find_file(const JsonValue& value) {
  const fs::path &scene = value.context().file, file = scene.parent_path() / value.text();
  if (file != scene && !value.context().outside_files && leads_outside(scene, file))
    value.fail(fmt::format("\"{}\" leads out of the scene's folder: {}", value.text(), outside_hint),
               Remedy::outside_files);
  require_readable(file, scene, value.pointer());
  return file;
}

SceneDescription read_scene(const JsonValue& root, std::optional<Model> known, const NamedMeshes& made) {
  return SceneReader(root, std::move(known), made).read();
}

}  // namespace sundog
