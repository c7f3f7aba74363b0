// Compiles the embedded schema's JSON to rules, and describes them in words.
#include "scene/json/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

namespace sundog {
namespace {

using nlohmann::json;
using Type = SchemaRule::Type;

constexpr unsigned any_count = std::numeric_limits<unsigned>::max();
constexpr std::array<std::string_view, 7> type_names{"",       "object",  "array",  "string",
                                                     "number", "integer", "boolean"};

/// The value of a keyword; null if the node lacks it.
const json& member(const json& node, const char* keyword) {
  static const json none;
  const auto found = node.find(keyword);
  return found == node.end() ? none : *found;
}

/// The schema's text as rules, which may form cycles.
class Schema {
 public:
  Schema() : document_(json::parse(embedded_schema().front().bytes)) {
    for (const auto& [name, node] : document_.at("$defs").items()) kinds_.emplace(name, compile(node));
  }

  const SchemaRule* find(std::string_view kind) const {
    const auto found = kinds_.find(kind);
    return found == kinds_.end() ? nullptr : found->second;
  }

 private:
  const json& target(const json& node) const {
    const auto& pointer = node.at("$ref").get_ref<const std::string&>();
    return document_.at("$defs").at(pointer.substr(std::string_view("#/$defs/").size()));
  }

  /// The value of an annotation at a reference or at its target; nullptr if both lack it.
  const json* annotation(const json& node, const char* name) const {
    if (const auto found = node.find(name); found != node.end()) return &*found;
    return node.contains("$ref") ? annotation(target(node), name) : nullptr;
  }

  const SchemaRule* compile(const json& node) {
    if (node.contains("$ref")) return compile(target(node));
    const auto [found, is_new] = made_.try_emplace(&node, nullptr);
    if (!is_new) return found->second;
    SchemaRule& rule = rules_.emplace_back();
    found->second = &rule;
    if (node.contains("type"))
      rule.type = static_cast<Type>(
          std::ranges::find(type_names, node["type"].get_ref<const std::string&>()) - type_names.begin());
    if (node.contains("title")) rule.title = node["title"].get_ref<const std::string&>();
    if (node.contains("enum"))
      for (const json& name : node["enum"]) rule.names.emplace_back(name.get_ref<const std::string&>());
    if (node.contains("const")) rule.names.emplace_back(node["const"].get_ref<const std::string&>());
    if (!rule.names.empty()) rule.type = Type::string;
    if (node.contains("not") && node["not"].contains("enum")) rule.barred = &node["not"]["enum"];
    if (node.contains("pattern")) rule.pattern = node["pattern"].get_ref<const std::string&>();
    if (node.contains("anyOf") && !node.contains("properties")) compile_options(node["anyOf"], rule);
    rule.range = range_of(node);
    compile_array(node, rule);
    compile_object(node, rule);
    return &rule;
  }

  /// Adds the options; those that are names alone as one list of names.
  void compile_options(const json& options, SchemaRule& rule) {
    for (const json& option : options) rule.options.push_back(compile(option));
    if (std::ranges::any_of(rule.options, [](const SchemaRule* option) { return option->names.empty(); }))
      return;
    for (const SchemaRule* option : rule.options)
      rule.names.insert(rule.names.end(), option->names.begin(), option->names.end());
    rule.options.clear();
    rule.type = Type::string;
  }

  static Range range_of(const json& node) {
    constexpr double most = std::numeric_limits<double>::max();
    Range range{.low_open = node.contains("exclusiveMinimum"),
                .high_open = node.contains("exclusiveMaximum")};
    range.low = node.value(range.low_open ? "exclusiveMinimum" : "minimum", -most);
    range.high = node.value(range.high_open ? "exclusiveMaximum" : "maximum", most);
    return range;
  }

  void compile_array(const json& node, SchemaRule& rule) {
    if (node.contains("items")) rule.items = compile(node["items"]);
    rule.least_items = node.value("minItems", 0u);
    rule.most_items = node.value("maxItems", any_count);
  }

  /// Compiles an object's keys, and those of each "type" if that chooses among them.
  void compile_object(const json& node, SchemaRule& rule) {
    const bool depends = take_in(node, "", rule);
    const auto types = rule.keys.find("type");
    if (!depends || types == rule.keys.end()) return;
    for (const std::string_view type : types->second.rule->names) {
      SchemaRule& typed = rules_.emplace_back();
      typed.type = Type::object;
      take_in(node, type, typed);
      rule.of_type[type] = &typed;
    }
  }

  /// Adds a node's keys and those of the nodes that its "allOf" names, some of them only for a `type`. The
  /// first rule for a key counts. Returns whether keys depend on the type.
  bool take_in(const json& node, std::string_view type, SchemaRule& rule) {
    add_keys(node, rule);
    bool depends = node.contains("$ref") && take_in(target(node), type, rule);
    for (const json& part : member(node, "allOf")) {
      const json& condition = member(part, "if");
      if (condition.is_null()) {
        depends |= take_in(part, type, rule);
      } else {
        depends = true;
        const auto& types = compile(condition["properties"]["type"])->names;
        if (std::ranges::find(types, type) != types.end()) take_in(part["then"], type, rule);
      }
    }
    return depends;
  }

