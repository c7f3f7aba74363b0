// The meshes and models that a scene places: each is read once and placed any number of times.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "models/model.h"
#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

class FrameCache;

/// An object's placement, combined from its groups' and its own.
struct Placement {
  dmat4 world_from_object{1};
  int material = -1;  // -1: the model's own
  std::string name, place;
  dvec3 moves_by{0};
  std::vector<TurnDescription> turns;
  bool turns_about_middle = false;  // the last turn, the object's own, is about its middle
};

class ModelLibrary {
 public:
  /// Adds to `scene`, which must outlive the library. Poses animated models at the time `seconds`; without
  /// it, they stand as written.
  explicit ModelLibrary(SceneDescription& scene, FrameCache* cache = nullptr,
                        std::optional<double> seconds = std::nullopt)
      : scene_(scene), cache_(cache), seconds_(seconds) {}

  /// A model in the scene's tables: objects in model space with the scene's indices.
  using Parts = std::vector<Object>;

  /// Adds a model; `name` prefixes the names of its materials and media.
  Parts add(Model model, const std::string& name);
  /// Adds the model file that `from` names, at the scene's time of its animation, unless it was added before.
  /// With `conserve`, its materials return no more light along paths than they receive. Throws like
  /// load_model().
  const Parts& load(JsonObject& object, const JsonValue& from, const std::filesystem::path& file,
                    const ModelOptions& options, bool conserve = false);
  /// Adds a model that was already read, for later load() calls with `conserve`.
  void keep(const std::filesystem::path& file, Model model);

  /// Adds each part of a model to the scene's objects.
  void place(const Parts& parts, const Placement& placement);

 private:
  int grey();

  Model read(const std::string& key, const std::filesystem::path& file, const ModelOptions& options,
             const std::string& place);

  SceneDescription& scene_;
  FrameCache* cache_;
  std::optional<double> seconds_;
  std::map<std::string, Model> kept_;  // by file
  std::map<std::tuple<std::string, std::optional<double>, std::string, bool, bool>, Parts> loaded_;
  int grey_ = -1;
};

}  // namespace sundog
