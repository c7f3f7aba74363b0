// Compiles emissive meshes to one light per triangle.
#pragma once
#include "compile/steps.h"

namespace sundog {

/// A scene's lights, including those of its meshes, and its instances with the rows of their lights.
struct MeshLights {
  SharedTable<Light> lights;
  SharedTable<Instance> instances;
  bool any = false;  // some mesh is a light
};

/// Appends a light for each triangle of meshes whose materials have a uniform emission, and stores the first
/// row in their instances. For path tracing, stores a visible light's row in the instances that show it. Only
/// rays that hit them find meshes that move, have textured emission or exceed `most_shining` triangles.
MeshLights add_mesh_lights(const AllLightsInputs& in);

constexpr std::size_t most_shining = 200'000;

}  // namespace sundog
