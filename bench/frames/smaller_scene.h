// Scales a scene down to fewer pixels and samples, for measurements within a time budget. Pure arithmetic.
#pragma once
#include <functional>

#include "compile/compiled_scene.h"

namespace sundog {

/// The picture in about `pixels` pixels, at least one, with `samples` a pixel; never more than the scene's.
CompiledScene smaller_scene(const CompiledScene& scene, double pixels, double samples);

/// The scene with so few samples, then pixels, that a frame takes about `seconds` (a lower bound keeps it
/// from being too short to be measured). `measure` gives the seconds of a frame: it gets tiny ones at first,
/// then larger ones until they take long enough.
CompiledScene scene_in_time(const CompiledScene& scene, double seconds,
                            const std::function<double(const CompiledScene&)>& measure);

}  // namespace sundog
