// See next_shot.h.
#include "compile/placing/next_shot.h"

#include "compile/placing/motion.h"
#include "scene/shot.h"

namespace sundog {

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
    const dmat4& here = now.objects[i].world_from_object;
    if (!next && now.objects[i].moves())
      shot.moves[static_cast<int>(i)] = world_at(now.objects[i], 1);
    else if (next && i < next->objects.size() && next->objects[i].world_from_object != here)
      shot.moves[static_cast<int>(i)] = next->objects[i].world_from_object * glm::inverse(here);
  }
  return shot;
}

}  // namespace sundog