  void add_keys(const json& node, SchemaRule& rule) {
    if (const json& others = member(node, "additionalProperties"); others.is_object())
      rule.others = compile(others);
    compile_together(node, rule);
    for (const auto& [name, of] : member(node, "properties").items()) {
      SchemaRule::Key& key = rule.keys[name];
      if (key.rule) continue;
      key.rule = compile(of);
      key.standard = annotation(of, "default");
      if (const json* text = annotation(of, "description"))
        key.description = text->get_ref<const std::string&>();
    }
    for (const json& name : member(node, "required"))
      rule.keys[name.get_ref<const std::string&>()].required = true;
  }

  /// Compiles rules about several keys: "not" any of some pairs (with no "required" beside),
  /// "dependentRequired", and "oneOf" several lists of keys.
  static void compile_together(const json& node, SchemaRule& rule) {
    const auto text = [](const json& key) -> std::string_view { return key.get_ref<const std::string&>(); };
    if (const json& no = member(node, "not"); !no.contains("required"))
      for (const json& pair : member(no, "anyOf"))
        rule.clashes.emplace_back(text(pair["required"][0]), text(pair["required"][1]));
    for (const auto& [key, needed] : member(node, "dependentRequired").items())
      for (const json& other : needed) rule.needs.emplace_back(key, text(other));
    const json& ways = member(node, "oneOf");
    for (const json& way : ways) {
      const json& keys = way["required"];
      if (keys.size() == 1) rule.one_of.push_back(text(keys[0]));
      // If an alternative has several keys, the last alternative has its own key.
      for (const json& key : keys)
        if (keys.size() > 1) rule.clashes.emplace_back(text(ways.back()["required"][0]), text(key));
    }
  }

  json document_;
  std::deque<SchemaRule> rules_;
  std::map<const json*, const SchemaRule*> made_;
  std::map<std::string, const SchemaRule*, std::less<>> kinds_;
};

}  // namespace

const SchemaRule* schema_rule(std::string_view kind) {
  static const Schema schema;
  return schema.find(kind);
}

bool SchemaRule::bars(const json& value) const {
  if (const auto* text = value.get_ptr<const std::string*>(); text && !pattern.empty())
    if (!std::regex_search(*text, std::regex(pattern.begin(), pattern.end()))) return true;
  return barred && std::find(barred->begin(), barred->end(), value) != barred->end();
}

const SchemaRule* SchemaRule::as(Type wanted) const {
  if (type == wanted || (wanted == Type::number && type == Type::integer)) return this;
  for (const SchemaRule* option : options)
    if (const SchemaRule* found = option->as(wanted)) return found;
  return nullptr;
}

const SchemaRule& SchemaRule::typed(const json& object) const {
  const auto name = object.find("type");
  if (name == object.end() || !name->is_string()) return *this;
  const auto found = of_type.find(name->get_ref<const std::string&>());
  return found == of_type.end() ? *this : *found->second;
}

std::string SchemaRule::count() const {
  if (least_items == most_items) return fmt::format("{} ", least_items);
  if (most_items == least_items + 1) return fmt::format("{} or {} ", least_items, most_items);
  if (least_items == 0 && most_items < any_count) return fmt::format("up to {} ", most_items);
  if (most_items < any_count) return fmt::format("{} to {} ", least_items, most_items);
  return least_items > 0 ? fmt::format("{} or more ", least_items) : "";
}

std::string SchemaRule::describe(bool limits) const {
  if (!title.empty()) return std::string(title);
  if (!names.empty()) return list_names(names);
  std::string all;
  switch (type) {
    case Type::any:
      for (const SchemaRule* option : options)
        all += (all.empty() ? "" : option == options.back() ? " or " : ", ") + option->describe(limits);
      return all.empty() ? "a value" : all;
    case Type::object:
      return "an object";
    case Type::array:
      if (items && items->as(Type::number)) return fmt::format("an array of {}numbers", count());
      return count().empty() ? "an array" : fmt::format("an array of {}items", count());
    case Type::string:
      return "a string";
    case Type::number:
      return limits ? "a number " + sundog::describe(range) : "a number";
    case Type::integer:
      return limits ? fmt::format("an integer from {} to {}", range.low, range.high) : "an integer";
    case Type::boolean:
      break;
  }
  return "true or false";
}

std::string list_names(Names names, std::string_view conjunction) {
  std::string result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) result += i + 1 == names.size() ? fmt::format(" {} ", conjunction) : ", ";
    result += fmt::format("\"{}\"", names[i]);
  }
  return result;
}

std::string describe(const Range& range) {
  const bool low = range.low > any_number.low,
             high = range.high<any_number.high, endless = range.high> any_number.high;
  if (low && high && !range.low_open && !range.high_open)
    return fmt::format("from {} to {}", range.low, range.high);
  const std::string below = fmt::format("{} {}", range.high_open ? "below" : "up to", range.high);
  if (!low) return high ? below : fmt::format("of magnitude up to {}", range.high);
  const std::string above =
      range.low_open ? fmt::format("above {}", range.low) : fmt::format("not below {}", range.low);
  return endless ? above : fmt::format("{} and {}", above, below);
}

}  // namespace sundog
