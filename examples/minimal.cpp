// A scene file to a picture: minimal scenes/spheres.json spheres.png [DEVICE]
#include <sundog/sundog.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "usage: %s SCENE OUT [DEVICE]\n", argv[0]), 2;
  try {
    sundog::RenderOptions options;
    if (argc > 3) options.devices = sundog::choose_devices({argv[3]});
    const sundog::Film film = sundog::render(sundog::Scene::load(argv[1]), options);
    film.save(argv[2]);
    std::printf("%s: %dx%d pixels in %.2f s on %s\n", argv[2], film.width(), film.height(),
                film.figures().render_seconds, film.figures().devices.at(0).label.c_str());
  } catch (const sundog::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
