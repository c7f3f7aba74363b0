// MTL material libraries.
#pragma once
#include <map>
#include <string>
#include <string_view>

#include "scene/model.h"
#include "scene/models/mtl_maps.h"
#include "scene/models/text.h"

namespace sundog::models {

/// A material as a library states it (mtl.cpp).
struct MtlStatements;

/// The materials that an OBJ file has at hand, by name.
class MaterialLibrary {
 public:
  explicit MaterialLibrary(Model& model);
  ~MaterialLibrary();

  /// Reads the files that an mtllib statement names, beside `obj`. One that is missing, or that leaves the
  /// folder of `obj` where that may not be, leaves a warning. Throws SceneError with the MTL file's line.
  void load(const Source& obj, const TextReader& line, std::string_view names);

  /// The index of the material, which the model has from its first use on; for an unknown name -1, and one
  /// warning that names all of these.
  int find(const Source& obj, std::string_view name);

 private:
  void read(const std::filesystem::path& path);
  int add(const Source& obj, const MtlStatements& stated);
  void warn_undefined(std::string_view name);

  Model& model_;
  MtlTextures textures_;
  std::map<std::string, MtlStatements, std::less<>> stated_;
  std::map<std::string, int, std::less<>> index_;
  std::size_t undefined_ = 0, warning_ = 0;  // how many materials; the warning's place among the model's
  std::string names_;                        // of the first ones
};

}  // namespace sundog::models
