// The integrators: how light is followed from the camera. One row each; --integrator and /render/integrator
// choose.
#pragma once
#include <array>
#include <string_view>

namespace sundog {

struct Integrator {
  std::string_view name;  // as users write it
  const char* entry;      // kernel file
  const char*
      kernel;  // of that file; it takes the scene, the camera's media, film, weights, counters and a Launch
  bool needs_camera_media;  // the media that the camera is in
  unsigned most_run;      // items that a work-item of many pixels can take, so that no lane waits for others
  int depth, most_depth;  // without max_depth; the greatest
};

/// Paths end by chance alone where a scene has no max_depth, but for this last cap.
inline constexpr int depth_cap = 1024;

inline constexpr std::array integrators{
    Integrator{"whitted", "entry/render_whitted.cl", "render_whitted", true, 1, 8, 64},
    Integrator{"path", "entry/render_path.cl", "render_path", true, 16, depth_cap, 65536}};

/// The names, in the table's order.
inline constexpr auto integrator_names = [] {
  std::array<std::string_view, integrators.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = integrators[i].name;
  return names;
}();

/// Path tracing chooses among lights and knows no artifices of the classical model, so what scenes compile to
/// depends on it.
constexpr bool traces_paths(std::string_view integrator) { return integrator == "path"; }

/// The row of that name; nullptr where there is none.
constexpr const Integrator* find_integrator(std::string_view name) {
  for (const Integrator& integrator : integrators)
    if (integrator.name == name) return &integrator;
  return nullptr;
}

}  // namespace sundog
