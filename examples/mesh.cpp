// A mesh made in code, rendered with a progress of its own: mesh wave.png [DEVICE]
#include <sundog/sundog.hpp>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: %s OUT [DEVICE]\n", argv[0]), 2;
  // A wave over a grid.
  constexpr unsigned cells = 200;
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (unsigned z = 0; z <= cells; ++z)
    for (unsigned x = 0; x <= cells; ++x) {
      const float px = 4.0f * float(x) / cells - 2, pz = 4.0f * float(z) / cells - 2, r = std::hypot(px, pz);
      positions.push_back({px, 0.25f * std::cos(6 * r) / (1 + r * r), pz});
      if (x == cells || z == cells) continue;
      const unsigned corner = z * (cells + 1) + x, below = corner + cells + 1;
      triangles.push_back({corner, below, corner + 1});
      triangles.push_back({corner + 1, below, below + 1});
    }
  try {
    sundog::Scene scene;
    scene.set_size(320, 240).set_samples(4);
    scene.set_camera({.position = {0, 2.2, 4}, .target = {0, -0.1, 0}, .fov = 40});
    scene.set_background({0.9, 0.9, 0.95}, {0.3, 0.5, 0.8});
    scene.add_light({.type = "directional", .direction = {-1, -2, -1.5}});
    scene.add_light({.type = "ambient"});
    scene.add_material("sea",
                       {.color = {0.1, 0.35, 0.5}, .specular = 0.6, .exponent = 80, .reflection = 0.3});
    scene.add_mesh("wave", {.positions = positions, .triangles = triangles});
    scene.add_instance("wave", {.material = "sea"});

    sundog::RenderOptions options;
    if (argc > 2) options.devices = sundog::choose_devices({argv[2]});
    options.on_progress = [](const sundog::Progress& now) {
      std::printf("\r%3.0f %%", 100.0 * double(now.pixels_done) / double(now.pixels_total));
      std::fflush(stdout);
    };
    sundog::render(scene, options).save(argv[1]);
    std::printf("\r%s: %zu triangles\n", argv[1], triangles.size());
  } catch (const sundog::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
