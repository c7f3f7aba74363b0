// DeviceScene: a compiled scene's tables in one device's memory. A buffer has the same name here, in
// CompiledScene and in the kernels.
#pragma once
#include "compile/compiled_scene.h"
#include "device/device.h"

namespace sundog {

struct DeviceScene {
  Buffer<SceneInfo> info;
  Buffer<u32> nodes;  // Bvh8Nodes, or CompactNodes when the device runs a lane a ray
  Buffer<TriangleBlock> blocks;
  Buffer<Instance> instances;
  Buffer<TriangleShading> triangles;
  Buffer<Vertex> vertices;
  Buffer<Material> materials;
  Buffer<Medium> media;
  Buffer<Light> lights;
  Buffer<SdfField> sdf_fields;
  Buffer<float> sdf_parameters;
  Buffer<u32> camera_media;  // the MediaStack at the camera (kernels/lib/media.cl), low word first
};

/// Bytes that upload_scene will take.
std::size_t scene_bytes(const CompiledScene& scene);

/// Throws DeviceError when the device cannot hold the scene. camera_media is empty.
DeviceScene upload_scene(Device& device, const CompiledScene& scene);

/// A kernel that reads the scene: its table parameters, then Args.
template <class... Args>
using SceneKernel = Kernel<Buffer<SceneInfo>, Buffer<u32>, Buffer<TriangleBlock>, Buffer<Instance>,
                           Buffer<TriangleShading>, Buffer<Vertex>, Buffer<Material>, Buffer<Medium>,
                           Buffer<Light>, Buffer<SdfField>, Buffer<float>, Args...>;

template <class... Args>
SceneKernel<Args...> scene_kernel(const Program& program, const std::string& name) {
  return program.kernel<Buffer<SceneInfo>, Buffer<u32>, Buffer<TriangleBlock>, Buffer<Instance>,
                        Buffer<TriangleShading>, Buffer<Vertex>, Buffer<Material>, Buffer<Medium>,
                        Buffer<Light>, Buffer<SdfField>, Buffer<float>, Args...>(name);
}

template <class... Args>
cl::Event run_scene_kernel(Device& device, SceneKernel<Args...>& kernel, const LaunchSize& size,
                           const DeviceScene& scene, const std::type_identity_t<Args>&... args) {
  return device.run(kernel, size, scene.info, scene.nodes, scene.blocks, scene.instances, scene.triangles,
                    scene.vertices, scene.materials, scene.media, scene.lights, scene.sdf_fields,
                    scene.sdf_parameters, args...);
}

}  // namespace sundog
