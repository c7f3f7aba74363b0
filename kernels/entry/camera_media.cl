// One stage: which media the camera is inside of.
#include "lib/path/media_around.cl"

// One work-item. Writes the camera's MediaStack to camera_media, low word first.
__kernel void find_camera_media(SCENE_PARAMETERS, __global u32* restrict camera_media) {
  const Scene scene = SCENE_OF_PARAMETERS;
  if (get_global_id(0) > 0) return;
  write_media(media_around(&scene, scene.info->camera_position.xyz), camera_media);
}
