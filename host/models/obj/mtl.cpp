// Reads MTL material libraries (Wavefront, "MTL material format", 1995) as phong materials, dielectrics and
// their media, or as glTF's materials for PBR statements (mtl_pbr.h). Colours are taken as linear.
#include "models/obj/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/names.h"
#include "models/beside.h"
#include "models/obj/mtl_pbr.h"
#include "models/readers.h"
#include "models/text.h"

namespace sundog::models {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view unread_forms[] = {"spectral", "xyz"};

// "Kd r g b", or "Kd r" for grey. Spectral files and CIE XYZ keep the default.
std::optional<dvec3> read_color(TextReader& text) {
  TextReader peek = text;
  const std::string_view form = peek.word();
  if (std::ranges::count(unread_forms, form) > 0) return std::nullopt;
  const double red = text.number("red");
  if (text.at_line_end()) return glm::max(dvec3(red), dvec3(0));
  const double green = text.number("green"), blue = text.number("blue");
  return glm::max(dvec3(red, green, blue), dvec3(0));
}

/// Map statements that are read.
constexpr std::string_view read_maps[] = {"map_kd",   "map_ka", "map_ks", "map_ke", "map_d",
                                          "map_bump", "bump",   "norm",   "map_kn", "map_disp",
                                          "disp",     "map_ns", "map_pr", "map_pm", "map_ps"};
constexpr std::pair<std::string_view, const char*> unread_properties[] = {
    {"map_tr", "alpha of textures"},  {"decal", "decals"},
    {"refl", "reflection maps"},      {"map_refl", "reflection maps"},
    {"map_pc", "clearcoat textures"}, {"map_pcr", "clearcoat textures"}};

/// Notes a statement that is not read. Zeros mean that the feature is unused.
void note_unread(TextReader text, std::string_view key, MtlStatements& m) {
  const auto all_zero = [&] {
    while (!text.at_line_end())
      if (const std::string_view word = text.word(); word.find_first_not_of("0.+-") != word.npos)
        return false;
    return true;
  };
  if (key == "kd" || key == "ks" || key == "ka" || key == "ke" || key == "tf")
    if (TextReader peek = text; std::ranges::count(unread_forms, peek.word()) > 0)
      m.unread.emplace(key, "spectral and CIE XYZ colours");
  for (const auto& [word, feature] : unread_properties)
    if (key == word && !all_zero()) m.unread.emplace(key, feature);
}

double read_opacity(TextReader& text) {
  TextReader peek = text;
  if (peek.word() == "-halo") text.word();
  return std::clamp(text.number("d"), 0.0, 1.0);
}

/// `key` is in lower case, because programs differ in case.
void read_statement(TextReader& text, std::string_view key, MtlStatements& m) {
  if (key == "ka") m.ambient = read_color(text);
  if (key == "kd") m.diffuse = read_color(text);
  if (key == "ks") m.specular = read_color(text);
  if (key == "tf") m.filter = read_color(text);
  if (key == "ke") m.emission = read_color(text);
  if (std::ranges::count(read_maps, key) > 0)
    if (const auto map = read_mtl_map(text)) {
      const bool normals = m.of_blender && key == "map_bump";  // Blender writes its normal maps so
      m.maps.insert_or_assign(std::string(normals ? "norm" : key), *map);
    }
  if (std::ranges::count(pbr_numbers, key) > 0) m.pbr.insert_or_assign(std::string(key), text.number(key));
  if (key == "ns") m.exponent = std::max(text.number("Ns"), 0.0);
  if (key == "ni") m.ior = text.number("Ni");
  if (key == "d") m.opacity = read_opacity(text);
  if (key == "tr") m.transparency = std::clamp(text.number("Tr"), 0.0, 1.0);
  if (key == "illum")
    m.illumination = static_cast<int>(std::clamp<std::int64_t>(text.integer("illum"), 0, 10));
}

/// MeshLab writes Tr 1 for opaque materials; nobody defines an invisible one.
bool is_opaque_by_tr(const MtlStatements& m) { return !m.opacity && m.transparency == 1; }

/// Some programs write Tr for d, the format's own keyword.
double opacity_of(const MtlStatements& m) {
  return is_opaque_by_tr(m) ? 1 : m.opacity.value_or(1 - m.transparency.value_or(0));
}

/// With -bm, true displacement by that many model units; otherwise a bump map, because files rarely give a
/// height.
void add_displacement(const MtlStatements& m, const Source& obj, MtlTextures& textures,
                      MaterialDescription& out) {
  for (const char* key : {"map_disp", "disp"})
    if (const auto found = m.maps.find(key); found != m.maps.end()) {
      MtlMap map = found->second;
      if (map.channel < 0) map.channel = 0;
      if (!map.has_bump && out.textures.height >= 0) continue;
      const int heights = textures.use(map, false, obj, m.library);
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

/// Bump and normal maps. The format gives heights no unit: a height of 1 is a hundredth of a unit of u and v,
/// times -bm.
void add_relief_maps(const MtlStatements& m, const Source& obj, MtlTextures& textures,
                     MaterialDescription& out) {
  for (const char* key : {"norm", "map_kn"})
    if (const auto found = m.maps.find(key); found != m.maps.end()) {
      out.textures.normal = textures.use(found->second, false, obj, m.library);
      out.normal_scale = found->second.bump;
    }
  for (const char* key : {"bump", "map_bump"})
    if (const auto found = m.maps.find(key); found != m.maps.end()) {
      MtlMap map = found->second;
      if (map.channel < 0) map.channel = 0;
      out.textures.height = textures.use(map, false, obj, m.library);
      out.bump = 0;
      out.bump_uv = 0.01 * map.bump;
    }
}

// Illumination models 0 and 1 have no highlight. Exporters write "Ns 0" for dull materials, whatever Ks they
// write.
bool has_highlight(const MtlStatements& m) { return m.illumination >= 2 && m.exponent > 0; }

void add_opacity_map(const MtlStatements& m, const Source& obj, MtlTextures& textures,
                     MaterialDescription& out) {
  const auto alpha = m.maps.find("map_d");
  if (alpha == m.maps.end() || out.medium >= 0) return;
  MtlMap map = alpha->second;
  const auto color = m.maps.find("map_kd");
  const bool of_color = color != m.maps.end() && color->second.file == map.file;
  if (map.channel < 0) map.channel = of_color ? 3 : 0;
  out.textures.opacity = textures.use(map, of_color, obj, m.library);
}

/// The textures of a material; a term with a texture and no colour is white.
void add_maps(const MtlStatements& m, const Source& obj, MtlTextures& textures, MaterialDescription& out) {
  const auto use = [&](const char* key) {
    const auto found = m.maps.find(key);
    return found == m.maps.end() ? -1 : textures.use(found->second, true, obj, m.library);
  };
  MaterialTextures& to = out.textures;
  to.diffuse = use("map_kd");
  to.ambient = m.maps.contains("map_ka") ? use("map_ka") : to.diffuse;
  if (has_highlight(m)) to.specular = use("map_ks");
  to.emission = use("map_ke");
  if (to.diffuse >= 0 && !m.diffuse) out.diffuse = dvec3(1);
  if (to.specular >= 0 && !m.specular) out.specular = dvec3(1);
  if (to.emission >= 0 && !m.emission) out.emission = dvec3(1);
  if (const auto shine = m.maps.find("map_ns"); shine != m.maps.end())
    to.exponent = textures.use(shine->second, false, obj, m.library);
  add_relief_maps(m, obj, textures, out);
  add_displacement(m, obj, textures, out);
  add_opacity_map(m, obj, textures, out);
}

// Illumination models: 3 to 8 trace reflections; 4, 6, 7 and 9 are glass; 5 and 7 use Fresnel's equations.
MaterialDescription make_material(const MtlStatements& m, Model& model) {
  const int illum = m.illumination;
  const double opacity = opacity_of(m);
  const bool traced = illum >= 4 && illum <= 7, fresnel = illum == 5 || illum == 7;
  const bool glass = opacity < 1 || (m.filter && (traced || illum == 9) && *m.filter != dvec3(0));
  MaterialDescription out;
  out.name = m.name;
  if (m.diffuse) out.ambient *= *m.diffuse / out.diffuse;  // without Ka: Kd's colour
  out.ambient = m.ambient.value_or(out.ambient);
  out.diffuse = m.diffuse.value_or(out.diffuse);
  out.specular = m.specular.value_or(out.specular);
  out.exponent = m.exponent;
  out.emission = m.emission.value_or(out.emission);
  if (illum >= 3 && illum <= 8) out.reflection = glm::min(out.specular, dvec3(1));
  if (!has_highlight(m)) out.specular = dvec3(0);
  if (glass) {
    const dvec3 filter = glm::min(m.filter.value_or(dvec3(1)), dvec3(1));
    out.transmission = opacity < 1 && !(fresnel && m.filter) ? (1 - opacity) * filter : filter;
    out.ambient *= opacity;
    out.diffuse *= opacity;
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

/// Adds a material of PBR statements with its relief and opacity.
int add_pbr_material(const MtlStatements& m, const Source& obj, MtlTextures& textures, Model& model) {
  const double opacity = opacity_of(m);
  const int index = add_pbr(m, m.has_map("map_d") ? 1 : opacity, obj, textures, model);
  MaterialDescription mapped;
  add_relief_maps(m, obj, textures, mapped);
  add_displacement(m, obj, textures, mapped);
  add_opacity_map(m, obj, textures, mapped);
  MaterialDescription& to = model.materials[static_cast<std::size_t>(index)];
  to.textures.normal = mapped.textures.normal, to.normal_scale = mapped.normal_scale;
  to.textures.height = mapped.textures.height, to.bump = mapped.bump, to.bump_uv = mapped.bump_uv;
  to.displaced_by = mapped.displaced_by, to.displacement = mapped.displacement;
  to.textures.opacity = mapped.textures.opacity;
  if (m.has_map("map_d")) to.opacity = opacity;
  return index;
}

// An mtllib line holds one name, perhaps with blanks, or several names that end in ".mtl".
std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> parts;
  while (!names.empty()) {
    const std::size_t end = lower_case(names).find(".mtl ");
    parts.emplace_back(names.substr(0, end == names.npos ? end : end + 4));
    names.remove_prefix(end == names.npos ? names.size() : end + 5);
    names.remove_prefix(std::min(names.find_first_not_of(" \t"), names.size()));
  }
  return parts;
}

}  // namespace

MaterialLibrary::MaterialLibrary(Model& model) : model_(model), textures_(model) {}
MaterialLibrary::~MaterialLibrary() = default;

void MaterialLibrary::load(const Source& obj, const TextReader& line, std::string_view names) {
  const fs::path folder = obj.path.parent_path();
  if (const auto whole = find_beside(obj, folder, names, model_.warnings)) return read(*whole);
  for (const std::string& name : split_names(before_comment(names)))
    if (const auto path = find_beside(obj, folder, name, model_.warnings))
      read(*path);
    else
      model_.warnings.push_back(
          fmt::format("line {}: the material library {}", line.line(), why_not_beside(obj, folder, name)));
}

// The first definition of a name counts.
void MaterialLibrary::read(const fs::path& path) {
  const Source source = read_source(path);
  TextReader text(source, {});
  MtlStatements again, *material = nullptr;
  while (text.next_line()) {
    const std::string key = text.keyword();
    if (key == "newmtl") {
      const std::string name(text.rest());
      if (name.empty())
        model_.warnings.push_back(
            fmt::format("{}: line {}: newmtl without a name: only a usemtl without a name takes it",
                        path.string(), text.line()));
      const auto [stated, added] = stated_.try_emplace(name);
      material = added ? &stated->second : &again;
      material->name = name;
      material->library = path;
      material->of_blender = source.bytes.starts_with("# Blender");
    } else if (material) {
      read_statement(text, key, *material);
      note_unread(text, key, *material);
    }
  }
}

// One warning for all: without its library, a file lacks all materials.
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

int MaterialLibrary::find(const Source& obj, std::string_view name) {
  if (const auto found = index_.find(name); found != index_.end()) return found->second;
  auto stated = stated_.find(name);
  if (stated == stated_.end()) stated = stated_.find(before_comment(name));
  int index = -1;
  if (stated == stated_.end()) {
    warn_undefined(name);
  } else if (const auto known = index_.find(stated->first); known != index_.end()) {
    index = known->second;
  } else {
    index = add(obj, stated->second);
    index_.emplace(stated->first, index);
  }
  index_.emplace(name, index);
  return index;
}

int MaterialLibrary::add(const Source& obj, const MtlStatements& stated) {
  for (const auto& [key, feature] : stated.unread) leave_unread(model_, feature);
  if (is_opaque_by_tr(stated))
    model_.warnings.push_back(fmt::format("{}: the material '{}' has Tr 1 and no d: it is taken as opaque",
                                          stated.library.string(), stated.name));
  if (stated.opacity && stated.transparency && std::abs(*stated.opacity + *stated.transparency - 1) > 1e-6)
    model_.warnings.push_back(
        fmt::format("{}: the material '{}' has d {:g} and Tr {:g}, which differ: d counts",
                    stated.library.string(), stated.name, *stated.opacity, *stated.transparency));
  if (const dvec3 kd = stated.diffuse.value_or(dvec3(0)); std::max({kd.x, kd.y, kd.z}) > 1.001)
    model_.warnings.push_back(fmt::format(
        "{}: the material '{}' has Kd {:g} {:g} {:g}: a colour is three shares of 1; if these are "
        "bytes, divide by 255",
        stated.library.string(), stated.name, kd.x, kd.y, kd.z));
  if (has_pbr(stated)) return add_pbr_material(stated, obj, textures_, model_);
  MaterialDescription material = make_material(stated, model_);
  add_maps(stated, obj, textures_, material);
  const auto index = static_cast<int>(model_.materials.size());
  model_.materials.push_back(material);
  return index;
}

}  // namespace sundog::models
