// The texture statements of MTL libraries (map_Kd and its like) with their options.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scene/model.h"
#include "scene/models/text.h"

namespace sundog::models {

/// What follows a map's keyword.
struct MtlMap {
  std::string file;
  glm::dvec2 offset{0}, scale{1};  // -o, -s: texture coordinates times scale plus offset
  bool clamp = false;              // -clamp
  double bump = 1;                 // -bm
  bool has_bump = false;           // it is there
  int channel = -1;                // -imfchan
  std::size_t line = 0;
};

/// Reads options and the file's name, which may hold blanks; nothing without one. Throws SceneError with the
/// line.
std::optional<MtlMap> read_mtl_map(TextReader& text);

/// The textures of one model's libraries.
class MtlTextures {
 public:
  explicit MtlTextures(Model& model) : model_(model) {}

  /// Adds a texture whose file lies beside `library`; -1, and a warning, where the file is missing or leaves
  /// the folder of `obj` where that may not be.
  int use(const MtlMap& map, bool srgb, const Source& obj, const std::filesystem::path& library);

 private:
  Model& model_;
  std::map<std::pair<std::string, bool>, int> images_;
};

}  // namespace sundog::models
