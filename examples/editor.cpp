// An editor's loop: a session draws while a light is turned. editor scenes/spheres.json turned.png [DEVICE]
#include <sundog/sundog.hpp>

#include <cmath>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "usage: %s SCENE OUT [DEVICE]\n", argv[0]), 2;
  try {
    sundog::Scene scene = sundog::Scene::load(argv[1]);
    scene.set("/image/width", 160).set("/image/height", 120);
    scene.set("/lights", R"([{"type": "ambient"}, {"type": "directional", "direction": [0, -1, 0]}])");
    sundog::Session session(argc > 3 ? sundog::choose_devices({argv[3]}) : std::vector<sundog::Device>());
    for (int degrees = 0; degrees < 360; degrees += 45) {
      const double angle = degrees * 3.14159265 / 180;
      scene.set("/lights/1/direction/0", std::sin(angle)).set("/lights/1/direction/2", std::cos(angle));
      session.start(scene);
      // A window would show each of these.
      sundog::Snapshot now = session.snapshot();
      while (now.state != sundog::SessionState::settled && now.state != sundog::SessionState::failed) {
        session.wait_for_change(now.revision, 1);
        now = session.snapshot();
      }
      std::printf("%3d degrees: %ux, %.3f s %s\n", degrees, now.samples, now.seconds, now.error.c_str());
    }
    session.finish().save(argv[2]);
  } catch (const sundog::Error& error) {
    std::fprintf(stderr, "%s: %s\n", error.place().c_str(), error.what());
    return 1;
  }
}
