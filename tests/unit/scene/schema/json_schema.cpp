// Validates JSON against the keywords that the scenes' schema uses, and fills in defaults.
#include "json_schema.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>

#include "base/file.h"

using nlohmann::json;

namespace {

class Validator {
 public:
  explicit Validator(const json& root) : root_(root) {}

  std::vector<std::string> errors;

  void check(const json& schema, const json& value, const std::string& place) {
    for (const auto& [keyword, rule] : schema.items()) {
      if (keyword == "$schema" || keyword == "$defs" || keyword == "title" || keyword == "description" ||
          keyword == "default" || keyword == "examples" || keyword == "then" || keyword == "else")
        continue;
      if (!follow(keyword, rule, schema, value, place) && !parts(keyword, rule, schema, value, place) &&
          !simple(keyword, rule, value, place))
        throw std::runtime_error("unknown JSON Schema keyword: " + keyword);
    }
  }

 private:
  bool holds(const json& schema, const json& value) const {
    Validator inner(root_);
    inner.check(schema, value, "");
    return inner.errors.empty();
  }

  void require(bool good, const std::string& place, const std::string& keyword) {
    if (!good) errors.push_back(place + ": " + keyword);
  }

  /// Adds the keys that the schema, and those that it applies to the same value, have rules for.
  void list_evaluated(const json& schema, const json& value, std::set<std::string>& keys) const {
    for (const auto& [keyword, rule] : schema.items()) {
      if (keyword == "properties") {
        for (const auto& [key, member] : rule.items()) keys.insert(key);
      } else if (keyword == "additionalProperties") {
        for (const auto& [key, member] : value.items()) keys.insert(key);
      } else if (keyword == "$ref") {
        list_evaluated(refer(rule), value, keys);
      } else if (keyword == "allOf") {
        for (const json& part : rule) list_evaluated(part, value, keys);
      } else if (keyword == "if") {
        const char* branch = holds(rule, value) ? "then" : "else";
        if (schema.contains(branch)) list_evaluated(schema.at(branch), value, keys);
      }
    }
  }

  const json& refer(const json& pointer) const {
    return root_.at(json::json_pointer(pointer.get<std::string>().substr(1)));
  }

  /// Keywords that apply other schemas to the same value.
  bool follow(const std::string& keyword, const json& rule, const json& schema, const json& value,
              const std::string& place) {
    const auto matches = [&] {
      long count = 0;
      for (const json& option : rule) count += holds(option, value);
      return count;
    };
    if (keyword == "$ref") {
      check(refer(rule), value, place);
    } else if (keyword == "allOf") {
      for (const json& option : rule) check(option, value, place);
    } else if (keyword == "anyOf") {
      require(matches() > 0, place, keyword);
    } else if (keyword == "oneOf") {
      require(matches() == 1, place, keyword);
    } else if (keyword == "not") {
      require(!holds(rule, value), place, keyword);
    } else if (keyword == "if") {
      const char* branch = holds(rule, value) ? "then" : "else";
      if (schema.contains(branch)) check(schema.at(branch), value, place);
    } else {
      return false;
    }
    return true;
  }

  /// Keywords about an object's members and an array's items.
  bool parts(const std::string& keyword, const json& rule, const json& schema, const json& value,
             const std::string& place) {
    static const std::vector<std::string> known{"properties",
                                                "additionalProperties",
                                                "unevaluatedProperties",
                                                "required",
                                                "dependentRequired",
                                                "items",
                                                "minItems",
                                                "maxItems"};
    if (std::find(known.begin(), known.end(), keyword) == known.end()) return false;
    if (value.is_object()) {
      std::set<std::string> evaluated;
      if (keyword == "unevaluatedProperties") list_evaluated(schema, value, evaluated);
      for (const auto& [key, member] : value.items()) {
        if (keyword == "properties" && rule.contains(key)) check(rule[key], member, place + "/" + key);
        if (keyword == "additionalProperties" && !schema.value("properties", json::object()).contains(key)) {
          if (rule.is_boolean())
            require(rule.get<bool>(), place + "/" + key, keyword);
          else
            check(rule, member, place + "/" + key);
        }
        if (keyword == "unevaluatedProperties")
          require(evaluated.contains(key) || rule.get<bool>(), place + "/" + key, keyword);
        if (keyword == "dependentRequired" && rule.contains(key))
          check({{"required", rule[key]}}, value, place);
      }
      if (keyword == "required")
        for (const json& key : rule) require(value.contains(key.get<std::string>()), place, keyword);
    } else if (value.is_array()) {
      if (keyword == "items")
        for (std::size_t i = 0; i < value.size(); ++i) check(rule, value[i], place + "/" + std::to_string(i));
      if (keyword == "minItems") require(value.size() >= rule.get<std::size_t>(), place, keyword);
      if (keyword == "maxItems") require(value.size() <= rule.get<std::size_t>(), place, keyword);
    }
    return true;
  }

