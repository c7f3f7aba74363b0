// One stage: which media the lights are inside of, before photons leave them.
#include "lib/path/media_around.cl"
#include "plain/light/emission.cl"

// A work-item a light. Writes the MediaStack at the middle of each light to light_media, low word first, that
// of the outside for lights without a place.
__kernel void find_light_media(SCENE_PARAMETERS, __global u32* restrict light_media) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 index = get_global_id(0);
  if (index >= scene.info->table_lights) return;
  __global const Light* light = scene.lights + index;
  MediaStack around = {0, 0};
  if (has_place(light)) around = media_around(&scene, middle_of_light(light).xyz);
  write_media(around, light_media + 2u * index);
}
