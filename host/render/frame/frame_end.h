// Gathers the result of a frame that is over: image, AOVs, statistics. Internal to the render layer.
#pragma once
#include "render/frame/frame.h"

namespace sundog {

/// Records whether the frame is complete, and if not, why.
void note_end(const Frame& frame, RenderResult& result);

/// Develops the film into image and AOVs; crops them all to the frame's region.
void develop(const Frame& frame, RenderResult& result);

/// The workers' reports, with their shares of the work. The caller holds the frame's mutex.
std::vector<DeviceReport> reports(const Frame& frame);

/// Records times, ray counts, and each worker's share.
void note_figures(const Frame& frame, RenderResult& result);

}  // namespace sundog
