// Converts MTL's statements for physically based materials (Pr, Pm, map_Pr and others, by Exocortex), as
// Blender writes them, to glTF's materials.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "models/obj/mtl_maps.h"

namespace sundog::models {

/// A material's statements in a library.
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

/// Keywords of statements with numbers, in lower case.
inline constexpr std::string_view pbr_numbers[] = {"pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"};

/// Whether the statements define a physically based material. Numbers that are all 0 count as unused.
bool has_pbr(const MtlStatements& m);

/// Converts the statements to a glTF material (gltf/gltf_materials.h), without relief and opacity texture,
/// adds it, and returns its index. Kd is the base colour, `opacity` its alpha, Ni the index if above 1; Tf
/// transmits through a thin wall. Without Pr, Ns gives the roughness by Blender's formula.
int add_pbr(const MtlStatements& m, double opacity, const Source& obj, MtlTextures& textures, Model& model);

}  // namespace sundog::models
