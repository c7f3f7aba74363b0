// SceneCompiler: compiles successive scenes and reuses parts whose content has not changed; the result equals
// compile()'s byte for byte.
#pragma once
#include <memory>

#include "compile/compiled_scene.h"

namespace sundog {

/// Counts the parts that were compiled, not reused, over all calls.
struct CompileWork {
  std::uint64_t meshes = 0;     // mesh parts: BVHs and tables
  std::uint64_t bvhs = 0;       // BVHs of meshes, and over instances
  std::uint64_t lights = 0;     // parts of lights and environment
  std::uint64_t surfaces = 0;   // parts of materials, media and textures
  std::uint64_t fields = 0;     // parts of fields
  std::uint64_t instances = 0;  // parts of instances
  std::uint64_t touching = 0;   // searches for touching solids
  friend bool operator==(const CompileWork&, const CompileWork&) = default;
};

/// The parts: lights (with the environment), surfaces (materials, media, textures), meshes, instances
/// (objects, and the meshes' boxes), fields (and the camera's distance, for deep views). The view is always
/// recompiled. Not thread-safe.
class SceneCompiler {
 public:
  SceneCompiler();
  ~SceneCompiler();
  SceneCompiler(SceneCompiler&&) noexcept;
  SceneCompiler& operator=(SceneCompiler&&) noexcept;

  /// Like compile(). After an exception, parts of earlier scenes are kept.
  CompiledScene compile(const SceneDescription& scene);
  const CompileWork& work() const { return work_; }

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  CompileWork work_;
};

}  // namespace sundog