  /// Keywords about the value alone.
  bool simple(const std::string& keyword, const json& rule, const json& value, const std::string& place) {
    static const std::map<std::string, std::function<bool(double, double)>> bounds{
        {"minimum", [](double x, double limit) { return x >= limit; }},
        {"maximum", [](double x, double limit) { return x <= limit; }},
        {"exclusiveMinimum", [](double x, double limit) { return x > limit; }},
        {"exclusiveMaximum", [](double x, double limit) { return x < limit; }}};
    if (const auto bound = bounds.find(keyword); bound != bounds.end()) {
      if (value.is_number()) require(bound->second(value.get<double>(), rule.get<double>()), place, keyword);
    } else if (keyword == "type") {
      require(has_type(value, rule.get<std::string>()), place, keyword);
    } else if (keyword == "enum") {
      require(std::find(rule.begin(), rule.end(), value) != rule.end(), place, keyword);
    } else if (keyword == "const") {
      require(value == rule, place, keyword);
    } else if (keyword == "minLength") {
      require(!value.is_string() || value.get<std::string>().size() >= rule.get<std::size_t>(), place,
              keyword);
    } else if (keyword == "pattern") {
      require(!value.is_string() ||
                  std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>())),
              place, keyword);
    } else {
      return false;
    }
    return true;
  }

  static bool has_type(const json& value, const std::string& type) {
    if (type == "integer") return value.is_number() && value.get<double>() == std::floor(value.get<double>());
    if (type == "number") return value.is_number();
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean());
  }

  const json& root_;
};

class Defaults {
 public:
  explicit Defaults(const json& root) : root_(root) {}

  void fill(const json& schema, json& value) const { fill(schema, value, schema); }

 private:
  /// `whole`: the schema, of which `schema` is a part, that the value obeys then too.
  void fill(const json& schema, json& value, const json& whole) const {
    if (schema.contains("$ref")) fill(refer(schema), value, whole);
    if (schema.contains("if"))
      fill(schema.value(holds(schema["if"], value) ? "then" : "else", json::object()), value, whole);
    for (const char* keyword : {"allOf", "anyOf"})
      for (const json& option : schema.value(keyword, json::array())) fill_option(option, value, whole);
    if (value.is_array() && schema.contains("items"))
      for (json& item : value) fill(schema["items"], item);
    if (value.is_object()) fill_object(schema, value, whole);
  }

  const json& refer(const json& schema) const {
    return root_.at(json::json_pointer(schema.at("$ref").get<std::string>().substr(1)));
  }

  bool holds(const json& schema, const json& value) const {
    Validator validator(root_);
    validator.check(schema, value, "");
    return validator.errors.empty();
  }

  void fill_option(const json& option, json& value, const json& whole) const {
    if (option.contains("if") && !holds(option["if"], value)) return;
    const json& chosen = option.contains("if") ? option["then"] : option;
    if (holds(chosen, value)) fill(chosen, value, whole);
  }

  void fill_object(const json& schema, json& value, const json& whole) const {
    const json properties = schema.value("properties", json::object());
    for (auto& [key, member] : value.items()) {
      if (properties.contains(key))
        fill(properties[key], member);
      else if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object())
        fill(schema["additionalProperties"], member);
    }
    for (const auto& [key, rule] : properties.items()) {
      const json* named = &rule;
      while (!named->contains("default") && named->contains("$ref")) named = &refer(*named);
      if (value.contains(key) || !named->contains("default")) continue;
      json filled = value;
      filled[key] = (*named)["default"];
      if (holds(whole, filled)) value = std::move(filled);
    }
  }

  const json& root_;
};

}  // namespace

std::vector<std::string> schema_errors(const json& schema, const json& value) {
  Validator validator(schema);
  validator.check(schema, value, "");
  return validator.errors;
}

void fill_defaults(const json& schema, json& value) { Defaults(schema).fill(schema, value); }

const json& scene_schema() {
  static const json schema = json::parse(sundog::read_file(SUNDOG_SOURCE_DIR "/scenes/scene.schema.json"));
  return schema;
}
