// One stage: the Whitted image of a rectangle of pixels. A work-item takes TILE_W x TILE_H pixels, whose
// place in the image is a multiple of the tile, so that the pixels it works on together are the same however
// the frame is cut.
#include "lib/whitted/whitted_batch.cl"
#include "lib/whitted/whitted_single.cl"

#include "lib/path/items.cl"  // takes their follow_camera_rays()

// Reads the scene; adds samples [first_sample, first_sample + sample_count) of the pixels of work-items
// [first_item, last_item) of the rectangle (x0, y0, width, height), or of the image's pixels that it stands
// for (`pixels`, where the launch is of a list), to film (rgb and coverage) and their
// number to weights (a sample that is not finite counts for nothing, one in a filter's lobe below zero -1);
// adds to counters, and where they are asked for the rays of pixels to ray_counts (lib/path/ray_counts.cl).
// Where first_sample is 0, film, weights and ray_counts may hold anything before.
__kernel FOR_WAVES(0) void render_whitted(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                                          __global const u32* restrict pixels, __global float4* restrict film,
                                          __global float* restrict weights, __global u32* restrict counters,
                                          __global u32* restrict ray_counts, const Launch launch) {
  const Scene scene = SCENE_OF_PARAMETERS;
  // Items count through the rectangle row by row; a launch in two dimensions takes whole rows of them.
  const u32 item = launch.first_item + get_global_id(1) * launch.row_items + get_global_id(0);
  if (get_global_id(0) >= launch.row_items || item >= launch.last_item) return;
  render_item(&scene, read_media(camera_media), &launch, item, pixels, film, weights,
              counters_of(counters, item), ray_counts);
}
