// The optional assets' model files: all load, with the triangles that their manifest names and the bounds
// that they state.
#include <fstream>
#include <nlohmann/json.hpp>

#include "assets.h"
#include "catch.h"
#include "model_files.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

struct Box {
  dvec3 lower{1e300}, upper{-1e300};
  void add(dvec3 p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
};

std::size_t triangles_in(const Model& model) {
  std::size_t sum = 0;
  for (const Mesh& mesh : model.meshes) sum += mesh.triangles.size();
  return sum;
}

Box bounds_of(const Model& model) {
  Box box;
  for (const Mesh& mesh : model.meshes)
    for (const glm::vec3& p : mesh.positions) box.add(p);
  return box;
}

// The bounds that a .gltf states: the min and max of its POSITION accessors.
Box stated_bounds(const fs::path& path) {
  std::ifstream in(path);
  const auto json = nlohmann::json::parse(in);
  Box box;
  for (const auto& mesh : json.at("meshes"))
    for (const auto& primitive : mesh.at("primitives")) {
      const auto accessor =
          json.at("accessors").at(primitive.at("attributes").at("POSITION").get<std::size_t>());
      for (const char* end : {"min", "max"})
        box.add({accessor.at(end).at(0), accessor.at(end).at(1), accessor.at(end).at(2)});
    }
  return box;
}

void check_sound(const Model& model) {
  for (const Mesh& mesh : model.meshes) {
    CHECK((mesh.normals.empty() || mesh.normals.size() == mesh.positions.size()));
    CHECK((mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size()));
    CHECK((mesh.colors.empty() || mesh.colors.size() == mesh.positions.size()));
    CHECK((mesh.materials.empty() || mesh.materials.size() == mesh.triangles.size()));
    bool inside = true, unit = true;
    for (const glm::uvec3 t : mesh.triangles)
      inside = inside && glm::max(t.x, glm::max(t.y, t.z)) < mesh.positions.size();
    for (const int m : mesh.materials)
      inside = inside && m >= 0 && static_cast<std::size_t>(m) < model.materials.size();
    for (const glm::vec3& n : mesh.normals) unit = unit && std::abs(glm::length(n) - 1) < 1e-5f;
    CHECK(inside);
    CHECK(unit);
  }
  for (const MaterialDescription& m : model.materials) CHECK(m.medium < static_cast<int>(model.media.size()));
}

}  // namespace

TEST_CASE("the glTF models have the triangles of their manifest", "[assets]") {
  if (assets_directory().empty()) return;
  const std::pair<const char*, std::size_t> counts[] = {
      {"01_alpha_mask/01_alpha_mask.gltf", 2},
      {"02_node_hierarchy/02_node_hierarchy.gltf", 60},
      {"02_shared_mesh/02_shared_mesh.gltf", 12},
      {"02_suzanne/02_suzanne.gltf", 3936},
      {"04_lights/04_lights.gltf", 2},
      {"09_texture_transform/09_texture_transform.gltf", 2},
      {"10_custom_normals/10_custom_normals.gltf", 88},
      {"15_transmission/15_transmission.gltf", 4800},
      {"17_ior/17_ior.gltf", 60},
      {"24_gpu_instancing/24_gpu_instancing.gltf", 4034},
      {"Box/Box.gltf", 12},
      {"Box/Box.glb", 12},
      {"Box/Box-embedded.gltf", 12},
      {"BoxInterleaved.glb", 12},
      {"BoxTextured/BoxTextured.gltf", 12},
      {"BoxVertexColors.glb", 12},
      {"Duck.glb", 4212},
      {"OrientationTest.glb", 524},
      {"SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf", 12},
      {"TextureSettingsTest/TextureSettingsTest.gltf", 72},
      {"living_room.glb", 5088},
      {"plastic_monobloc_chair/plastic_monobloc_chair_01_1k.gltf", 3356},
      {"zdm2.glb", 58772}};
  for (const auto& [name, count] : counts) {
    INFO(name);
    CHECK(triangles_in(load_model(assets_directory() / "gltf" / name)) == count);
  }
}

