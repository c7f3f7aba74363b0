// Writes the page of the scene reference from the schema, section by section.
#include "scene_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <vector>

#include "schema_words.h"

using nlohmann::ordered_json;

namespace {

/// A section of the page: its heading, a line under it, and the kinds ($defs) that it describes.
struct Group {
  std::string title, about;
  std::vector<std::string> kinds;
  std::string model{};                // a kind whose `common` keys stand for those of all
  std::vector<std::string> common{};  // keys that are described once,
  std::string common_title{};         // under this heading
  std::string choice{};               // a choice by "type" that is described here
};

const std::vector<Group>& groups() {
  static const std::vector<Group> all{
      {"The scene", "", {"scene"}},
      {"Picture",
       "",
       {"camera", "lens", "view", "image", "tone_map", "gradient", "render", "path", "guide", "adaptive",
        "subsample", "world", "fog"}},
      {"Lights",
       "An entry of `lights` has one of these types.",
       {"ambient_light", "directional_light", "point_light", "spot_light", "rectangle_light", "disk_light",
        "sphere_light", "falloff"}},
      {"Environment",
       "`environment` has one of these types.",
       {"image_environment", "gradient_environment", "sky_environment", "halo_environment", "crystals", "sun",
        "halo_sun"}},
      {"Media and materials",
       "",
       {"medium", "absorption", "material", "openpbr_material", "normal_map", "bump_map", "parallax_map",
        "displacement_map", "checker", "term", "specular_term", "ray_term"}},
      {"Textures",
       "An entry of `textures` has one of these types.",
       {"preset_texture", "image_texture", "vertex_color_texture", "checker_texture", "stripes_texture",
        "gradient_texture", "brick_texture", "noise_texture", "cells_texture", "marble_texture",
        "wood_texture", "formula_texture", "ramp_texture", "ramp_stop", "product_texture"}},
      {"Meshes",
       "",
       {"mesh", "generate_lathe", "generate_fill", "generate_extrusion", "generate_terrain", "generate_sweep",
        "generate_ice_block", "generate_ice_cavity"}},
      {"Objects",
       "An entry of `objects` is one of these or a [distance field](#distance-fields).",
       {"sphere", "plane", "box", "round_box", "cylinder", "cone", "disk", "rectangle", "torus", "lathe",
        "mesh_object", "model_object", "field_object", "group_object", "scatter_object", "transform_step",
        "rotate", "turns_by"},
       "sphere",
       {"name", "material", "transform", "moves_by", "turns_by", "grows_to"},
       "Every object"},
      {"Distance fields",
       "Each is an object, or stands inside another field, with only the keys that say which field it is.",
       {"fractal", "formula", "hybrid", "union", "intersection", "difference", "moved", "repeat", "thicken",
        "shell", "native", "fractal_step", "formula_step", "formula_parameter", "field_entry", "interval",
        "ball", "coloring", "glow"},
       "fractal",
       {"interval", "ball", "detail", "least_threshold", "greatest_threshold", "step_limit", "coloring",
        "occlusion", "soft_shadow", "glow"},
       "Every field",
       "field"},
      {"Animation",
       "An entry of `animate` has one of these types.",
       {"keyed_track", "rotate_track", "track_key", "track_handle"}}};
  return all;
}

class Page {
 public:
  explicit Page(const ordered_json& schema) : kinds_(schema.at("$defs")), words_(kinds_) {}

  std::string text() {
    check_places();
    out_ =
        "# Scene reference\n\n"
        "<!-- Written by docs/write_pages.sh from scenes/scene.schema.json. Edit the schema, then run it. "
        "-->\n\n"
        "Every key of a scene file. Lengths are in scene units, angles in degrees, colours linear [red, "
        "green, blue]. "
        "[Scenes](../guide/scenes.md) introduces the format.\n";
    for (const Group& group : groups()) write(group);
    return out_;
  }

 private:
  void check_places() const {
    std::set<std::string> placed;
    for (const Group& group : groups()) placed.insert(group.kinds.begin(), group.kinds.end());
    for (const auto& [name, kind] : kinds_.items())
      if (has_keys(kind) && !placed.contains(name) && !is_inner(name))
        throw std::runtime_error("$defs/" + name +
                                 " of the schema needs a section in tests/unit/docs/scene_reference.cpp");
  }

