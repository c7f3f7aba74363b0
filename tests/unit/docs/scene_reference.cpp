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

/// A section of the page: its heading, a line under it, and the kinds ($defs) that it describes. A choice by
/// "type" stands for its kinds.
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
      {"Lights", "An entry of `lights` has one of these types.", {"light", "falloff"}},
      {"Environment",
       "`environment` has one of these types.",
       {"environment", "crystals", "sun", "halo_sun"}},
      {"Media and materials",
       "",
       {"medium", "absorption", "material", "openpbr_material", "normal_map", "bump_map", "parallax_map",
        "displacement_map", "checker", "term", "specular_term", "ray_term"}},
      {"Textures",
       "An entry of `textures` has one of these types.",
       {"preset_texture", "texture", "ramp_stop"}},
      {"Meshes", "", {"mesh", "generate", "generate_ice_cavity"}},
      {"Objects",
       "An entry of `objects` is one of these or a [distance field](#distance-fields).",
       {"solid", "object", "transform_step", "rotate", "turns_by"},
       {"placed", "moving"},
       "Every object"},
      {"Distance fields",
       "Each is an object, or stands inside another field, with only the keys that say which field it is.",
       {"any_field", "step", "formula_parameter", "field_entry", "interval", "ball", "coloring", "glow"},
       {"marched"},
       "Every field",
       "field"},
      {"Animation", "An entry of `animate` has one of these types.", {"track", "track_key", "track_handle"}}};
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
      if (has_keys(kind)) find_choices(kind, name);
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
  /// How an object comes to be of a kind: by its "type" among those of another kind.
  struct Choice {
    std::string among, type;
    bool alone;  // no other type leads to the kind
  };

  void find_choices(const ordered_json& node, const std::string& among) {
    for (const ordered_json& part : member(node, "allOf")) {
      if (!part.contains("if")) {
        find_choices(words_.target(part), among);
      } else {
        const auto types = types_of(part);
        choices_.try_emplace(kind_of(part), Choice{among, types.front(), types.size() == 1});
      }
    }
  }

  std::vector<std::string> types_of(const ordered_json& part) const {
    return words_.names(part["if"]["properties"]["type"]);
  }
  static std::string kind_of(const ordered_json& part) {
    return part["then"]["$ref"].get<std::string>().substr(std::string_view("#/$defs/").size());
  }

  /// The kinds of a group, without those that stand in tables for all.
  std::vector<std::string> kinds_of(const Group& group) const {
    const auto is_common = [&](const std::string& kind) {
      return std::ranges::any_of(groups(), [&](const Group& other) {
        return std::ranges::find(other.common, kind) != other.common.end();
      });
    };
    std::vector<std::string> kinds;
    for (const std::string& name : group.kinds) {
      if (!is_choice(kinds_.at(name))) kinds.push_back(name);
      for (const ordered_json& part : member(kinds_.at(name), "allOf"))
        if (part.contains("if") && !is_common(kind_of(part))) kinds.push_back(kind_of(part));
    }
    return kinds;
  }

  static bool is_choice(const ordered_json& kind) {
    return std::ranges::any_of(member(kind, "allOf"), [](const auto& part) { return part.contains("if"); });
  }

  void check_places() const {
    std::set<std::string> placed;
    for (const Group& group : groups())
      for (const auto& kinds : {group.common, kinds_of(group)}) placed.insert(kinds.begin(), kinds.end());
    for (const auto& [name, kind] : kinds_.items())
      if (!placed.contains(name) && (choices_.contains(name) || (has_keys(kind) && !is_choice(kind))))
        throw std::runtime_error("$defs/" + name +
                                 " of the schema needs a section in tests/unit/docs/scene_reference.cpp");
  }

  /// Adds the keys of a node, and of those that its "allOf" names for this type; the first rule for a key
  /// counts.
  void take_in(const ordered_json& node, const std::string& type, Keys& keys) const {
    if (node.contains("$ref")) take_in(words_.target(node), type, keys);
    for (const auto& [key, rule] : member(node, "properties").items())
      if (!keys.find(key)) keys.rules.emplace_back(key, rule);
    for (const ordered_json& key : member(node, "required")) keys.required.insert(key.get<std::string>());
    for (const ordered_json& part : member(node, "allOf")) {
      if (!part.contains("if")) {
        take_in(part, type, keys);
      } else if (const auto types = types_of(part); std::ranges::find(types, type) != types.end()) {
        take_in(part["then"], type, keys);
      }
    }
  }

  /// All keys of a kind, in the schema's order; its own rules count before those of its choice.
  Keys keys_of(const std::string& name) const {
    Keys own, keys;
    take_in(kinds_.at(name), "", own);
    const auto found = choices_.find(name);
    if (found == choices_.end()) return own;
    const auto& [among, type, alone] = found->second;
    if (alone) own.rules.emplace_back("type", ordered_json{{"const", type}});
    take_in(kinds_.at(among), type, keys);
    for (auto& [key, rule] : keys.rules)
      if (const ordered_json* better = own.find(key)) rule = *better;
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

  void write(const Group& group) {
    out_ += "\n## " + group.title + "\n";
    if (!group.about.empty()) out_ += "\n" + group.about + "\n";
    if (!group.choice.empty()) out_ += "\n" + words_.meaning(kinds_.at(group.choice)) + "\n";
    if (!group.common.empty()) {
      out_ += "\n### " + group.common_title + "\n";
      write_table(common_keys(group));
    }
    for (const std::string& name : kinds_of(group)) write_kind(name);
  }

  void write_kind(const std::string& name) {
    Keys keys = keys_of(name);
    out_ += "\n### " + spaced(name) + "\n\n";
    if (const ordered_json* type = keys.find("type"); type && type->contains("const")) {
      out_ += fmt::format("`\"type\": {}`. ", (*type)["const"].dump());
      std::erase_if(keys.rules, [](const auto& row) { return row.first == "type"; });
    }
    out_ += kinds_.at(name).value("description", "") + "\n";
    const std::string shared = take_out_common(keys);
    if (!keys.rules.empty()) write_table(keys);
    out_ += shared;
  }

  /// Takes out the keys that stand in a group's table. Returns the line that says where they are.
  std::string take_out_common(Keys& keys) const {
    std::vector<std::string> links;
    for (const Group& group : groups()) {
      const Keys common = common_keys(group);
      if (common.rules.empty() ||
          !std::ranges::all_of(common.rules, [&](const auto& row) { return keys.find(row.first); }))
        continue;
      links.push_back(link_to(group.common_title));
      std::erase_if(keys.rules, [&](const auto& row) {
        const ordered_json* rule = common.find(row.first);
        return rule && *rule == row.second && !keys.required.contains(row.first);
      });
    }
    return links.empty() ? "" : fmt::format("\nAlso the keys of {}.\n", fmt::join(links, " and "));
  }

  const ordered_json& kinds_;
  SchemaWords words_;
  std::map<std::string, Choice> choices_;  // by kind
  std::string out_;
};

}  // namespace

std::string scene_reference(const ordered_json& schema) { return Page(schema).text(); }