TEST_CASE("all glTF models load soundly, within the bounds that they state", "[assets]") {
  if (assets_directory().empty()) return;
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(assets_directory() / "gltf")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".gltf" && extension != ".glb") continue;
    INFO(entry.path());
    const Model model = load_model(entry.path());
    check_sound(model);
    ++files;
    if (model.meshes.empty() || extension == ".glb") continue;
    const Box found = bounds_of(model), stated = stated_bounds(entry.path());
    if (entry.path().stem() == "SimpleSparseAccessor")
      continue;  // states them before some points are replaced
    CHECK(glm::length(found.lower - stated.lower) < 1e-5);
    CHECK(glm::length(found.upper - stated.upper) < 1e-5);
  }
  CHECK(files >= 45);
}

TEST_CASE("the box is the same however its glTF stores it", "[assets]") {
  if (assets_directory().empty()) return;
  const Mesh first = load_model(assets_directory() / "gltf/Box/Box.gltf").meshes.at(0);
  for (const char* other : {"Box/Box.glb", "Box/Box-embedded.gltf", "BoxInterleaved.glb"}) {
    INFO(other);
    const Mesh mesh = load_model(assets_directory() / "gltf" / other).meshes.at(0);
    CHECK(mesh.positions == first.positions);
    CHECK(mesh.normals == first.normals);
    CHECK(mesh.triangles == first.triangles);
  }
}

TEST_CASE("instances, materials and cameras of real glTF files arrive", "[assets]") {
  if (assets_directory().empty()) return;
  const fs::path folder = assets_directory() / "gltf";
  const Model instanced = load_model(folder / "24_gpu_instancing/24_gpu_instancing.gltf");
  CHECK(instanced.meshes.size() == 2);
  CHECK(instanced.objects.size() > 1000);
  CHECK(load_model(folder / "02_shared_mesh/02_shared_mesh.gltf").objects.size() == 2);
  CHECK(load_model(folder / "Duck.glb").camera.has_value());
  CHECK(load_model(folder / "BoxVertexColors.glb").materials.at(0).vertex_color);
  const Model glass = load_model(folder / "17_ior/17_ior.gltf");
  CHECK(std::any_of(glass.materials.begin(), glass.materials.end(),
                    [](const MaterialDescription& m) { return m.transmission != dvec3(0); }));
}

TEST_CASE("all OBJ and PLY feature files load soundly", "[assets]") {
  if (assets_directory().empty()) return;
  std::size_t files = 0;
  for (const char* folder : {"obj_features", "ply_features", "meshes", "scenes"})
    for (const auto& entry : fs::recursive_directory_iterator(assets_directory() / folder)) {
      if (!entry.is_regular_file() || !is_model_file(entry.path())) continue;
      INFO(entry.path());
      check_sound(load_model(entry.path()));
      ++files;
    }
  CHECK(files >= 65);
}

TEST_CASE("OBJ feature files have their faces, materials and colours", "[assets]") {
  if (assets_directory().empty()) return;
  const fs::path folder = assets_directory() / "obj_features";
  const Model concave = load_model(folder / "obj2gltf/concave/concave.obj");
  CHECK(triangles_in(concave) == 16);
  CHECK(area_of(concave.meshes.at(0)) ==
        Approx(2 * 3.12164 + 0.727044 * (2 + 2 + 2 + 2 * 1.33094)).epsilon(1e-3));
  CHECK(load_model(folder / "obj2gltf/box-mtllib-spaces/box mtllib.obj").materials.size() == 3);
  const Model windows = load_model(folder / "obj2gltf/box-windows-paths/box-windows-paths.obj");
  CHECK(windows.warnings.empty());
  CHECK(windows.images.size() == 1);
  const Model clear = load_model(folder / "obj2gltf/box-transparent/box-transparent.obj");
  CHECK(clear.materials.at(0).transmission == dvec3(1));
  const Model rgb = load_model(assets_directory() / "ply_features/online3dviewer/cube_rgb_binary.ply");
  CHECK(rgb.materials.at(0).vertex_color);
  CHECK(rgb.meshes.at(0).source_vertex_count == 8);
}
