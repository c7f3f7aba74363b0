// The meshes and models that a scene places: each is read once and placed any number of times.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/description.h"
#include "scene/model.h"

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
  explicit ModelLibrary(SceneDescription& scene, FrameCache* cache = nullptr)
      : scene_(scene), cache_(cache) {}

  /// A model in the scene's tables: objects with the scene's indices, in model space.
  using Parts = std::vector<Object>;

  /// Adds a model; `name` prefixes its materials' and media's names.
  Parts add(Model model, const std::string& name);
  /// Reads and adds a model file, or finds what was added before. `place` names it. Throws what load_model()
  /// throws.
  const Parts& load(const std::filesystem::path& file, const ModelOptions& options, const std::string& place);
  /// Adds a model that has been read already, for load() to find.
  void keep(const std::filesystem::path& file, Model model);

  /// Adds each part of a model to the scene's objects.
  void place(const Parts& parts, const Placement& placement);

 private:
  int grey();

  SceneDescription& scene_;
  FrameCache* cache_;
  std::map<std::pair<std::string, std::optional<double>>, Parts> loaded_;
  int grey_ = -1;
};

}  // namespace sundog
