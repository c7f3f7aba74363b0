// The output transform of ACES 1.3 for screens of standard dynamic range.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// Maps scene colours to screen colours, both linear sRGB: the reference rendering transform and the output
/// transform for sRGB at 100 nits in dim surroundings (Academy: RRT.ctl, ODT.Academy.sRGB_100nits_dim.ctl;
/// OpenColorIO: "ACES 1.0 - SDR Video"). White is 1; colours far brighter than white may exceed it slightly.
glm::dvec3 aces_output(const glm::dvec3& color);

}  // namespace sundog
