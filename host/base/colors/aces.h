// The output transform of ACES 1.3 for screens of standard range.
#pragma once
#include <glm/glm.hpp>

namespace sundog {

/// Linear sRGB, scene to screen: the reference rendering transform and the output transform for sRGB at 100
/// nits in dim surroundings (Academy: RRT.ctl, ODT.Academy.sRGB_100nits_dim.ctl; "ACES 1.0 - SDR Video" of
/// OpenColorIO). White is 1; what is far brighter than white may be a little above.
glm::dvec3 aces_output(const glm::dvec3& color);

}  // namespace sundog
