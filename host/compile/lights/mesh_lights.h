// Compiles emissive meshes to one light per triangle.
#pragma once
#include "compile/steps.h"

namespace sundog {

/// The lights of a scene with those of its meshes, and its instances with the rows of their lights.
struct MeshLights {
  SharedTable<Light> lights;
  SharedTable<Instance> instances;
  bool any = false;  // some mesh is a light
};

/// Appends a light for each triangle of meshes whose materials have a uniform emission. Stores the light's
/// index in their instances, and in those of visible lights for path tracing. Meshes with textured emission
/// or more than `most_shining` triangles are left to rays that hit them.
MeshLights add_mesh_lights(const AllLightsInputs& in);

constexpr std::size_t most_shining = 200'000;

}  // namespace sundog
