// Models: what a mesh file holds, before it is placed in a scene.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// A model file's content. Indices (mesh, material, medium) are local to it: MeshShape::mesh into `meshes`, and so on;
/// media have no world entry (index 0 is the first medium). Objects hold the node transforms (instances share a mesh).
struct Model {
  std::vector<Mesh> meshes;
  std::vector<MaterialDescription> materials;
  std::vector<MediumDescription> media;
  std::vector<Object> objects;
  std::vector<LightDescription> lights;
  std::optional<Camera> camera;
  std::optional<ImageSettings> image;  // NFF: resolution and background
};

struct ModelOptions {
  /// Angle in degrees up to which made-up normals are smoothed across an edge; nullopt: the format's own rule
  /// (glTF and STL flat, OBJ and PLY 45).
  std::optional<double> crease_angle;
};

/// Reads .gltf .glb .obj .ply .stl .nff, each also gzipped (.gz). Polygons come triangulated, normals made where missing.
/// Throws SceneError{file, "line N" or a JSON pointer, what}.
Model load_model(const std::filesystem::path& path, const ModelOptions& options = {});

/// True when `path` has the extension of a model file (with or without .gz).
bool is_model_file(const std::filesystem::path& path);

}  // namespace sundog
