// Writes the page of the scene reference from the schema, section by section.
#include "scene_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
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
  std::vector<std::string> common{};  // kinds that all take in, described once,
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
       {"placed", "moving"},
       "Every object"},
      {"Distance fields",
       "Each is an object, or stands inside another field, with only the keys that say which field it is.",
       {"fractal", "formula", "hybrid", "union", "intersection", "difference", "moved", "repeat", "thicken",
        "shell", "native", "fractal_step", "formula_step", "formula_parameter", "field_entry", "interval",
        "ball", "coloring", "glow"},
       {"marched"},
       "Every field",
       "field"},
      {"Animation",
       "An entry of `animate` has one of these types.",
       {"keyed_track", "rotate_track", "track_key", "track_handle"}}};
  return all;
}

/// The value of a keyword; null if the node lacks it.
const ordered_json& member(const ordered_json& node, const char* keyword) {
  static const ordered_json none;
  const auto found = node.find(keyword);
  return found == node.end() ? none : *found;
}

/// An object's keys.
struct Keys {
  std::vector<std::pair<std::string, ordered_json>> rules;
  std::set<std::string> required;

  const ordered_json* find(const std::string& key) const {
    const auto found = std::ranges::find(rules, key, [](const auto& rule) { return rule.first; });
    return found == rules.end() ? nullptr : &found->second;
  }
};

class Page {
 public:
  explicit Page(const ordered_json& schema) : kinds_(schema.at("$defs")), words_(kinds_) {
    for (const auto& [name, kind] : kinds_.items())
      if (has_keys(kind) && kind["properties"].contains("type"))
        for (const std::string& type : words_.names(kind["properties"]["type"])) find_choices(kind, name, type);
  }

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
  /// How an object comes to be of a kind: by its "type" in an object of a kind that has others.
  struct Choice {
    std::string among, type;
    bool alone;  // no other type leads to the kind
  };

  /// Notes which kinds an object of this "type" is of.
  void find_choices(const ordered_json& node, const std::string& among, const std::string& type) {
    for (const ordered_json& part : member(node, "allOf")) {
      if (!part.contains("if")) {
        find_choices(words_.target(part), among, type);
      } else if (const auto types = words_.names(part["if"]["properties"]["type"]);
                 std::ranges::find(types, type) != types.end()) {
        const std::string kind = part["then"]["$ref"].get<std::string>().substr(8);
        choices_.try_emplace(kind, Choice{among, type, types.size() == 1});
      }
    }
  }

  void check_places() const {
    std::set<std::string> placed;
    for (const Group& group : groups())
      for (const auto& kinds : {group.kinds, group.common}) placed.insert(kinds.begin(), kinds.end());
    for (const auto& [name, kind] : kinds_.items())
      if (!placed.contains(name) && (choices_.contains(name) || (has_keys(kind) && !is_choice(name))))
        throw std::runtime_error("$defs/" + name +
                                 " of the schema needs a section in tests/unit/docs/scene_reference.cpp");
  }

  bool is_choice(const std::string& name) const {
    return std::ranges::any_of(choices_, [&](const auto& one) { return one.second.among == name; });
  }

  /// Adds the keys of a node, and of those that its "allOf" names for this type; the first rule for a key
  /// counts.
  void take_in(const ordered_json& node, const std::string& type, Keys& keys) const {
    if (node.contains("$ref")) take_in(words_.target(node), type, keys);
    for (const auto& [key, rule] : member(node, "properties").items())
      if (!keys.find(key)) keys.rules.emplace_back(key, rule);
    for (const ordered_json& key : member(node, "required"))
      keys.required.insert(key.get<std::string>());
    for (const ordered_json& part : member(node, "allOf")) {
      if (!part.contains("if")) {
        take_in(part, type, keys);
      } else if (const auto types = words_.names(part["if"]["properties"]["type"]);
                 std::ranges::find(types, type) != types.end()) {
        take_in(part["then"], type, keys);
      }
    }
  }

  /// All keys of a kind, its own first.
  Keys keys_of(const std::string& name) const {
    Keys keys;
    take_in(kinds_.at(name), "", keys);
    if (const auto choice = choices_.find(name); choice != choices_.end())
      take_in(kinds_.at(choice->second.among), choice->second.type, keys);
    return keys;
  }

