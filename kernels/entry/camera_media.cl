// One stage: which media the camera is inside of, found by following a line from it to the outside.
#include "lib/media.cl"
#include "lib/segment.cl"

// One work-item. Writes camera_media[0] = count and the media in their order of entry (the outermost first):
// a solid that the line leaves without having entered it holds the camera, and the nearest such exit was
// entered last.
__kernel void find_camera_media(TRACE_PARAMETERS, SHADE_PARAMETERS, __global u32* restrict camera_media) {
  if (get_global_id(0) != 0) return;
  const float3 o = info->camera_position.xyz;
  const float3 d =
      unit((float3)(0.3141f, 0.8660f, 0.3890f));  // off every axis that a scene is likely to be built along
  MediaStack entered, holding;
  entered.count = 0;
  holding.count = 0;
  float t_min = 0.0f;
  for (u32 i = 0; i < 4096u; ++i) {
    const Hit hit = trace_ray(TRACE_ARGUMENTS, o, d, t_min, INFINITY, false);
    if (hit.instance == NO_INSTANCE) break;
    t_min = hit.t;
    __global const Material* material = materials + hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &hit);
    if (!(material->flags & MATERIAL_TRANSMITS) || (material->flags & MATERIAL_THIN)) continue;
    const bool entering = dot(outward_normal(TRACE_ARGUMENTS, &hit), d) < 0.0f;
    if (entering)
      cross_boundary(&entered, material->medium, true);
    else if (!cross_boundary(&entered, material->medium, false))
      cross_boundary(&holding, material->medium, true);
  }
  camera_media[0] = holding.count;
  for (u32 i = 0; i < holding.count; ++i) camera_media[1u + i] = holding.medium[holding.count - 1u - i];
}
