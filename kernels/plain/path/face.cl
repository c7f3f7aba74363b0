// The side and material that a ray has hit, without shading: all that interfaces and shadow rays need.
#include "plain/path/scene_ray.cl"

typedef struct Face {
  float3 outward;     // world, not normalised; its sign against the direction tells entering from leaving
  bool entering;      // the ray comes from outside
  int material;       // index
  int flags, medium;  // of the material
} Face;

bool hit_anything(const SurfaceHit* hit);
float3 world_normals(UNIFORM __global const Instance* instance, float3 n);
float3 moved_normals(UNIFORM const Scene* scene, UNIFORM u32 index, float3 n, float time);
float time_of_hits(const SurfaceHit* hit);

static inline void set_face_material(UNIFORM const Scene* scene, UNIFORM u32 material, Face* face) {
  face->material = (int)material;
  face->flags = (int)scene->materials[material].flags;
  face->medium = (int)scene->materials[material].medium;
}

// Without a hit, no material and flags.
ENTRY static inline Face hit_faces(UNIFORM const Scene* scene, float3 d, const SurfaceHit* hit) {
  Face face = {hit->ng, false, 0, 0, 0};
  bool by_triangle = false;  // whose triangles have their own materials
  if (hit_anything(hit)) EACH_ALIKE(u32, index, hit->instance) {
      __global const Instance* instance = scene->instances + index;
      if ((instance->flags & INSTANCE_IDENTITY) == 0u)
        face.outward = moved_normals(scene, index, world_normals(instance, hit->ng), time_of_hits(hit));
      if (instance->material != NO_MATERIAL)
        set_face_material(scene, instance->material, &face);
      else
        by_triangle = true;
    }
  if (by_triangle)
    EACH_ALIKE(u32, index, scene->triangles[hit->prim].material) set_face_material(scene, index, &face);
  face.entering = dot(face.outward, d) < 0.0f;
  return face;
}
