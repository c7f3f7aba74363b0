// A triangle mesh as Embree takes it.
#pragma once
#include "embree_query.h"
#include "scene/description.h"

namespace sundog {

/// A committed geometry with copies of the mesh's positions and triangles; the caller releases it.
RTCGeometry embree_mesh(RTCDevice device, const Mesh& mesh, RTCBuildQuality quality);

}  // namespace sundog
