// Counts the parts of a scene description and of its compiled tables, as JSON.
#include "app/process/scene_figures.h"

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "compile/surfaces/texels.h"
#include "scene/kinds.h"

namespace sundog {
namespace {

using nlohmann::json;

/// The number of elements by name.
json count_names(const auto& list, const auto& name_of) {
  std::map<std::string, int> counts;
  for (const auto& each : list) ++counts[std::string(name_of(each))];
  return counts;
}

std::size_t placed_triangles(const SceneDescription& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects)
    if (const auto* shape = std::get_if<MeshShape>(&object.shape))
      count += scene.meshes[static_cast<std::size_t>(shape->mesh)].triangles.size();
  return count;
}

template <class T>
std::size_t bytes_of(const SharedTable<T>& table) {
  return table.size() * sizeof(T);
}

json bytes_by_kind(const CompiledScene& flat) {
  const std::size_t bvh = bytes_of(flat.nodes) + bytes_of(flat.blocks);
  const std::size_t shading = bytes_of(flat.triangles) + bytes_of(flat.vertices);
  const std::size_t total = table_bytes(flat);
  const std::size_t images =
      bytes_of(flat.texels0) + bytes_of(flat.texels1) + bytes_of(flat.texels2) + bytes_of(flat.texels3);
  return {{"bvh", bvh},
          {"shading", shading},
          {"images", images},
          {"tables", total - bvh - shading - images},
          {"total", total}};
}

json bounds(const CompiledScene& flat) {
  const Bounds& box = flat.figures.box;
  if (box.empty()) return nullptr;
  json corners[2];
  for (int axis = 0; axis < 3; ++axis) {
    corners[0].push_back(double(box.lower[axis]) + flat.origin[axis]);
    corners[1].push_back(double(box.upper[axis]) + flat.origin[axis]);
  }
  return {{"min", corners[0]}, {"max", corners[1]}};
}

/// The bounds of each distance field in world space: its interval, cut by its sphere.
json field_bounds(const SceneDescription& scene) {
  json list = json::array();
  for (const Object& object : scene.objects) {
    const auto* shape = std::get_if<FieldShape>(&object.shape);
    if (!shape) continue;
    const SdfDescription& field = scene.fields[static_cast<std::size_t>(shape->field)];
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (int corner = 0; corner < 8; ++corner) {
      glm::dvec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        double lower = field.lower[axis], upper = field.upper[axis];
        if (field.sphere) {
          lower = std::max(lower, (*field.sphere)[axis] - field.sphere->w);
          upper = std::min(upper, (*field.sphere)[axis] + field.sphere->w);
        }
        p[axis] = corner >> axis & 1 ? upper : lower;
      }
      const glm::dvec3 world(object.world_from_object * glm::dvec4(p, 1));
      low = glm::min(low, world);
      high = glm::max(high, world);
    }
    list.push_back({{"name", object.name.empty() ? field.name : object.name},
                    {"min", {low.x, low.y, low.z}},
                    {"max", {high.x, high.y, high.z}}});
  }
  return list;
}

/// The union of the box and the fields' bounds.
json whole_bounds(json box, const json& fields) {
  for (const json& field : fields)
    for (std::size_t axis = 0; axis < 3 && !box.is_null(); ++axis) {
      box["min"][axis] = std::min(box["min"][axis].get<double>(), field["min"][axis].get<double>());
      box["max"][axis] = std::max(box["max"][axis].get<double>(), field["max"][axis].get<double>());
    }
  if (!box.is_null() || fields.empty()) return box;
  return whole_bounds({{"min", fields[0]["min"]}, {"max", fields[0]["max"]}}, fields);
}

/// Each image with its size in the file and on a device, and its bytes there including mip levels.
json images(const SceneDescription& scene) {
  json list = json::array();
  for (const ImageDescription& image : scene.images)
    list.push_back({{"name", image.name},
                    {"width", image.pixels.width},
                    {"height", image.pixels.height},
                    {"file_width", image.file_width},
                    {"file_height", image.file_height},
                    {"use", image.srgb ? "color" : "data"},
                    {"bits", 8 * image.pixels.sample_bytes()},
                    {"channels", image.pixels.channels},
                    {"bytes", texel_bytes(image.pixels)}});
  return list;
}

json planes(const CompiledScene& flat) {
  return std::count_if(flat.instances.begin(), flat.instances.end(),
                       [](const Instance& instance) { return instance.shape == SHAPE_PLANE; });
}

}  // namespace

json scene_figures(const SceneDescription& scene, const CompiledScene& flat) {
  return {{"file", scene.file.string()},
          {"triangles", flat.figures.triangles},
          {"placed_triangles", placed_triangles(scene)},
          {"meshes", scene.meshes.size()},
          {"instances", flat.instances.size()},
          {"unbounded", planes(flat)},
          {"objects", count_names(scene.objects,
                                  [](const Object& object) { return shape_names[object.shape.index()]; })},
          {"lights", count_names(scene.lights,
                                 [](const LightDescription& light) { return facts_of(light.type).name; })},
          {"materials", scene.materials.size()},
          {"media", scene.media.size()},
          {"fields", scene.fields.size()},
          {"textures", scene.textures.size()},
          {"images", images(scene)},
          {"bvh",
           {{"nodes", flat.figures.nodes},
            {"blocks", flat.figures.blocks},
            {"mean_block_fill", flat.figures.mean_block_fill},
            {"sah_cost", flat.figures.sah_cost},
            {"sah_cost_unit",
             "nodes and blocks (or solids) that a ray through the scene's box visits, by surface area"},
            {"build_seconds", flat.figures.build_seconds},
            {"build_seconds_unit", "seconds on the wall's clock, of the whole compiled scene"}}},
          {"bytes", bytes_by_kind(flat)},
          {"field_bounds", field_bounds(scene)},
          {"bounds", whole_bounds(bounds(flat), field_bounds(scene))}};
}

}  // namespace sundog
