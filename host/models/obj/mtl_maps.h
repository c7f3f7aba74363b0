// Reads the texture statements of MTL libraries (map_Kd and others) with their options.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "models/model.h"
#include "models/text.h"

namespace sundog::models {

/// A map statement.
struct MtlMap {
  std::string file;
  glm::dvec2 offset{0}, scale{1};  // -o, -s: texture coordinates * scale + offset
  bool clamp = false;              // -clamp
  double bump = 1;                 // -bm
  bool has_bump = false;           // -bm is present
  int channel = -1;                // -imfchan
  std::size_t line = 0;
};

/// Reads options and the file's name, which may contain blanks; nothing without a name. Throws SceneError
/// with the line.
std::optional<MtlMap> read_mtl_map(TextReader& text);

/// The textures of one model's libraries.
class MtlTextures {
 public:
  explicit MtlTextures(Model& model) : model_(model) {}

  /// Adds a texture whose file lies beside `library`; -1, with a warning, if the file is missing or lies
  /// outside the folder of `obj` without permission.
  int use(const MtlMap& map, bool srgb, const Source& obj, const std::filesystem::path& library);

 private:
  Model& model_;
  std::map<std::pair<std::string, bool>, int> images_;
};

}  // namespace sundog::models
