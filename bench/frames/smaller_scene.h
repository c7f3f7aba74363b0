// Scales a scene down to fewer pixels and samples, for measurements within a time budget. Pure arithmetic.
#pragma once
#include <functional>

#include "compile/compiled_scene.h"

namespace sundog {

/// The scene with about `pixels` pixels, at least one, and `samples` per pixel; never more than its own.
CompiledScene smaller_scene(const CompiledScene& scene, double pixels, double samples);

/// Reduces samples, then pixels, so that a frame takes about `seconds`, but at least 0.05 s, to be
/// measurable. `measure` returns the seconds of a frame; it gets tiny frames first, then larger ones until
/// one takes long enough.
CompiledScene scene_in_time(const CompiledScene& scene, double seconds,
                            const std::function<double(const CompiledScene&)>& measure);

}  // namespace sundog
