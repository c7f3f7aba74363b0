// The strict reader; see value.h.
#include "scene/json/value.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
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
      return fmt::format("the string {}{}", json(text.substr(0, length)).dump(),
                         length < text.size() ? "..." : "");
    }
    default:
      return value.dump();
  }
}

bool inside(double x, const Range& range) {
  return (range.low_open ? x > range.low : x >= range.low) &&
         (range.high_open ? x < range.high : x <= range.high);
}

std::string describe(const Range& range) {
  const bool low = range.low > any_number.low, high = range.high < any_number.high;
  if (low && high && !range.low_open && !range.high_open)
    return fmt::format("from {} to {}", range.low, range.high);
  const std::string below = fmt::format("{} {}", range.high_open ? "below" : "up to", range.high);
  if (!low) return high ? below : fmt::format("of magnitude up to {}", range.high);
  const std::string above =
      range.low_open ? fmt::format("above {}", range.low) : fmt::format("not below {}", range.low);
  return fmt::format("{} and {}", above, below);
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

std::string list_names(Names names, std::string_view conjunction) {
  std::string result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) result += i + 1 == names.size() ? fmt::format(" {} ", conjunction) : ", ";
    result += fmt::format("\"{}\"", names[i]);
  }
  return result;
}

void JsonValue::fail(std::string_view reason) const {
  throw SceneError(context_->file.string(), pointer_, std::string(reason));
}

void JsonValue::warn(std::string_view reason) const {
  if (context_->warnings)
    context_->warnings->push_back(SceneError(context_->file.string(), pointer_, std::string(reason)).what());
}

void JsonValue::wanted(std::string_view what) const {
  fail(fmt::format("wanted {}, found {}", what, describe(*json_)));
}

JsonValue JsonValue::child(std::string_view key, const nlohmann::json& value) const {
  return {value, *context_, join_pointer(pointer_, key)};
}

double JsonValue::number(const Range& range) const {
  if (!json_->is_number()) wanted("a number");
  const double x = json_->get<double>();
  if (!inside(x, range)) wanted(fmt::format("a number {}", describe(range)));
  return x;
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
  if (json_->is_string()) {
    const auto& text = json_->get_ref<const std::string&>();
    if (std::find(names.begin(), names.end(), text) != names.end()) return text;
    if (const auto near = nearest_name(text, {names.begin(), names.end()}))
      fail(fmt::format("wanted {}, found {}: did you mean \"{}\"?", list_names(names), describe(*json_),
                       *near));
  }
  wanted(list_names(names));
}

glm::dvec3 JsonValue::vec3(const Range& each) const {
  if (!json_->is_array() || json_->size() != 3) wanted("an array of 3 numbers");
  glm::dvec3 result{};
  for (int i = 0; i < 3; ++i)
    result[i] = child(std::to_string(i), (*json_)[static_cast<std::size_t>(i)]).number(each);
  return result;
}

glm::dvec3 JsonValue::direction() const {
  const glm::dvec3 v = vec3();
  if (!(glm::length(v) > 1e-12)) fail("wanted a direction, found a vector of length 0");
  return glm::normalize(v);
}

glm::dvec3 JsonValue::color(const Range& each) const {
  if (!json_->is_array() || json_->size() != 3) wanted("a colour [r, g, b]");
  return vec3(each);
}

JsonItems JsonValue::items(std::string_view what) const {
  if (!json_->is_array()) wanted(fmt::format("an array of {}", what));
  return JsonItems(*this);
}

std::size_t JsonItems::size() const { return array_.json().size(); }

