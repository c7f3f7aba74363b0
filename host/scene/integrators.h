// The table of integrators, selected by --integrator and /render/integrator.
#pragma once
#include <array>
#include <string_view>

namespace sundog {

struct Integrator {
  std::string_view name;    // as in options and scene files
  const char* entry;        // kernel file
  const char* kernel;       // takes the scene, camera media, film, weights, counters and a Launch
  bool needs_camera_media;  // media that contain the camera
  unsigned most_run;        // pixels per work-item at most, so that idle lanes take the next pixel
  int depth, most_depth;    // default and maximum depth
};

/// Paths end by roulette alone in scenes without max_depth, up to this cap.
inline constexpr int depth_cap = 1024;

inline constexpr std::array integrators{
    Integrator{"whitted", "entry/render_whitted.cl", "render_whitted", true, 1, 8, 64},
    Integrator{"path", "entry/render_path.cl", "render_path", true, 16, depth_cap, 65536}};

/// Names in table order.
inline constexpr auto integrator_names = [] {
  std::array<std::string_view, integrators.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = integrators[i].name;
  return names;
}();

/// Path tracing selects lights differently and ignores features of the classical model, so the compiled scene
/// depends on it.
constexpr bool traces_paths(std::string_view integrator) { return integrator == "path"; }

/// The row of that name, or nullptr.
constexpr const Integrator* find_integrator(std::string_view name) {
  for (const Integrator& integrator : integrators)
    if (integrator.name == name) return &integrator;
  return nullptr;
}

}  // namespace sundog
