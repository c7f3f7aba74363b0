// The table of integrators, selected by --integrator and /render/integrator.
#pragma once
#include <array>
#include <stdexcept>
#include <string_view>

namespace sundog {

struct Integrator {
  std::string_view name;    // as in options and scene files
  const char* entry;        // kernel file
  const char* kernel;       // takes the scene, camera media, film, weights, counters and a Launch
  std::string_view tuning;  // a part of scene_class(), by which scenes share a tuning
  bool needs_camera_media;  // needs the media that contain the camera
  unsigned most_run;        // maximum pixels per work-item; idle lanes take the next pixel
  int depth, most_depth;    // default and maximum depth
  int least_samples;        // per pixel, before its noise is estimated
  // Abilities, which decide how scenes are compiled, kernels built and options refused.
  bool branches;       // child rays wait on a stack; each light gets a shadow ray
  bool scatters;       // light scatters in media and fog
  bool own_materials;  // ModelOptions::for_paths, spectra, shadow catchers; no soft shadows of fields
  bool photons;        // caustics and guides
  bool light_parts;    // AOVs of light by lobes and by light groups
};

/// In scenes without max_depth, paths end by roulette alone, up to this cap.
inline constexpr int depth_cap = 1024;

inline constexpr std::array integrators{
    Integrator{.name = "whitted",
               .entry = "entry/render_whitted.cl",
               .kernel = "render_whitted",
               .tuning = "",
               .needs_camera_media = true,
               .most_run = 1,
               .depth = 8,
               .most_depth = 64,
               .least_samples = 1,
               .branches = true,
               .scatters = false,
               .own_materials = false,
               .photons = false,
               .light_parts = false},
    Integrator{.name = "path",
               .entry = "entry/render_path.cl",
               .kernel = "render_path",
               .tuning = "+paths",
               .needs_camera_media = true,
               .most_run = 16,
               .depth = depth_cap,
               .most_depth = 65536,
               .least_samples = 4,  // one or two often find no light even if there is some
               .branches = false,
               .scatters = true,
               .own_materials = true,
               .photons = true,
               .light_parts = true}};

/// Names in table order.
inline constexpr auto integrator_names = [] {
  std::array<std::string_view, integrators.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = integrators[i].name;
  return names;
}();

/// The row with this name, or nullptr.
constexpr const Integrator* find_integrator(std::string_view name) {
  for (const Integrator& integrator : integrators)
    if (integrator.name == name) return &integrator;
  return nullptr;
}

/// The row of a name that the scene reader has taken. Throws std::logic_error.
constexpr const Integrator& integrator_of(std::string_view name) {
  const Integrator* row = find_integrator(name);
  return row ? *row : throw std::logic_error("an integrator of the schema is not in the table");
}

}  // namespace sundog
