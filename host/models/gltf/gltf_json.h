// A JSON value that knows its JSON pointer, for error messages.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "models/source.h"

namespace sundog::models {

/// Allowed numbers; open bounds exclude the bound.
struct Range {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool least_open = false;
};
inline constexpr Range unit_range{0, 1, false};
inline constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative{0, std::numeric_limits<double>::infinity(), false};

/// The JSON of a file, of which `text` is a part. Throws SceneError.
nlohmann::json parse_json(const Source& source, std::string_view text);

/// Accessors throw SceneError if the value has another type. Value and source must outlive it.
class JsonAt {
 public:
  JsonAt(const Source& source, const nlohmann::json& value, std::string pointer)
      : source_(&source), value_(&value), pointer_(std::move(pointer)) {}

  JsonAt member(const char* key) const;               // required
  std::optional<JsonAt> find(const char* key) const;  // absent: nullopt
  std::optional<JsonAt> extension(const char* name) const;
  std::vector<JsonAt> elements() const;             // of an array
  std::vector<JsonAt> list(const char* key) const;  // of a member array; absent: empty

  double number(Range range = {}) const;
  double number(const char* key, double otherwise, Range range) const;
  std::uint64_t integer(std::uint64_t least, std::uint64_t most) const;
  std::uint64_t integer_or(const char* key, std::uint64_t otherwise) const;
  std::size_t index(std::size_t count, const char* of) const;  // index into `count` things
  bool boolean(const char* key, bool otherwise) const;
  std::string text() const;
  std::string text(const char* key) const;  // absent: ""
  /// Exactly `count` numbers.
  std::vector<double> numbers(std::size_t count, Range range = {}) const;
  glm::dvec3 vector(const char* key, glm::dvec3 otherwise, Range range = {}) const;

  const nlohmann::json& json() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  [[noreturn]] void fail(const std::string& what, Remedy remedy = Remedy::none) const;

 private:
  void want_object() const;
  const Source* source_;
  const nlohmann::json* value_;
  std::string pointer_;
};

}  // namespace sundog::models
