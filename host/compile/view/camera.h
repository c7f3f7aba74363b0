// Compiles the view: the camera's frame and pixel vectors, the background, the filter and the settings.
#pragma once
#include "compile/compiled_scene.h"

namespace sundog {

struct CompiledView {
  SceneInfo info{};
  SceneFeatures features;
  SharedTable<float> filter;
  SharedTable<float4> guides;
};

/// Positions are relative to `origin`. Throws SceneError for an empty image, a zero view direction, or an up
/// vector parallel to it.
CompiledView compile_view(const SceneDescription& scene, const dvec3& origin);

}  // namespace sundog
