/* The C interface: plain_c OUT [DEVICE] */
#include <stdio.h>
#include <sundog/sundog.h>

static const char scene_text[] =
    "{\"image\": {\"width\": 160, \"height\": 120, \"background\": [0.6, 0.7, 0.9]},"
    " \"camera\": {\"position\": [0, 1, 4], \"target\": [0, 0.8, 0]},"
    " \"lights\": [{\"type\": \"ambient\"}, {\"type\": \"point\", \"position\": [3, 5, 4]}],"
    " \"materials\": {\"gold\": {\"color\": [0.9, 0.7, 0.2], \"specular\": 0.7, \"reflection\": 0.3},"
    "                \"floor\": {\"color\": {\"checker\": [[1, 1, 1], [0.2, 0.2, 0.2]]}}},"
    " \"objects\": [{\"type\": \"sphere\", \"center\": [0, 0.8, 0], \"radius\": 0.8, \"material\": \"gold\"},"
    "             {\"type\": \"plane\", \"material\": \"floor\"}]}";

static int show(uint64_t done, uint64_t total, double seconds, void* user) {
  *(unsigned*)user += 1;
  printf("%llu of %llu pixels after %.2f s\n", (unsigned long long)done, (unsigned long long)total, seconds);
  return 0; /* continue */
}

int main(int argc, char** argv) {
  if (argc < 2) return fprintf(stderr, "usage: %s OUT [DEVICE]\n", argv[0]), 2;
  sundog_scene* scene = NULL;
  sundog_devices* devices = NULL;
  sundog_film* film = NULL;
  sundog_error* error = sundog_error_new();
  sundog_options options = {0};
  unsigned calls = 0;
  sundog_status status = sundog_scene_from_json(scene_text, NULL, &scene, error);
  if (status == SUNDOG_OK) status = sundog_devices_choose(argc > 2 ? argv[2] : NULL, &devices, error);
  options.devices = devices;
  options.progress = show;
  options.user = &calls;
  if (status == SUNDOG_OK) status = sundog_render(scene, &options, &film, error);
  if (status == SUNDOG_OK) status = sundog_film_save(film, argv[1], error);
  if (status != SUNDOG_OK) fprintf(stderr, "%s\n", sundog_error_line(error));
  sundog_film_free(film);
  sundog_devices_free(devices);
  sundog_scene_free(scene);
  sundog_error_free(error);
  return status;
}
