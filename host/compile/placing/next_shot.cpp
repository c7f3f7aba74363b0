// Finds the camera, transforms and deformed faces of the next scene or, without one, of the end of this
// scene's own motion.
#include "compile/placing/next_shot.h"

#include "compile/placing/motion.h"
#include "scene/shot.h"

namespace sundog {
namespace {

/// An object's mesh; null for other shapes.
const Mesh* mesh_of(const SceneDescription& scene, std::size_t object) {
  const auto* shape = std::get_if<MeshShape>(&scene.objects[object].shape);
  return shape ? &scene.meshes[static_cast<std::size_t>(shape->mesh)] : nullptr;
}

/// The faces of an object whose mesh has the same triangles in both scenes, with other corners.
std::vector<MovingFace> moving_faces(const SceneDescription& now, const SceneDescription& next,
                                     std::size_t object) {
  const Mesh *mesh = mesh_of(now, object), *moved = mesh_of(next, object);
  if (!mesh || !moved || mesh->positions == moved->positions) return {};
  if (mesh->positions.size() != moved->positions.size() || mesh->triangles != moved->triangles) return {};
  const auto place = [&](const SceneDescription& scene, const Mesh& from, unsigned corner) {
    return glm::vec3(scene.objects[object].world_from_object * glm::dvec4(from.positions[corner], 1));
  };
  std::vector<MovingFace> faces(mesh->triangles.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const unsigned corner = mesh->triangles[i][c];
      faces[i].now[static_cast<std::size_t>(c)] = place(now, *mesh, corner);
      faces[i].next[static_cast<std::size_t>(c)] = place(next, *moved, corner);
    }
  return faces;
}

}  // namespace

NextShot next_shot(const SceneDescription& now, const SceneDescription* next) {
  NextShot shot;
  SceneDescription view;
  view.camera = next ? next->camera : now.camera;
  view.image = now.image;
  if (!next && now.camera.moves_to) {
    view.camera.position = now.camera.moves_to->position;
    view.camera.target = now.camera.moves_to->target;
  }
  shot.world_to_ndc = shot_of(view).world_to_ndc;
  for (std::size_t i = 0; i < now.objects.size(); ++i) {
    if (next && i < next->objects.size())
      if (std::vector<MovingFace> faces = moving_faces(now, *next, i); !faces.empty())
        shot.faces[static_cast<int>(i)] = std::move(faces);
    const dmat4& here = now.objects[i].world_from_object;
    if (!next && now.objects[i].moves())
      shot.moves[static_cast<int>(i)] = world_at(now.objects[i], 1);
    else if (next && i < next->objects.size() && next->objects[i].world_from_object != here)
      shot.moves[static_cast<int>(i)] = next->objects[i].world_from_object * glm::inverse(here);
  }
  return shot;
}

}  // namespace sundog
