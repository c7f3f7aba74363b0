// Measures the depth of the middle of the named objects' bounding box.
#include "scene/read/focus.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/names.h"
#include "scene/bounds.h"

namespace sundog {
namespace {

[[noreturn]] void fail(const SceneDescription& scene, const std::string& what) {
  throw SceneError(scene.file.string(), "/camera/lens/focus_on", what);
}

std::vector<Object> objects_of_name(const SceneDescription& scene, const std::string& name) {
  std::vector<Object> found;
  std::ranges::copy_if(scene.objects, std::back_inserter(found),
                       [&](const Object& o) { return o.name == name; });
  return found;
}

std::vector<std::string> names_of_objects(const SceneDescription& scene) {
  std::vector<std::string> names;
  for (const Object& object : scene.objects)
    if (!object.name.empty()) names.push_back(object.name);
  return names;
}

}  // namespace

void focus_on_object(SceneDescription& scene, std::span<const Object> objects) {
  const std::string& name = scene.camera.lens.focus_on;
  const std::vector<Object> of_models =
      objects.empty() ? objects_of_name(scene, name) : std::vector<Object>();
  if (objects.empty()) objects = of_models;
  if (objects.empty())
    fail(scene, fmt::format("no object has the name \"{}\": {}", name,
                            did_you_mean(name, names_of_objects(scene), "give one that \"name\"")));
  const SceneBounds bounds = bounds_of(objects, scene.meshes, scene.fields);
  if (bounds.empty()) fail(scene, fmt::format("\"{}\" has no end: name an object that has", name));
  scene.camera.lens.focus_point = (bounds.lower + bounds.upper) * 0.5;
  focus_on_point(scene);
}

void focus_on_point(SceneDescription& scene) {
  Camera& camera = scene.camera;
  const dvec3 view = glm::normalize(camera.target - camera.position);
  const double depth = glm::dot(camera.lens.focus_point - camera.position, view);
  if (!(depth >= 1e-9))
    fail(scene, fmt::format("\"{}\" is behind the camera: name an object before it", camera.lens.focus_on));
  camera.lens.focus = depth;
}

}  // namespace sundog
