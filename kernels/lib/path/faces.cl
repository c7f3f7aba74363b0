// The side and material that rays hit, without shading: all that interfaces and shadow rays need. One ray per
// lane.
#pragma once
#include "lib/core/motion.cl"
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/trace/hits.cl"

// The side and material that a ray hit.
typedef struct Faces {
  REAL3 outward;       // world, not normalised; its sign against the direction tells entering from leaving
  MASK entering;       // the ray comes from outside
  MASK material;       // index
  MASK flags, medium;  // of the material
} Faces;

static inline void set_face_material(const Scene* scene, u32 material, MASK lanes, Faces* faces) {
  faces->material = select(faces->material, (MASK)((int)material), lanes);
  faces->flags = select(faces->flags, (MASK)((int)scene->materials[material].flags), lanes);
  faces->medium = select(faces->medium, (MASK)((int)scene->materials[material].medium), lanes);
}

// The faces of the hits of `lanes`.
static inline Faces hit_faces(const Scene* scene, REAL3 d, const Hits* hits, MASK lanes) {
  Faces faces;
  faces.outward = hits->ng;
  faces.material = NO_LANES;
  faces.flags = NO_LANES;
  faces.medium = NO_LANES;
  MASK by_triangle = NO_LANES;  // whose triangles have their own materials
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(hits->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    if (!(instance->flags & INSTANCE_IDENTITY))
      faces.outward =
          select3(faces.outward,
                  moved_normals(scene, index, world_normals(instance, hits->ng), time_of_hits(hits)), mine);
    if (instance->material != NO_MATERIAL)
      set_face_material(scene, instance->material, mine, &faces);
    else
      by_triangle |= mine;
  }
  EACH_LANE(i, by_triangle) {
    MASK_LANE(faces.material, i) = (int)scene->triangles[MASK_LANE(hits->prim, i)].material;
  }
  for (u32 left = lane_bits(by_triangle); left;) {
    const MASK mine = take_alike(faces.material, &left, &index);
    set_face_material(scene, index, mine, &faces);
  }
  faces.entering = MASK_OF(dot3(faces.outward, d) < 0.0f);
  return faces;
}
