// Models: what a model file holds, before it is placed in a scene.
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// A model file's content. Indices (mesh, material, medium) are local to it: MeshShape::mesh into `meshes`,
/// and so on; media have no world entry (index 0 is the first medium). Objects hold the node transforms
/// (instances share a mesh). A mesh has one triangle or more. Where the file names no material,
/// Object::material is -1 and Mesh::materials is empty (a file without any), or the triangle's index is that
/// of an added material "default".
struct Model {
  std::vector<Mesh> meshes;
  std::vector<ImageDescription> images;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<MediumDescription> media;
  std::vector<Object> objects;
  /// glTF's candela, lux and inverse squares become: intensity = value / pi (the phong model has no 1/pi in
  /// kd), falloff {0, 0, 1} for point and spot lights. NFF: each light and an ambient one by SPD's sqrt(n) /
  /// (2 n).
  std::vector<LightDescription> lights;
  std::optional<Camera> camera;        // the first one of the default scene (glTF), or the view (NFF)
  std::optional<ImageSettings> image;  // NFF: resolution and background
  std::size_t dropped_polygons = 0;    // faces with fewer than three corners
  std::vector<std::string> unread;     // features of the file that are not read, each named once
  std::vector<std::string> warnings;   // of what was read past: unread features, missing material files, ...
};

/// Meshes that a program has made, by the names that objects place them by.
using NamedMeshes = std::map<std::string, std::shared_ptr<const Mesh>>;

struct ModelOptions {
  /// Angle in degrees up to which made-up normals are smoothed across an edge; nullopt: the format's own rule
  /// (glTF and STL flat, OBJ by its smoothing groups, else it and PLY 45). 0 is
  /// flat.
  std::optional<double> crease_angle = std::nullopt;
  bool outside_files = false;  // files that the model names may lie outside its folder
};

/// Reads .gltf .glb .obj .ply .stl .nff, each also gzipped (.gz). Polygons come triangulated (n corners make
/// n - 2 triangles, those without area too), normals made where missing; textures with their images. Throws
/// SceneError{file, "line N", "byte N" or a JSON pointer, what}.
Model load_model(const std::filesystem::path& path, const ModelOptions& options = {});

/// True when `path` has the extension of a model file (with or without .gz).
bool is_model_file(const std::filesystem::path& path);

}  // namespace sundog
