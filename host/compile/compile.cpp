// compile(): runs a SceneCompiler once.
#include "compile/compiled_scene.h"
#include "compile/scene_compiler.h"

namespace sundog {

std::size_t table_bytes(const SceneTables& tables) {
  std::size_t bytes = 0;
  for_each_table(tables, [&](const char*, const auto& table) { bytes += table.size() * sizeof table[0]; });
  return bytes;
}

CompiledScene compile(const SceneDescription& scene) { return SceneCompiler().compile(scene); }

}  // namespace sundog
