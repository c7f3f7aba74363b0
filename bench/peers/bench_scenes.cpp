// See bench_scenes.h.
#include "bench_scenes.h"

#include <nlohmann/json.hpp>

#include "models/model.h"
#include "scene/load.h"

namespace sundog {

SceneDescription scene_of_model(const std::string& path, bool spatial_splits) {
  if (path.ends_with(".json")) {
    SceneDescription scene = load_scene(path, {}, {.outside_files = true});
    if (spatial_splits) scene.render.spatial_splits = true;
    return scene;
  }
  Model model = load_model(path);
  SceneDescription scene;
  scene.file = path;
  scene.media.resize(1);
  scene.render.spatial_splits = spatial_splits;
  scene.materials = std::move(model.materials);
  scene.meshes = std::move(model.meshes);
  scene.objects = std::move(model.objects);
  return scene;
}

nlohmann::json to_json(const Spread& s) { return {{"median", s.median}, {"min", s.min}, {"max", s.max}}; }

}  // namespace sundog
