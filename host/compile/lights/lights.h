// Adds lights of the scene file to the tables of lights.
#pragma once
#include <string>

#include "compile/steps.h"

namespace sundog {

inline double luminance(const float4& color) {
  return 0.2126 * double(color.x) + 0.7152 * double(color.y) + 0.0722 * double(color.z);
}

/// Adds a non-ambient light; `place` is its place in the scene file.
void add_light(const LightInputs& in, const LightDescription& light, const std::string& place, Lights& out);

}  // namespace sundog
