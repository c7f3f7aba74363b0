// Reports of a finished render, for --stats and --verbose.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "app/options/options.h"
#include "compile/compiled_scene.h"
#include "render/render.h"

namespace sundog {

/// Wall seconds of the whole command. What none of the named steps took is `other` (choosing devices,
/// checks), so that they add up to `total`.
struct TimeLedger {
  double load = 0, compile_scene = 0, write = 0, total = 0;
  double waited = 0;              // for other frames, not in the total
  double joules = -1, frame = 0;  // that the devices used for the frame (below 0: unknown), and its seconds
  std::string joules_by;          // what counts them, or why nothing does
  unsigned draft_pictures = 0;    // that were written while kernels were built
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

/// Rays by kind: primary, reflection, refraction, shadow, and the steps of marching.
nlohmann::json rays_json(const RayCounts& counts);

/// Rays of all kinds: primary, reflection, refraction and shadow.
std::uint64_t ray_count(const RayCounts& counts);

/// One sentence for each kind of loss that a picture may suffer (full stacks, dropped samples), and why rays
/// left solids of `scene` that they had not entered; empty: none.
std::vector<std::string> losses(const RayCounts& counts, const SceneDescription& scene);

/// A sentence for each failure of the device after which others, or another try, did the work.
std::vector<std::string> failures_text(const DeviceReport& report);

/// Many lines: the times, the rays, and each device's kernels.
std::string details_text(const RenderResult& result, const TimeLedger& times);

}  // namespace sundog
