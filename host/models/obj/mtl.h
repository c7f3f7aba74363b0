// Reads MTL material libraries.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "models/model.h"
#include "models/obj/mtl_maps.h"
#include "models/text.h"

namespace sundog::models {

/// A material's statements in a library (mtl_pbr.h).
struct MtlStatements;

/// The materials available to an OBJ file, by name.
class MaterialLibrary {
 public:
  explicit MaterialLibrary(Model& model);
  ~MaterialLibrary();

  /// Reads the files that an mtllib statement names, beside `obj`. Warns of files that are missing or outside
  /// the folder of `obj` without permission. Throws SceneError with the MTL file's line.
  void load(const Source& obj, const TextReader& line, std::string_view names);

  /// The material's index, added to the model at its first use; -1 for an unknown name. One warning covers
  /// all unknown names.
  int find(const Source& obj, std::string_view name);

 private:
  void read(const std::filesystem::path& path);
  int add(const Source& obj, const MtlStatements& stated);
  void warn_undefined(std::string_view name);

  Model& model_;
  MtlTextures textures_;
  std::map<std::string, MtlStatements, std::less<>> stated_;
  std::map<std::string, int, std::less<>> index_;
  std::size_t undefined_ = 0, warning_ = 0;  // undefined materials; index of the warning about them
  std::string names_;                        // the first few of them
};

}  // namespace sundog::models
