// JSON values with their pointers.
#include "models/gltf/gltf_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_memory.h"
#include "models/readers.h"

namespace sundog::models {
namespace {

// A key as a reference token (RFC 6901).
std::string escaped(std::string_view key) {
  std::string token;
  for (const char c : key) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return token;
}

}  // namespace

void JsonAt::fail(const std::string& what, Remedy remedy) const {
  throw SceneError(source_->path.string(), pointer_.empty() ? "/" : pointer_, what, remedy);
}

void JsonAt::want_object() const {
  if (!value_->is_object()) fail(fmt::format("an object wanted, found {}", value_->type_name()));
}

std::optional<JsonAt> JsonAt::find(const char* key) const {
  want_object();
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return JsonAt(*source_, *found, pointer_ + "/" + escaped(key));
}

JsonAt JsonAt::member(const char* key) const {
  if (auto found = find(key)) return *found;
  fail(fmt::format("'{}' is missing", key));
}

std::optional<JsonAt> JsonAt::extension(const char* name) const {
  const auto extensions = find("extensions");
  if (!extensions) return std::nullopt;
  const auto found = extensions->find(name);
  if (found) found->want_object();
  return found;
}

std::vector<JsonAt> JsonAt::elements() const {
  if (!value_->is_array()) fail(fmt::format("an array wanted, found {}", value_->type_name()));
  std::vector<JsonAt> all;
  all.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i)
    all.emplace_back(*source_, (*value_)[i], fmt::format("{}/{}", pointer_, i));
  return all;
}

std::vector<JsonAt> JsonAt::list(const char* key) const {
  const auto found = find(key);
  return found ? found->elements() : std::vector<JsonAt>();
}

double JsonAt::number(Range range) const {
  if (!value_->is_number()) fail(fmt::format("a number wanted, found {}", value_->type_name()));
  const auto value = value_->get<double>();
  const bool low = range.least_open ? value <= range.least : value < range.least;
  if (!std::isfinite(value) || low || value > range.most)
    fail(
        fmt::format("{} is outside {}{}, {}]", value, range.least_open ? "(" : "[", range.least, range.most));
  return value;
}

double JsonAt::number(const char* key, double otherwise, Range range) const {
  const auto found = find(key);
  return found ? found->number(range) : otherwise;
}

// Accepts 1.0 as 1.
std::uint64_t JsonAt::integer(std::uint64_t least, std::uint64_t most) const {
  const double value = number();
  if (value != std::trunc(value) || value < static_cast<double>(least) || value > static_cast<double>(most))
    fail(fmt::format("a whole number in [{}, {}] wanted, found {}", least, most, value));
  return static_cast<std::uint64_t>(value);
}

std::uint64_t JsonAt::integer_or(const char* key, std::uint64_t otherwise) const {
  constexpr std::uint64_t most = std::uint64_t{1} << 53;  // integers that a double holds exactly
  const auto found = find(key);
  return found ? found->integer(0, most) : otherwise;
}

std::size_t JsonAt::index(std::size_t count, const char* of) const {
  const double value = number();
  if (value != std::trunc(value) || value < 0 || value >= static_cast<double>(count))
    fail(fmt::format("{} {} does not exist: there are {}", of, value, count));
  return static_cast<std::size_t>(value);
}

bool JsonAt::boolean(const char* key, bool otherwise) const {
  const auto found = find(key);
  if (!found) return otherwise;
  if (!found->value_->is_boolean())
    found->fail(fmt::format("true or false wanted, found {}", found->value_->type_name()));
  return found->value_->get<bool>();
}

std::string JsonAt::text() const {
  if (!value_->is_string()) fail(fmt::format("a string wanted, found {}", value_->type_name()));
  return value_->get<std::string>();
}

std::string JsonAt::text(const char* key) const {
  const auto found = find(key);
  return found ? found->text() : std::string();
}

std::vector<double> JsonAt::numbers(std::size_t count, Range range) const {
  const std::vector<JsonAt> all = elements();
  if (all.size() != count) fail(fmt::format("{} numbers wanted, found {}", count, all.size()));
  std::vector<double> values;
  for (const JsonAt& one : all) values.push_back(one.number(range));
  return values;
}

glm::dvec3 JsonAt::vector(const char* key, glm::dvec3 otherwise, Range range) const {
  const auto found = find(key);
  if (!found) return otherwise;
  const std::vector<double> values = found->numbers(3, range);
  return {values[0], values[1], values[2]};
}

nlohmann::json parse_json(const Source& source, std::string_view text) {
  check_json_memory(text, source.path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    const auto* syntax = dynamic_cast<const nlohmann::json::parse_error*>(&error);
    std::string what = error.what();
    if (const std::size_t read = what.find("; last read: "); read != what.npos) {  // may cut a character
      const std::size_t rest = what.rfind("; expected ");
      what.erase(read, rest == what.npos || rest < read ? what.npos : rest - read);
    }
    const std::size_t name_end = what.find("] ");  // "[json.exception.parse_error.101] ..."
    const auto offset = static_cast<std::size_t>(text.data() - source.bytes.data());
    fail(source, syntax ? fmt::format("byte {}", offset + syntax->byte) : "",
         fmt::format("not valid JSON: {}", what.substr(name_end == what.npos ? 0 : name_end + 2)));
  }
}

}  // namespace sundog::models