  /// A field inside another one, described with the object of the same name, of which it must be a part.
  bool is_inner(const std::string& name) const {
    if (!name.ends_with("_field")) return false;
    const std::string outer = name.substr(0, name.size() - 6);
    if (!kinds_.contains(outer)) return false;
    for (const auto& [key, rule] : kinds_[name]["properties"].items())
      if (kinds_[outer]["properties"].value(key, ordered_json()) != rule)
        throw std::runtime_error("$defs/" + name + " and $defs/" + outer + " of the schema differ in \"" +
                                 key + "\"");
    return true;
  }

  /// A bar would end the cell of a table.
  static std::string in_cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
    return escaped;
  }

  void write_table(const std::string& name, const std::vector<std::string>& keys) {
    const ordered_json& kind = kinds_.at(name);
    out_ += "\n| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const std::string& key : keys) {
      const ordered_json& rule = kind.at("properties").at(key);
      out_ += fmt::format("| `{}` | {} | {} | {} |\n", key, words_.type(rule),
                          is_required(kind, key) ? "**required**" : words_.default_value(rule),
                          in_cell(words_.meaning(rule)));
    }
  }

  /// The kind's keys without "type", and without those that stand in `group`'s table already.
  std::vector<std::string> own_keys(const std::string& name) const {
    std::vector<std::string> keys;
    const ordered_json& kind = kinds_.at(name);
    for (const auto& [key, rule] : kind.at("properties").items())
      if (!(key == "type" && rule.contains("const")) && !is_of_base(name, key, rule) &&
          (!is_common(key, rule) || is_required(kind, key)))
        keys.push_back(key);
    return keys;
  }

  /// The formula that a step is one of: "formula" for "formula_step".
  std::string base_of(const std::string& name) const {
    const std::string base = name.ends_with("_step") ? name.substr(0, name.size() - 5) : "";
    return kinds_.contains(base) && has_keys(kinds_[base]) ? base : "";
  }

  bool is_of_base(const std::string& name, const std::string& key, const ordered_json& rule) const {
    const std::string base = base_of(name);
    return !base.empty() && kinds_.at(base).at("properties").value(key, ordered_json()) == rule;
  }

  static bool is_required(const ordered_json& kind, const std::string& key) {
    const ordered_json required = kind.value("required", ordered_json::array());
    return std::find(required.begin(), required.end(), key) != required.end();
  }

  bool is_common(const std::string& key, const ordered_json& rule) const {
    for (const Group& group : groups())
      for (const std::string& common : group.common)
        if (key == common && rule == kinds_.at(group.model).at("properties").at(key)) return true;
    return false;
  }

  void write(const Group& group) {
    out_ += "\n## " + group.title + "\n";
    if (!group.about.empty()) out_ += "\n" + group.about + "\n";
    if (!group.choice.empty()) out_ += "\n" + words_.meaning(kinds_.at(group.choice)) + "\n";
    if (!group.common.empty()) {
      out_ += "\n### " + group.common_title + "\n";
      write_table(group.model, group.common);
    }
    for (const std::string& name : group.kinds) write_kind(name);
  }

  void write_kind(const std::string& name) {
    const ordered_json& kind = kinds_.at(name);
    out_ += "\n### " + spaced(name) + "\n\n";
    const auto& keys = kind.at("properties");
    if (keys.contains("type") && keys["type"].contains("const"))
      out_ += fmt::format("`\"type\": {}`. ", keys["type"]["const"].dump());
    out_ += kind.value("description", "") + "\n";
    const auto own = own_keys(name);
    if (!own.empty()) write_table(name, own);
    write_shared(name);
  }

  /// Where the kind's other keys are described.
  void write_shared(const std::string& name) {
    std::vector<std::string> links;
    const auto& keys = kinds_.at(name).at("properties");
    for (const Group& group : groups())
      for (const std::string& key : group.common)
        if (keys.contains(key) && is_common(key, keys.at(key))) {
          links.push_back(link_to(group.common_title));
          break;
        }
    std::vector<std::string> of_base;
    for (const auto& [key, rule] : keys.items())
      if (is_of_base(name, key, rule) && !rule.contains("const") && !is_common(key, rule))
        of_base.push_back("`" + key + "`");
    if (!of_base.empty())
      links.push_back(fmt::format("{}: {}", link_to(base_of(name)), fmt::join(of_base, ", ")));
    if (!links.empty()) out_ += fmt::format("\nAlso the keys of {}.\n", fmt::join(links, " and "));
  }

  const ordered_json& kinds_;
  SchemaWords words_;
  std::string out_;
};

}  // namespace

std::string scene_reference(const ordered_json& schema) { return Page(schema).text(); }
