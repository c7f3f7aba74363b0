// Model: the content of a model file before it is placed in a scene.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/values/camera.h"
#include "models/values/light.h"
#include "models/values/material.h"
#include "models/values/mesh.h"
#include "models/values/object.h"

namespace sundog {

/// Which of a model's animations plays, and its time.
struct Playing {
  std::string animation{};  // its name; empty: all
  bool cycle = false;       // repeats after the last key
  double seconds = 0;
};

/// Indices (mesh, material, medium) are local: MeshShape::mesh into `meshes`, and so on; media have no world
/// entry (index 0 is the first medium). Objects hold node transforms (instances share a mesh). Every mesh has
/// a triangle. Without a material, Object::material is -1 and Mesh::materials is empty (no materials in the
/// file), or the triangle uses an added material "default".
struct Model {
  std::vector<Mesh> meshes;
  std::vector<ImageDescription> images;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  bool for_paths = true;  // the materials suit path tracing (ModelOptions::for_paths)
  std::vector<MediumDescription> media;
  std::vector<Object> objects;
  /// Unit conversion. glTF: candela and lux become intensity = value / pi (phong's kd lacks 1/pi), with
  /// falloff {0, 0, 1} for point and spot lights. NFF: each of n lights, and an added ambient one, gets SPD's
  /// sqrt(n) / (2 n).
  std::vector<LightDescription> lights;
  std::optional<Camera> camera;         // glTF: the first of the default scene; NFF: the view
  std::optional<double> aspect;         // glTF: the camera's width over height
  std::optional<ImageSettings> image;   // NFF: resolution and background
  std::size_t dropped_polygons = 0;     // faces with fewer than three corners
  std::vector<std::string> unread;      // unsupported features, each once
  std::vector<std::string> warnings;    // about ignored features, missing material files, ...
  std::vector<std::string> animations;  // names
  double duration = 0;                  // seconds to the last key, once pose() has read them
  std::vector<dvec3> origins;           // one per mesh; not 0 if its vertices were moved nearer (far_mesh.h)
  /// Sets objects, camera, lights and the meshes that joints deform; empty without animations. See posed().
  std::function<void(const Playing&, Model&)> pose;
};

/// Meshes created in memory, by the names that objects use.
using NamedMeshes = std::map<std::string, std::shared_ptr<const Mesh>>;

struct ModelOptions {
  /// Maximum angle in degrees across which generated normals are smoothed; nullopt: the format's default
  /// (glTF and STL flat, OBJ its smoothing groups, otherwise and for PLY 45). 0 is flat.
  std::optional<double> crease_angle = std::nullopt;
  bool outside_files = false;  // the model may name files outside its folder
  /// Materials for path tracing or for the classical integrator; nullopt: for path tracing, unless the model
  /// has lights.
  std::optional<bool> for_paths = std::nullopt;
};

/// X(extension, reader) for each format, First(extension, reader) for the first; models::load_READER() reads
/// it.
#define SUNDOG_MODEL_FORMATS(First, X) \
  First(".gltf", gltf) X(".glb", gltf) X(".obj", obj) X(".ply", ply) X(".stl", stl) X(".nff", nff)

/// The extensions that load_model() reads, as text: ".gltf .glb ...".
#define SUNDOG_MODEL_EXTENSIONS SUNDOG_MODEL_FORMATS(SUNDOG_FIRST_EXTENSION, SUNDOG_NEXT_EXTENSION)
#define SUNDOG_FIRST_EXTENSION(extension, reader) extension
#define SUNDOG_NEXT_EXTENSION(extension, reader) " " extension

/// Reads SUNDOG_MODEL_EXTENSIONS, each also gzipped (.gz). Triangulates polygons (n corners give n - 2
/// triangles, even degenerate ones), generates missing normals, loads textures' images. Throws
/// SceneError{file, "line N", "byte N" or a JSON pointer, what}.
Model load_model(const std::filesystem::path& path, const ModelOptions& options = {});

/// The model of the file `path` at a time of its animations. Throws SceneError for malformed animations.
Model posed(Model model, const std::filesystem::path& path, const Playing& playing);

/// Whether `path` has a model file's extension (with or without .gz).
bool is_model_file(const std::filesystem::path& path);

}  // namespace sundog
