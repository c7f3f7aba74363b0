// SceneCompiler: compile() for one scene after another. Parts whose content is that of the scene before are
// kept; the result has the bytes of compile() all the same.
#pragma once
#include <memory>

#include "compile/compiled_scene.h"

namespace sundog {

/// What was made, not kept, in all calls so far.
struct CompileWork {
  std::uint64_t meshes = 0;     // parts of meshes: their BVHs and tables
  std::uint64_t bvhs = 0;       // of meshes, and over instances
  std::uint64_t lights = 0;     // parts of lights and environment
  std::uint64_t surfaces = 0;   // parts of materials, media and textures
  std::uint64_t fields = 0;     // parts of fields
  std::uint64_t instances = 0;  // parts of instances
  std::uint64_t touching = 0;   // searches for solids that lie on others
  friend bool operator==(const CompileWork&, const CompileWork&) = default;
};

/// The parts and what they depend on: lights (with the environment), surfaces (materials, media, textures),
/// meshes, instances (objects, and the meshes' boxes), fields (and how near the camera is, for deep views).
/// The view is made each time. One thread at a time.
class SceneCompiler {
 public:
  SceneCompiler();
  ~SceneCompiler();
  SceneCompiler(SceneCompiler&&) noexcept;
  SceneCompiler& operator=(SceneCompiler&&) noexcept;

  /// As compile(). After an exception the parts are those of the scenes before.
  CompiledScene compile(const SceneDescription& scene);
  const CompileWork& work() const { return work_; }

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  CompileWork work_;
};

}  // namespace sundog
