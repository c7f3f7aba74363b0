// Puts types, ranges and defaults of the schema into words.
#include "schema_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

using nlohmann::ordered_json;

namespace {

/// The name of each choice by "type", with its link.
const std::map<std::string, std::string>& choices() {
  static const std::map<std::string, std::string> all{
      {"light", "[light](#lights)"},          {"environment", "[environment](#environment)"},
      {"texture", "[texture](#textures)"},    {"object", "[object](#objects)"},
      {"field", "[field](#distance-fields)"}, {"step", "[step](#fractal-step)"},
      {"track", "[track](#animation)"},       {"generate", "[ice block](#generate-ice-block)"}};
  return all;
}

/// Values that have a name of their own.
const std::map<std::string, std::string>& value_names() {
  static const std::map<std::string, std::string> all{{"vec3", "[x, y, z]"},
                                                      {"direction", "[x, y, z]"},
                                                      {"color", "colour"},
                                                      {"share_color", "colour, each 0 to 1"},
                                                      {"formula_text", "formula text"}};
  return all;
}

std::string number_text(const ordered_json& value) {
  const double x = value.get<double>();
  return std::abs(x) < 1e10 && x == std::floor(x) ? fmt::format("{}", static_cast<long long>(x))
                                                  : fmt::format("{:g}", x);
}

std::string value_text(const ordered_json& value) {
  if (value.is_number()) return number_text(value);
  if (!value.is_array()) return value.dump();
  std::vector<std::string> items;
  for (const ordered_json& item : value) items.push_back(value_text(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string plural(const std::string& noun) {
  const auto at = noun.starts_with("[") ? noun.find(']') : noun.find(',');
  const std::string name = noun.substr(0, at);
  if (name.ends_with('s')) return noun;
  if (at == std::string::npos) return name + "s";
  return fmt::format("{}s{}", name, noun.substr(at));
}

/// A number's limits; those of 1e18 and more are none.
std::string limits_text(const ordered_json& rule) {
  const auto limit = [&](const char* key) -> std::optional<std::string> {
    if (!rule.contains(key) || std::abs(rule[key].get<double>()) >= 1e18) return {};
    return number_text(rule[key]);
  };
  const auto low = limit("minimum"), high = limit("maximum"), above = limit("exclusiveMinimum"),
             below = limit("exclusiveMaximum");
  if (low && high) return fmt::format(", {} to {}", *low, *high);
  std::vector<std::string> parts;
  if (low) parts.push_back(fmt::format("at least {}", *low));
  if (above) parts.push_back(fmt::format("above {}", *above));
  if (high) parts.push_back(fmt::format("at most {}", *high));
  if (below) parts.push_back(fmt::format("below {}", *below));
  return parts.empty() ? "" : fmt::format(", {}", fmt::join(parts, ", "));
}

}  // namespace

std::string spaced(std::string name) {
  for (char& c : name)
    if (c == '_') c = ' ';
  return name;
}

std::string link_to(const std::string& kind) {
  std::string anchor = kind;
  for (char& c : anchor) c = c == '_' || c == ' ' ? '-' : static_cast<char>(std::tolower(c));
  std::string title = spaced(kind);
  title[0] = static_cast<char>(std::tolower(title[0]));
  return fmt::format("[{}](#{})", title, anchor);
}

bool has_keys(const ordered_json& kind) {
  const auto closed = [&](const char* keyword) { return kind.contains(keyword) && kind[keyword] == false; };
  return kind.contains("properties") && (closed("additionalProperties") || closed("unevaluatedProperties"));
}

const ordered_json& SchemaWords::target(const ordered_json& rule) const {
  return kinds_.at(rule.at("$ref").get<std::string>().substr(std::string("#/$defs/").size()));
}

std::vector<std::string> SchemaWords::names(const ordered_json& rule) const {
  if (rule.contains("$ref")) return names(target(rule));
  if (rule.contains("const")) return {rule["const"]};
  std::vector<std::string> all = rule.value("enum", std::vector<std::string>());
  if (rule.contains("anyOf"))
    for (const ordered_json& option : rule["anyOf"])
      for (const std::string& name : names(option)) all.push_back(name);
  return all;
}

std::string SchemaWords::type(const ordered_json& rule) const {
  if (rule.contains("$ref"))
    return reference(rule.at("$ref").get<std::string>().substr(std::string("#/$defs/").size()));
  if (rule.contains("anyOf")) return options(rule["anyOf"]);
  if (rule.contains("if")) return options({rule["else"], rule["then"]});
  if (rule.contains("enum")) return fmt::format("`{}`", fmt::join(names(rule), "`, `"));
  const std::string name = rule.at("type");
  if (name == "number" || name == "integer")
    return fmt::format("{}{}", name == "number" ? "number" : "whole number", limits_text(rule));
  if (name == "boolean") return "`true`, `false`";
  if (name == "string") return "text";
  if (name == "array") return array(rule);
  if (name == "object")
    return rule.contains("additionalProperties")
               ? fmt::format("names, each with {}", type(rule["additionalProperties"]))
               : "names, each with a value";
  throw std::runtime_error("no words for the type " + name);
}

std::string SchemaWords::reference(const std::string& name) const {
  if (choices().contains(name)) return choices().at(name);
  if (value_names().contains(name)) return value_names().at(name);
  return has_keys(kinds_.at(name)) ? link_to(name) : type(kinds_.at(name));
}

std::string SchemaWords::options(const ordered_json& all) const {
  std::vector<std::string> texts;
  for (const ordered_json& option : all) texts.push_back(type(option));
  return fmt::format("{}", fmt::join(texts, "; or "));
}

std::string SchemaWords::array(const ordered_json& rule) const {
  const std::string items = rule.contains("items") ? plural(type(rule["items"])) : "numbers";
  const auto least = rule.value("minItems", 0), most = rule.value("maxItems", 0);
  if (least > 0 && least == most) return fmt::format("{} {}", least, items);
  if (most > 0) return fmt::format("list of {} to {} {}", least, most, items);
  return least > 1 ? fmt::format("list of {} or more {}", least, items) : fmt::format("list of {}", items);
}

std::string SchemaWords::meaning(const ordered_json& rule) const {
  if (rule.contains("description")) return rule["description"];
  return rule.contains("$ref") ? meaning(target(rule)) : "";
}

std::string SchemaWords::default_value(const ordered_json& rule) const {
  if (rule.contains("default")) {
    const ordered_json& value = rule["default"];
    return fmt::format("`{}`", value.is_string() ? value.get<std::string>() : value_text(value));
  }
  return rule.contains("$ref") ? default_value(target(rule)) : "";
}
