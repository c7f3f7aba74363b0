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

/// Where an object stands: what it takes from its groups and from itself.
struct Placement {
  dmat4 world_from_object{1};
  int material = -1;  // -1: the model's own
  std::string name, place;
  dvec3 moves_by{0};
  std::vector<TurnDescription> turns;
  bool turns_about_middle = false;  // the last turn, its own, is about its middle
};

class ModelLibrary {
 public:
  /// Adds to `scene`, which must outlive the library.
  /// At that time of the scene; without one, models stand as they are written.
  explicit ModelLibrary(SceneDescription& scene, FrameCache* cache = nullptr,
                        std::optional<double> seconds = std::nullopt)
      : scene_(scene), cache_(cache), seconds_(seconds) {}

  /// A model in the scene's tables: objects with the scene's indices, in model space.
  using Parts = std::vector<Object>;

  /// Adds a model; `name` prefixes its materials' and media's names.
  Parts add(Model model, const std::string& name);
  /// Adds what the object names: the model file at `from`, with its animations at the scene's time, or what
  /// was added before. If asked to `conserve`, its materials return no more light along paths than they get.
  /// Throws what load_model() throws.
  const Parts& load(JsonObject& object, const JsonValue& from, const std::filesystem::path& file,
                    const ModelOptions& options, bool conserve = false);
  /// Adds a model that has been read already, for load() that is to `conserve`.
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
