// load_model(): selects the format's reader, moves far meshes near their origin, and checks the extent.
#include "models/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "models/far_mesh.h"
#include "models/readers.h"

namespace sundog {
namespace models {

void add_mesh(Model& model, Mesh mesh, const dvec3& origin) {
  if (mesh.triangles.empty()) return;
  Object object;
  object.name = mesh.name;
  object.shape = MeshShape{static_cast<int>(model.meshes.size())};
  object.world_from_object = glm::translate(dmat4(1), origin);
  model.objects.push_back(std::move(object));
  model.meshes.push_back(std::move(mesh));
}

void leave_unread(Model& model, const std::string& feature) {
  constexpr std::size_t most = 100;  // a file may use any number of unknown extensions
  const bool known = std::ranges::count(model.unread, feature) > 0;
  if (!known && model.unread.size() < most) model.unread.push_back(feature);
}

float linear_from_srgb(double value) {
  return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}

}  // namespace models

namespace {

/// "read without its skins, animations and 3 more features"
std::string unread_text(const std::vector<std::string>& features) {
  constexpr std::size_t shown = 8;
  std::string text = "read without its ";
  for (std::size_t i = 0; i < std::min(features.size(), shown); ++i) {
    const bool last = i > 0 && i + 1 == features.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + features[i];
  }
  const std::size_t rest = features.size() - std::min(features.size(), shown);
  return rest == 0 ? text : fmt::format("{} and {} more feature{}", text, rest, rest == 1 ? "" : "s");
}

struct Reader {
  std::string_view extension;
  Model (*load)(models::Source source, const ModelOptions& options);
};
#define SUNDOG_READER(extension, reader) {extension, models::load_##reader},
constexpr Reader readers[] = {SUNDOG_MODEL_FORMATS(SUNDOG_READER, SUNDOG_READER)};
#undef SUNDOG_READER

Model load(models::Source source, const std::string& extension, const ModelOptions& options) {
  if (source.bytes.empty()) models::fail(source, "", "the file is empty");
  return std::ranges::find(readers, extension, &Reader::extension)->load(std::move(source), options);
}

/// Beyond this, the camera's position cannot be written, and squares overflow.
constexpr double farthest = 1e17;

bool is_near(const dmat4& world_from_object, const glm::vec3& point) {
  const dvec3 at(world_from_object * glm::dvec4(point, 1));
  return std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <= farthest;  // false for NaN
}

/// Whether the box around all vertices, used or not, is near.
bool has_near_box(const dmat4& world_from_object, const Mesh& mesh) {
  constexpr float most = std::numeric_limits<float>::max();
  glm::vec3 box[2] = {glm::vec3(most), glm::vec3(-most)};
  for (const glm::vec3& p : mesh.positions) box[0] = glm::min(box[0], p), box[1] = glm::max(box[1], p);
  for (int i = 0; i < 8; ++i)
    if (!is_near(world_from_object, {box[i & 1].x, box[i >> 1 & 1].y, box[i >> 2].z})) return false;
  return true;
}

void check_extent(const std::filesystem::path& path, const Model& model) {
  for (const Object& object : model.objects) {
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    if (!shape) continue;
    const Mesh& mesh = model.meshes[static_cast<std::size_t>(shape->mesh)];
    if (has_near_box(object.world_from_object, mesh)) continue;
    for (const glm::uvec3& triangle : mesh.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& point = mesh.positions[triangle[corner]];
        if (is_near(object.world_from_object, point)) continue;
        const dvec3 at(object.world_from_object * glm::dvec4(point, 1));
        throw SceneError(
            path.string(), "",
            fmt::format("{} has a vertex at {:.3g}, {:.3g}, {:.3g}; coordinates up to {:g} are read",
                        mesh.name.empty() ? "a mesh" : fmt::format("the mesh '{}'", mesh.name), at.x, at.y,
                        at.z, farthest));
      }
  }
}

bool has_area(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::vec3& v0 = mesh.positions[triangle.x];
  return glm::cross(mesh.positions[triangle.y] - v0, mesh.positions[triangle.z] - v0) != glm::vec3(0);
}

void warn_of_unseen(Model& model) {
  const auto unseen = std::ranges::count_if(model.meshes, [](const Mesh& mesh) {
    return std::ranges::none_of(mesh.triangles,
                                [&](const auto& triangle) { return has_area(mesh, triangle); });
  });
  if (unseen == 0) return;
  model.warnings.push_back(fmt::format("{} of its {} mesh{} cannot be seen: no triangle there has an area",
                                       unseen, model.meshes.size(), model.meshes.size() == 1 ? "" : "es"));
}

}  // namespace

bool is_model_file(const std::filesystem::path& path) {
  const std::string extension = models::model_extension(path);
  return std::ranges::count(readers, extension, &Reader::extension) > 0;
}

Model load_model(const std::filesystem::path& path, const ModelOptions& options) {
  if (!is_model_file(path))
    throw SceneError(path.string(), "",
                     "not a model file: the name must end in one of " SUNDOG_MODEL_EXTENSIONS
                     " (or that and .gz)");
  try {
    models::Source source = models::read_source(path);
    source.outside_files = options.outside_files;
    Model model = load(std::move(source), models::model_extension(path), options);
    model.for_paths = options.for_paths.value_or(model.for_paths && model.lights.empty());
    models::bring_near(model);
    check_extent(path, model);
    warn_of_unseen(model);
    if (model.dropped_polygons > 0)
      model.warnings.push_back(fmt::format("{} face{} of one or two corners {} left out",
                                           model.dropped_polygons, model.dropped_polygons == 1 ? "" : "s",
                                           model.dropped_polygons == 1 ? "is" : "are"));
    if (!model.unread.empty()) model.warnings.push_back(unread_text(model.unread));
    return model;
  } catch (const std::length_error& error) {
    throw SceneError(path.string(), "", std::string("the model is too large: ") + error.what());
  } catch (const std::bad_alloc&) {
    throw SceneError(path.string(), "", "the model does not fit into memory");
  }
}

Model posed(Model model, const std::filesystem::path& path, const Playing& playing) {
  model.pose(playing, model);
  models::bring_near(model);
  check_extent(path, model);
  return model;
}

}  // namespace sundog