JsonValue JsonItems::operator[](std::size_t index) const {
  return array_.child(std::to_string(index), array_.json()[index]);
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members(std::string_view what) const {
  if (!json_->is_object()) wanted(fmt::format("an object of {}", what));
  std::vector<std::pair<std::string, JsonValue>> result;
  for (const auto& [key, value] : json_->items()) result.emplace_back(key, child(key, value));
  return result;
}

JsonValue JsonValue::member(std::string_view key, std::string_view what) const {
  if (!json_->is_object()) wanted("an object");
  const auto found = json_->find(key);
  if (found == json_->end()) fail(fmt::format("missing key \"{}\": wanted {}", key, what));
  return child(key, *found);
}

JsonValue JsonValue::member(std::string_view key, Names names) const {
  const bool there = json_->is_object() && json_->contains(key);
  return member(key, there ? "" : list_names(names));
}

JsonObject::JsonObject(const JsonValue& value, std::string_view kind) : value_(value), kind_(kind) {
  if (!value.json().is_object()) value.wanted("an object");
}

void JsonObject::ask(std::string_view key) {
  asked_.emplace_back(key);
  if (auto* all = value_.context().asked) (*all)[kind_].emplace(key);
}

std::optional<JsonValue> JsonObject::find(std::string_view key) {
  ask(key);
  const auto found = value_.json().find(key);
  if (found == value_.json().end()) return std::nullopt;
  return value_.child(key, *found);
}

JsonValue JsonObject::at(std::string_view key, std::string_view what) {
  if (auto found = find(key)) return *found;
  std::vector<std::string> unknown;
  for (const auto& [name, value] : value_.json().items())
    if (std::ranges::find(asked_, name) == asked_.end()) unknown.push_back(name);
  const auto near = nearest_name(key, unknown);
  value_.fail(fmt::format("missing key \"{}\": wanted {}{}", key, what,
                          near ? fmt::format(", found {}", json(*near).dump()) : std::string()));
}

double JsonObject::number(std::string_view key, double fallback, const Range& range) {
  const auto found = find(key);
  return found ? found->number(range) : fallback;
}

int JsonObject::integer(std::string_view key, int fallback, int low, int high) {
  const auto found = find(key);
  return found ? found->integer(low, high) : fallback;
}

bool JsonObject::boolean(std::string_view key, bool fallback) {
  const auto found = find(key);
  return found ? found->boolean() : fallback;
}

std::string JsonObject::text(std::string_view key, std::string_view fallback) {
  const auto found = find(key);
  return found ? found->text() : std::string(fallback);
}

std::string JsonObject::choice(std::string_view key, std::string_view fallback, Names names) {
  const auto found = find(key);
  return found ? found->choice(names) : std::string(fallback);
}

glm::dvec3 JsonObject::vec3(std::string_view key, const glm::dvec3& fallback, const Range& each) {
  const auto found = find(key);
  return found ? found->vec3(each) : fallback;
}

glm::dvec3 JsonObject::color(std::string_view key, const glm::dvec3& fallback, const Range& each) {
  const auto found = find(key);
  return found ? found->color(each) : fallback;
}

std::string JsonObject::one_of(Names keys) {
  std::vector<std::string_view> found;
  for (const std::string_view key : keys)
    if (has(key)) found.push_back(key);
  if (found.size() == 1) return std::string(found.front());
  for (const auto& [name, value] : value_.json().items())  // a misspelt key explains a missing one
    if (const auto near = nearest_name(name, {keys.begin(), keys.end()}); found.empty() && near)
      value_.child(name, value)
          .fail(fmt::format("unknown key {}: did you mean \"{}\"?", json(name).dump(), *near));
  value_.fail(fmt::format("wanted one of {}, found {}", list_names(keys),
                          found.empty() ? "none" : list_names(found, "and")));
}

void JsonObject::not_both(std::string_view first, std::string_view second) {
  const bool one = has(first), other = has(second);
  if (one && other) value_.fail(fmt::format("wanted \"{}\" or \"{}\", found both", first, second));
}

void JsonObject::refuse_unasked() const {
  for (const auto& [name, value] : value_.json().items()) {
    if (std::ranges::find(asked_, name) != asked_.end()) continue;
    const std::set<std::string> wanted(asked_.begin(), asked_.end());
    const std::string mend =
        did_you_mean(name, {wanted.begin(), wanted.end()}, fmt::format("wanted {}", fmt::join(wanted, ", ")));
    value_.child(name, value).fail(fmt::format("unknown key {}: {}", json(name).dump(), mend));
  }
}

}  // namespace sundog
