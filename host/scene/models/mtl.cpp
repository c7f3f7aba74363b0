// MTL material libraries (Wavefront, "MTL material format", 1995). Colours are taken as they stand, as linear
// ones. In: a library's text. Out: phong materials, dielectrics and their media.
#include "scene/models/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "scene/inside.h"
#include "scene/models/mtl_maps.h"
#include "scene/models/readers.h"
#include "scene/models/text.h"

namespace sundog::models {
namespace fs = std::filesystem;
namespace {

// A material as MTL states it.
struct Statements {
  std::string name;
  std::optional<dvec3> ambient, diffuse, specular, filter;
  std::optional<dvec3> emission;
  std::map<std::string, MtlMap, std::less<>> maps;  // by keyword
  double exponent = 32, ior = 1, opacity = 1;
  int illumination = 2;
};

// "Kd r g b", or "Kd r" for grey. Spectral files and CIE XYZ are left at the default.
std::optional<dvec3> read_color(TextReader& text) {
  TextReader peek = text;
  const std::string_view form = peek.word();
  if (form == "spectral" || form == "xyz") return std::nullopt;
  const double red = text.number("red");
  if (text.at_line_end()) return glm::max(dvec3(red), dvec3(0));
  const double green = text.number("green"), blue = text.number("blue");
  return glm::max(dvec3(red, green, blue), dvec3(0));
}

/// Statements that would change the picture.
constexpr std::string_view read_maps[] = {"map_Kd",   "map_Ka",   "map_Ks", "map_Ke", "map_d",
                                          "map_Bump", "map_bump", "bump",   "norm",   "map_Kn",
                                          "disp",     "map_disp", "map_Ns"};
constexpr std::pair<std::string_view, const char*> unread_properties[] = {{"map_Tr", "alpha of textures"},
                                                                          {"decal", "decals"},
                                                                          {"refl", "reflection maps"},
                                                                          {"map_refl", "reflection maps"},
                                                                          {"map_Pr", "roughness textures"},
                                                                          {"map_Pm", "roughness textures"},
                                                                          {"map_Ps", "sheen"},
                                                                          {"Pr", "roughness"},
                                                                          {"Pm", "metalness"},
                                                                          {"Ps", "sheen"},
                                                                          {"Pc", "clearcoat"},
                                                                          {"aniso", "anisotropy"}};

/// Numbers of 0 say that the feature is not used.
void note_unread(TextReader text, std::string_view key, Model& model) {
  const auto all_zero = [&] {
    while (!text.at_line_end())
      if (const std::string_view word = text.word(); word.find_first_not_of("0.+-") != word.npos)
        return false;
    return true;
  };
  for (const auto& [word, feature] : unread_properties)
    if (key == word && !all_zero()) leave_unread(model, feature);
}

double read_opacity(TextReader& text) {
  TextReader peek = text;
  if (peek.word() == "-halo") text.word();
  return std::clamp(text.number("d"), 0.0, 1.0);
}

void read_statement(TextReader& text, std::string_view key, Statements& m) {
  if (key == "Ka") m.ambient = read_color(text);
  if (key == "Kd") m.diffuse = read_color(text);
  if (key == "Ks") m.specular = read_color(text);
  if (key == "Tf") m.filter = read_color(text);
  if (key == "Ke") m.emission = read_color(text);
  if (std::ranges::count(read_maps, key) > 0) m.maps.insert_or_assign(std::string(key), read_mtl_map(text));
  if (key == "Ns") m.exponent = std::max(text.number("Ns"), 0.0);
  if (key == "Ni") m.ior = text.number("Ni");
  if (key == "d") m.opacity = read_opacity(text);
  if (key == "Tr") m.opacity = 1 - std::clamp(text.number("Tr"), 0.0, 1.0);
  if (key == "illum")
    m.illumination = static_cast<int>(std::clamp<std::int64_t>(text.integer("illum"), 0, 10));
}

/// Displacement: with -bm true displacement by so many of the model's units, else heights for the shading, as
/// of a bump map: files rarely say how high they are.
void add_displacement(const Statements& m, const Source& obj, const fs::path& library, MtlTextures& textures,
                      MaterialDescription& out) {
  for (const char* key : {"map_disp", "disp"})
    if (const auto found = m.maps.find(key); found != m.maps.end()) {
      MtlMap map = found->second;
      if (map.channel < 0) map.channel = 0;
      if (!map.has_bump && out.textures.height >= 0) continue;
      const int heights = textures.use(map, false, obj, library);
      if (heights < 0) continue;
      if (map.has_bump) {
        out.displaced_by = heights;
        out.displacement = map.bump;
      } else {
        out.textures.height = heights;
        out.bump = 0;
        out.bump_uv = 0.01;
      }
    }
}

/// Heights and normals. The format gives heights no unit: here a height of 1 is a hundredth of a unit of u
/// and v, times -bm.
void add_relief_maps(const Statements& m, const Source& obj, const fs::path& library, MtlTextures& textures,
                     MaterialDescription& out) {
  for (const char* key : {"norm", "map_Kn"})
    if (const auto found = m.maps.find(key); found != m.maps.end())
      out.textures.normal = textures.use(found->second, false, obj, library);
  for (const char* key : {"bump", "map_bump", "map_Bump"})
    if (const auto found = m.maps.find(key); found != m.maps.end()) {
      MtlMap map = found->second;
      if (map.channel < 0) map.channel = 0;
      out.textures.height = textures.use(map, false, obj, library);
      out.bump = 0;
      out.bump_uv = 0.01 * map.bump;
    }
}

/// The textures of a material; what has one and no colour of its own is white.
void add_maps(const Statements& m, const Source& obj, const fs::path& library, MtlTextures& textures,
              MaterialDescription& out) {
  const auto use = [&](const char* key) {
    const auto found = m.maps.find(key);
    return found == m.maps.end() ? -1 : textures.use(found->second, true, obj, library);
  };
  MaterialTextures& to = out.textures;
  to.diffuse = use("map_Kd");
  to.ambient = m.maps.contains("map_Ka") ? use("map_Ka") : to.diffuse;
  to.specular = use("map_Ks");
  to.emission = use("map_Ke");
  if (to.diffuse >= 0 && !m.diffuse) out.diffuse = dvec3(1);
  if (to.specular >= 0 && !m.specular) out.specular = dvec3(1);
  if (to.emission >= 0 && !m.emission) out.emission = dvec3(1);
  if (const auto shine = m.maps.find("map_Ns"); shine != m.maps.end())
    to.exponent = textures.use(shine->second, false, obj, library);
  add_relief_maps(m, obj, library, textures, out);
  add_displacement(m, obj, library, textures, out);
  const auto alpha = m.maps.find("map_d");
  if (alpha == m.maps.end() || out.medium >= 0) return;
  MtlMap map = alpha->second;
  const auto color = m.maps.find("map_Kd");
  const bool of_color = color != m.maps.end() && color->second.file == map.file;
  if (map.channel < 0) map.channel = of_color ? 3 : 0;
  to.opacity = textures.use(map, of_color, obj, library);
}

// Illumination models: 3 to 8 trace reflections; 4, 6, 7 and 9 are glass; 5 and 7 have Fresnel's equations.
MaterialDescription make_material(const Statements& m, Model& model) {
  const int illum = m.illumination;
  const bool traced = illum >= 4 && illum <= 7, fresnel = illum == 5 || illum == 7;
  const bool glass = m.opacity < 1 || (m.filter && (traced || illum == 9) && *m.filter != dvec3(0));
  MaterialDescription out;
  out.name = m.name;
  out.ambient = m.ambient.value_or(out.ambient);
  out.diffuse = m.diffuse.value_or(out.diffuse);
  out.specular = m.specular.value_or(out.specular);
  out.exponent = m.exponent;
  out.emission = m.emission.value_or(out.emission);
  if (illum >= 3 && illum <= 8) out.reflection = glm::min(out.specular, dvec3(1));
  if (glass) {
    const dvec3 filter = glm::min(m.filter.value_or(dvec3(1)), dvec3(1));
    out.transmission = m.opacity < 1 && !(fresnel && m.filter) ? (1 - m.opacity) * filter : filter;
    out.ambient *= m.opacity;
    out.diffuse *= m.opacity;
    if (traced && m.ior > 0 && m.ior != 1) {
      MediumDescription medium;
      medium.name = m.name;
      medium.ior = m.ior;
      out.medium = static_cast<int>(model.media.size());
      model.media.push_back(medium);
    }
    if (fresnel && out.medium >= 0) {
      out.type = MaterialType::dielectric;
      out.reflection = dvec3(1);
    }
  }
  return out;
}

// An mtllib line holds one name with blanks, or several names: those end in ".mtl".
std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> parts;
  while (!names.empty()) {
    const std::size_t end = names.find(".mtl ");
    parts.emplace_back(names.substr(0, end == names.npos ? end : end + 4));
    names.remove_prefix(end == names.npos ? names.size() : end + 5);
    names.remove_prefix(std::min(names.find_first_not_of(" \t"), names.size()));
  }
  return parts;
}

fs::path beside(const fs::path& obj, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return obj.parent_path() / fs::path(name);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

bool MaterialLibrary::is_refused(const Source& obj, const TextReader& line, const fs::path& path) {
  if (obj.outside_files || !leads_outside(obj.path, path)) return false;
  model_.warnings.push_back(
      fmt::format("{}: line {}: the material library {} leads out of the model's folder and is not read: {}",
                  obj.path.string(), line.line(), path.string(), outside_hint));
  return true;
}

void MaterialLibrary::load(const Source& obj, const TextReader& line, std::string_view names) {
  const fs::path whole = beside(obj.path, std::string(names));
  if ((obj.outside_files || !leads_outside(obj.path, whole)) && is_file(whole)) return read(obj, whole);
  for (const std::string& name : split_names(names)) {
    const fs::path path = beside(obj.path, name);
    if (is_refused(obj, line, path)) continue;
    if (is_file(path)) {
      read(obj, path);
    } else {
      model_.warnings.push_back(
          fmt::format("{}: the material library {} is missing", obj.path.string(), path.string()));
    }
  }
}

void MaterialLibrary::read(const Source& obj, const fs::path& path) {
  const Source source = read_source(path);
  TextReader text(source, {});
  Statements material;
  bool begun = false;
  const auto finish = [&] {
    if (!begun) return;
    const auto at = static_cast<int>(model_.materials.size());
    if (!index_.try_emplace(material.name, at).second) return;
    MaterialDescription out = make_material(material, model_);
    add_maps(material, obj, path, textures_, out);
    model_.materials.push_back(out);
  };
  while (text.next_line()) {
    const std::string_view key = text.word();
    if (key == "newmtl") {
      finish();
      material = {};
      material.name = text.rest();
      begun = true;
      if (material.name.empty())
        model_.warnings.push_back(
            fmt::format("{}: line {}: newmtl without a name: only a usemtl without a name "
                        "takes it",
                        path.string(), text.line()));
    } else if (begun) {
      read_statement(text, key, material);
      note_unread(text, key, model_);
    }
  }
  finish();
}

// One warning for all of them: without its library a file has none of its materials.
void MaterialLibrary::warn_undefined(std::string_view name) {
  constexpr std::size_t shown = 5;
  if (++undefined_ == 1) {
    warning_ = model_.warnings.size();
    model_.warnings.emplace_back();
  }
  if (undefined_ <= shown) names_ += fmt::format("{}'{}'", undefined_ == 1 ? "" : ", ", name);
  model_.warnings[warning_] =
      fmt::format("not defined, and drawn with the default material: {}{}", names_,
                  undefined_ > shown ? fmt::format(" and {} more", undefined_ - shown) : "");
}

int MaterialLibrary::find(std::string_view name) {
  if (const auto found = index_.find(name); found != index_.end()) return found->second;
  index_.emplace(name, -1);
  warn_undefined(name);
  return -1;
}

}  // namespace sundog::models