  Keys common_keys(const Group& group) const {
    Keys keys;
    for (const std::string& name : group.common) take_in(kinds_.at(name), "", keys);
    return keys;
  }

  /// A bar would end the cell of a table.
  static std::string in_cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
    return escaped;
  }

  void write_table(const Keys& keys) {
    out_ += "\n| key | value | default | meaning |\n|---|---|---|---|\n";
    for (const auto& [key, rule] : keys.rules)
      out_ += fmt::format("| `{}` | {} | {} | {} |\n", key, words_.type(rule),
                          keys.required.contains(key) ? "**required**" : words_.default_value(rule),
                          in_cell(words_.meaning(rule)));
  }

  /// The kind's keys without a "type" of one choice, and without those that stand in a group's table already.
  Keys own_keys(const std::string& name) const {
    Keys keys = keys_of(name);
    const Keys base = keys_of_base(name);
    std::erase_if(keys.rules, [&](const auto& row) {
      const auto& [key, rule] = row;
      if (key == "type" && (choices_.contains(name) ? choices_.at(name).alone : rule.contains("const")))
        return true;
      return has(base, row) || (is_common(row) && !keys.required.contains(key));
    });
    return keys;
  }

  static bool has(const Keys& keys, const std::pair<std::string, ordered_json>& row) {
    const ordered_json* rule = keys.find(row.first);
    return rule && *rule == row.second;
  }

  /// The keys of the formula that a step is one of: of "formula" for "formula_step".
  Keys keys_of_base(const std::string& name) const {
    return name.ends_with("_step") && choices_.contains(name) ? keys_of(base_of(name)) : Keys();
  }
  static std::string base_of(const std::string& name) { return name.substr(0, name.size() - 5); }

  bool is_common(const std::pair<std::string, ordered_json>& row) const {
    return std::ranges::any_of(groups(), [&](const Group& group) { return has(common_keys(group), row); });
  }

  void write(const Group& group) {
    out_ += "\n## " + group.title + "\n";
    if (!group.about.empty()) out_ += "\n" + group.about + "\n";
    if (!group.choice.empty()) out_ += "\n" + words_.meaning(kinds_.at(group.choice)) + "\n";
    if (!group.common.empty()) {
      out_ += "\n### " + group.common_title + "\n";
      write_table(common_keys(group));
    }
    for (const std::string& name : group.kinds) write_kind(name);
  }

  void write_kind(const std::string& name) {
    out_ += "\n### " + spaced(name) + "\n\n";
    const auto choice = choices_.find(name);
    const ordered_json& type = member(member(kinds_.at(name), "properties"), "type");
    if (choice != choices_.end() && choice->second.alone)
      out_ += fmt::format("`\"type\": \"{}\"`. ", choice->second.type);
    else if (type.contains("const"))
      out_ += fmt::format("`\"type\": {}`. ", type["const"].dump());
    out_ += kinds_.at(name).value("description", "") + "\n";
    if (const Keys own = own_keys(name); !own.rules.empty()) write_table(own);
    write_shared(name);
  }

  /// Where the kind's other keys are described.
  void write_shared(const std::string& name) {
    std::vector<std::string> links, of_base;
    const Keys keys = keys_of(name), base = keys_of_base(name);
    for (const Group& group : groups())
      if (const Keys common = common_keys(group);
          std::ranges::any_of(keys.rules, [&](const auto& row) { return has(common, row); }))
        links.push_back(link_to(group.common_title));
    for (const auto& row : keys.rules)
      if (has(base, row) && row.first != "type" && !is_common(row)) of_base.push_back("`" + row.first + "`");
    if (!of_base.empty())
      links.push_back(fmt::format("{}: {}", link_to(base_of(name)), fmt::join(of_base, ", ")));
    if (!links.empty()) out_ += fmt::format("\nAlso the keys of {}.\n", fmt::join(links, " and "));
  }

  const ordered_json& kinds_;
  SchemaWords words_;
  std::map<std::string, Choice> choices_;  // by kind
  std::string out_;
};

}  // namespace

std::string scene_reference(const ordered_json& schema) { return Page(schema).text(); }
