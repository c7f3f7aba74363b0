// A material's statements in an MTL library.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "models/obj/mtl_maps.h"

namespace sundog::models {

struct MtlStatements {
  std::string name;
  std::filesystem::path library;
  bool of_blender = false;
  std::optional<glm::dvec3> ambient, diffuse, specular, filter;
  std::optional<glm::dvec3> emission;
  std::map<std::string, MtlMap, std::less<>> maps;  // by keyword
  std::map<std::string, double, std::less<>> pbr;   // Pr and others, by keyword
  std::map<std::string, const char*> unread;        // by keyword: the feature
  double exponent = 32, ior = 1;
  std::optional<double> opacity, transparency;  // d, Tr
  int illumination = 2;

  bool has_map(const char* key) const { return maps.contains(key); }
};

}  // namespace sundog::models
