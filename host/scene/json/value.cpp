// Reads JSON values strictly, by the schema's rules; an error names the file, the place and the remedy.
#include "scene/json/value.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/json_text.h"
#include "base/names.h"

namespace sundog {
using nlohmann::json;

namespace {

std::string describe(const json& value) {
  switch (value.type()) {
    case json::value_t::array:
      return fmt::format("an array of {} item{}", value.size(), value.size() == 1 ? "" : "s");
    case json::value_t::object:
      return "an object";
    case json::value_t::string: {
      const auto& text = value.get_ref<const std::string&>();
      if (text.empty()) return "an empty string";
      std::size_t length = std::min<std::size_t>(text.size(), 60);
      // Do not split a UTF-8 sequence.
      while (length < text.size() && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
      return fmt::format("the string {}{}", json_text(json(text.substr(0, length))),
                         length < text.size() ? "..." : "");
    }
    default:
      return json_text(value);
  }
}

bool inside(double x, const Range& range) {
  return (range.low_open ? x > range.low : x >= range.low) &&
         (range.high_open ? x < range.high : x <= range.high);
}

/// The first sentence of a description, shortened so that it can end another sentence.
std::string brief(std::string_view description) {
  std::string text(description.substr(0, std::min(description.find(". "), description.find_first_of(";:"))));
  if (text.ends_with('.')) text.pop_back();
  if (text.size() > 1 && (text[1] == ' ' || std::islower(static_cast<unsigned char>(text[1]))))
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

std::string join_pointer(std::string_view pointer, std::string_view key) {
  std::string result;
  result.reserve(pointer.size() + 1 + key.size());
  result.append(pointer).push_back('/');
  for (const char c : key) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result;
}

void JsonValue::fail(std::string_view reason, Remedy remedy) const {
  throw SceneError(context_->file.string(), pointer_, std::string(reason), remedy);
}

void JsonValue::warn(std::string_view reason) const {
  if (context_->warnings)
    context_->warnings->push_back(SceneError(context_->file.string(), pointer_, std::string(reason)).what());
}

void JsonValue::wanted(std::string_view what) const {
  fail(fmt::format("wanted {}, found {}", what, describe(*json_)));
}

JsonValue JsonValue::child(std::string_view key, const nlohmann::json& value, const SchemaRule* rule) const {
  const JsonValue result(value, *context_, join_pointer(pointer_, key), rule);
  if (rule && rule->bars(value))
    result.fail(fmt::format("wanted {}, found {}", rule->describe(),
                            value.is_string() ? describe(value) : json_text(value)));
  return result;
}

const SchemaRule& JsonValue::rule_of(SchemaRule::Type type) const {
  static const SchemaRule free;
  const SchemaRule* rule = rule_ ? rule_->as(type) : nullptr;
  return rule ? *rule : free;
}

double JsonValue::number() const {
  const SchemaRule& rule = rule_of(SchemaRule::Type::number);
  return rule.type == SchemaRule::Type::integer ? integer() : number(rule.range);
}

double JsonValue::number(const Range& range) const {
  if (!json_->is_number()) wanted("a number");
  const double x = json_->get<double>();
  if (!inside(x, range)) wanted(fmt::format("a number {}", describe(range)));
  return x;
}

int JsonValue::integer() const {
  const Range& range = rule_of(SchemaRule::Type::integer).range;
  return integer(static_cast<int>(range.low), static_cast<int>(range.high));
}

int JsonValue::integer(int low, int high) const {
  const double x = json_->is_number() ? json_->get<double>() : std::nan("");
  if (!(x >= low && x <= high && x == std::floor(x)))
    wanted(fmt::format("an integer from {} to {}", low, high));
  return static_cast<int>(x);
}

bool JsonValue::boolean() const {
  if (!json_->is_boolean()) wanted("true or false");
  return json_->get<bool>();
}

std::string JsonValue::text() const {
  if (!json_->is_string() || json_->get_ref<const std::string&>().empty()) wanted("a string");
  return json_->get<std::string>();
}

std::string JsonValue::choice(Names names) const {
  const auto* text = json_->get_ptr<const std::string*>();
  if (text && std::ranges::find(names, *text) != names.end()) return *text;
  const std::string all = rule_ && !rule_->options.empty() ? rule_->describe() : list_names(names);
  if (text)
    if (const auto near = nearest_name(*text, {names.begin(), names.end()}))
      fail(fmt::format("wanted {}, found {}: did you mean \"{}\"?", all, describe(*json_), *near));
  wanted(all);
}

void JsonValue::get(std::string& to) const {
  to = rule_of(SchemaRule::Type::string).names.empty() ? text() : choice();
}

void JsonValue::read_numbers(double* to, std::size_t count) const {
  if (json_->is_number() && rule_ && rule_->as(SchemaRule::Type::number)) {
    std::fill_n(to, count, number());
    return;
  }
  const SchemaRule& rule = rule_of(SchemaRule::Type::array);
  if (!json_->is_array()) wanted(rule_ ? rule_->describe() : fmt::format("an array of {} numbers", count));
  if (json_->size() != count) wanted(rule_ ? rule.describe() : fmt::format("an array of {} numbers", count));
  for (std::size_t i = 0; i < count; ++i) to[i] = child(std::to_string(i), (*json_)[i], rule.items).number();
}

glm::dvec3 JsonValue::direction() const {
  const glm::dvec3 v = vec3();
  if (!(glm::length(v) > 1e-12)) fail("wanted a direction, found a vector of length 0");
  return glm::normalize(v);
}

void JsonValue::wanted_type(std::string_view plain) const {
  wanted(rule_ && !rule_->options.empty() ? rule_->describe() : plain);
}

JsonItems JsonValue::items(std::string_view what) const {
  const SchemaRule& rule = rule_of(SchemaRule::Type::array);
  if (json_->is_array() && json_->size() >= rule.least_items && json_->size() <= rule.most_items)
    return JsonItems(*this);
  const std::string plain = fmt::format("an array of {}{}", rule.count(), what);
  if (json_->is_array()) wanted(plain);
  wanted_type(plain);
}

std::size_t JsonItems::size() const { return array_.json().size(); }

JsonValue JsonItems::operator[](std::size_t index) const {
  const SchemaRule* items = array_.rule_of(SchemaRule::Type::array).items;
  return array_.child(std::to_string(index), array_.json()[index], items);
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members(std::string_view what) const {
  if (!json_->is_object()) wanted(fmt::format("an object of {}", what));
  std::vector<std::pair<std::string, JsonValue>> result;
  const SchemaRule* others = rule_of(SchemaRule::Type::object).others;
  for (const auto& [key, value] : json_->items()) result.emplace_back(key, child(key, value, others));
  return result;
}

JsonValue JsonValue::member(std::string_view key, std::string_view what) const {
  if (!json_->is_object()) wanted("an object");
  const auto found = json_->find(key);
  if (found == json_->end()) fail(fmt::format("missing key \"{}\": wanted {}", key, what));
  const SchemaRule& rule = rule_of(SchemaRule::Type::object);
  const auto known = rule.keys.find(key);
  return child(key, *found, known == rule.keys.end() ? rule.others : known->second.rule);
}

std::string JsonValue::type() const {
  const SchemaRule& rule = rule_of(SchemaRule::Type::object);
  const bool missing = json_->is_object() && !json_->contains("type");
  return member("type", missing ? rule.keys.at("type").rule->describe() : "").choice();
}

JsonObject::JsonObject(const JsonValue& value, std::string_view kind)
    : value_(value), kind_(kind), rule_(schema_rule(kind)) {
  if (!value.json().is_object()) value.wanted_type("an object");
  if (!rule_) return;
  const SchemaRule* typed = &rule_->typed(value.json());
  const bool by_type = typed != rule_;
  if (by_type) kind_.append("/").append(value.json()["type"].get_ref<const std::string&>());
  rule_ = typed;
  asked_.reserve(rule_->keys.size());
  check_together();
  for (const auto& [one, other] : rule_->clashes) asked_.insert(asked_.end(), {one, other});
  if (by_type || (knows("type") && rule_->keys.at("type").rule->names.size() == 1)) find("type");
}

const SchemaRule::Key* JsonObject::ask(std::string_view key) {
  if (auto* all = value_.context().asked) (*all)[kind_].emplace(key);
  if (!rule_) {
    asked_.push_back(key);
    return nullptr;
  }
  const auto found = rule_->keys.find(key);
  if (found == rule_->keys.end())
    throw std::logic_error(fmt::format("the schema's {} has no {}", kind_, key));
  asked_.push_back(found->first);
  return &found->second;
}

std::optional<JsonValue> JsonObject::find(std::string_view key) {
  const SchemaRule::Key* known = ask(key);
  const auto found = value_.json().find(key);
  if (found != value_.json().end()) return value_.child(key, *found, known ? known->rule : nullptr);
  if (known && known->required) at(key);
  return std::nullopt;
}

std::optional<JsonValue> JsonObject::find_or_standard(std::string_view key) {
  if (const auto found = find(key)) return found;
  const auto& [rule, description, standard, required] = rule_->keys.find(key)->second;
  if (!standard) return std::nullopt;
  return JsonValue(*standard, value_.context(), "", rule);
}

bool JsonObject::has(std::string_view key) {
  ask(key);
  return value_.json().contains(key);
}

JsonValue JsonObject::at(std::string_view key, std::string_view what) {
  if (has(key)) return *find(key);
  fail_missing(key, "", what);
}

void JsonObject::fail_missing(std::string_view key, std::string_view beside, std::string_view what) const {
  std::vector<std::string> unknown;
  for (const auto& [name, value] : value_.json().items())
    if (!knows(name) && std::ranges::find(asked_, name) == asked_.end()) unknown.push_back(name);
  const auto near = nearest_name(key, unknown);
  const SchemaRule::Key* known = knows(key) ? &rule_->keys.at(key) : nullptr;
  std::string wanted(what);
  if (wanted.empty()) wanted = known->rule->describe(false);
  if (what.empty() && !known->description.empty() && brief(known->description) != wanted)
    wanted += ": " + brief(known->description);
  value_.fail(fmt::format("missing key \"{}\"{}: wanted {}{}", key,
                          beside.empty() ? "" : fmt::format(" beside \"{}\"", beside), wanted,
                          near ? fmt::format(", found {}", json_text(json(*near))) : std::string()));
}

void JsonObject::check_together() const {
  const json& all = value_.json();
  for (const auto& [one, other] : rule_->clashes)
    if (all.contains(one) && all.contains(other))
      value_.fail(fmt::format("wanted \"{}\" or \"{}\", found both", one, other));
  for (const auto& [key, needed] : rule_->needs)
    if (all.contains(key) && !all.contains(needed)) fail_missing(needed, key, "");
}

void JsonObject::check(std::string_view key) {
  const auto found = find(key);
  if (!found) return;
  if (rule_->keys.at(key).rule->type == SchemaRule::Type::integer)
    found->integer();
  else
    found->text();
}

double JsonObject::number(std::string_view key, double fallback, const Range& range) {
  const auto found = find(key);
  return found ? found->number(range) : fallback;
}

int JsonObject::integer(std::string_view key, int fallback, int low, int high) {
  const auto found = find(key);
  return found ? found->integer(low, high) : fallback;
}

std::string JsonObject::one_of() {
  const Names keys = rule_->one_of;
  std::vector<std::string_view> found;
  for (const std::string_view key : keys)
    if (has(key)) found.push_back(key);
  if (found.size() == 1) return std::string(found.front());
  for (const auto& [name, value] : value_.json().items())  // a misspelt key explains a missing one
    if (const auto near = nearest_name(name, {keys.begin(), keys.end()}); found.empty() && near)
      value_.child(name, value, nullptr)
          .fail(fmt::format("unknown key {}: did you mean \"{}\"?", json_text(json(name)), *near));
  value_.fail(fmt::format("wanted one of {}, found {}", list_names(keys),
                          found.empty() ? "none" : list_names(found, "and")));
}

void JsonObject::refuse_unasked() const {
  for (const auto& [name, value] : value_.json().items()) {
    if (std::ranges::find(asked_, name) != asked_.end()) continue;
    const std::set<std::string> wanted(asked_.begin(), asked_.end());
    const std::string mend =
        did_you_mean(name, {wanted.begin(), wanted.end()}, fmt::format("wanted {}", fmt::join(wanted, ", ")));
    value_.child(name, value, nullptr).fail(fmt::format("unknown key {}: {}", json_text(json(name)), mend));
  }
}

}  // namespace sundog
