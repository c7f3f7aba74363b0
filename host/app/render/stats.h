// Reports a finished render: JSON for --stats, text for --verbose, and warnings about losses.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "app/options/options.h"
#include "compile/compiled_scene.h"
#include "render/render.h"

namespace sundog {

/// Wall seconds of the whole command, by step. `other` is the rest (choosing devices, checks), so that the
/// steps add up to `total`.
struct TimeLedger {
  double load = 0, compile_scene = 0, write = 0, total = 0;
  double waited = 0;              // waiting for other frames; not in the total
  double joules = -1, frame = 0;  // energy that the frame took (below 0: unknown), and its seconds
  std::string joules_by;          // the meter of the energy, or why there is none
  unsigned draft_pictures = 0;    // drafts written while kernels were built
  RenderTimes render;

  double other() const {
    return total - (load + compile_scene + render.build_kernels + render.upload + render.render +
                    render.readback + write);
  }
};

/// The statistics file, "schema": 1 (docs/reference/statistics.md describes it), without its "seconds".
nlohmann::json stats_json(const RenderCommand& command, const SceneDescription& scene,
                          const CompiledScene& flat, const RenderResult& result, const TimeLedger& times);

/// The file's "seconds".
nlohmann::json seconds_json(const TimeLedger& times);

/// Rays by kind (primary, reflection, refraction, shadow), and march steps.
nlohmann::json rays_json(const RayCounts& counts);

/// Rays of all kinds: primary, reflection, refraction and shadow.
std::uint64_t ray_count(const RayCounts& counts);

/// A sentence for each kind of loss in the picture (full stacks, dropped samples), and the likely causes if
/// many rays left solids of `scene` that they had not entered; empty: none.
std::vector<std::string> losses(const RayCounts& counts, const SceneDescription& scene);

/// A sentence for each failure of the device that other devices, or a retry, made up for.
std::vector<std::string> failures_text(const DeviceReport& report);

/// Several lines: the times, the rays, and each device's kernels.
std::string details_text(const RenderResult& result, const TimeLedger& times);

}  // namespace sundog
