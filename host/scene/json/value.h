// Strict JSON reading: a JsonValue knows its place (file and JSON pointer) for error messages; a JsonObject
// records the keys it was asked for and rejects all others at the end.
#pragma once
#include <algorithm>
#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/named_values.h"

namespace sundog {

/// Allowed numbers. The default limits keep every square finite as a float.
struct Range {
  double low = -1e18, high = 1e18;
  bool low_open = false, high_open = false;
};
inline constexpr Range any_number{};
inline constexpr Range at_least_0{.low = 0};
inline constexpr Range above_0{.low = 0, .low_open = true};
inline constexpr Range zero_to_one{.low = 0, .high = 1};
inline constexpr Range color_range{.low = 0, .high = 1e6};

class FrameCache;

/// What the values of one file share. `asked`, when set, collects the keys asked for, by kind of object: a
/// test compares them with the JSON Schema.
struct JsonContext {
  std::filesystem::path file;
  std::map<std::string, std::set<std::string>, std::less<>>* asked = nullptr;
  bool native_code = false;                      // a scene may carry OpenCL C
  std::vector<std::string>* warnings = nullptr;  // when set, collects what the values were warned of
  bool measures = true;         // formulas are tried out; who only checks keys and types need not
  bool outside_files = false;   // a scene may name files outside its folder
  FrameCache* cache = nullptr;  // of the frames before this one
  std::optional<double> seconds = std::nullopt;  // of a frame; none: the scene as it is written
  bool* plays = nullptr;                         // when set, whether a value was read that follows them
};

inline constexpr std::string_view quaternion_text = "a quaternion of 4 numbers x, y, z, w that are not all 0";

/// Allowed keys or choices, in a static array.
using Names = std::span<const std::string_view>;

class JsonItems;
class JsonObject;

/// A JSON value and its place. The document and the context must outlive it.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, const JsonContext& context, std::string pointer = "")
      : json_(&json), context_(&context), pointer_(std::move(pointer)) {}

  const nlohmann::json& json() const { return *json_; }
  const JsonContext& context() const { return *context_; }
  const std::string& pointer() const { return pointer_; }

  /// Throws SceneError at this place.
  [[noreturn]] void fail(std::string_view reason) const;
  /// Adds a one-line warning with this place.
  void warn(std::string_view reason) const;
  /// Throws "wanted `what`, found <this value, shortened>".
  [[noreturn]] void wanted(std::string_view what) const;

  double number(const Range& range = any_number) const;
  int integer(int low, int high) const;
  bool boolean() const;
  /// A non-empty string.
  std::string text() const;
  /// The string, which must be one of `names`.
  std::string choice(std::span<const std::string_view> names) const;
  /// The value of the table row that the string names.
  template <class Row, std::size_t N>
  auto choose(const std::array<Row, N>& table) const {
    return std::ranges::find(table, choice(names_of(table)), &Row::name)->value;
  }
  glm::dvec3 vec3(const Range& each = any_number) const;
  /// A nonzero [x, y, z], normalised.
  glm::dvec3 direction() const;
  /// Linear [r, g, b], each from 0.
  glm::dvec3 color(const Range& each = color_range) const;

  /// Items of an array; `what` completes "wanted an array of ...".
  JsonItems items(std::string_view what) const;
  /// Members of an object with arbitrary keys.
  std::vector<std::pair<std::string, JsonValue>> members(std::string_view what) const;
  /// A required member, not recorded as asked for; used to look at an object's type before reading it.
  JsonValue member(std::string_view key, std::string_view what) const;
  /// Likewise; the error lists `names`.
  JsonValue member(std::string_view key, Names names) const;

  /// Passes this value, which must be an object, to `read(JsonObject&)`, then rejects unread keys. `kind` is
  /// the object's name in the JSON Schema's $defs.
  template <class Read>
  auto object(std::string_view kind, Read read) const;

 private:
  friend class JsonItems;
  friend class JsonObject;
  JsonValue child(std::string_view key, const nlohmann::json& value) const;

  const nlohmann::json* json_;
  const JsonContext* context_;
  std::string pointer_;
};

/// Items of an array, created on access, so that the first bad one of millions is found without memory for
/// the others.
class JsonItems {
 public:
  explicit JsonItems(JsonValue array) : array_(std::move(array)) {}

  class Iterator {
   public:
    Iterator(const JsonItems& items, std::size_t at) : items_(&items), at_(at) {}
    JsonValue operator*() const { return (*items_)[at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const JsonItems* items_;
    std::size_t at_;
  };

  std::size_t size() const;
  bool empty() const { return size() == 0; }
  JsonValue operator[](std::size_t index) const;
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  JsonValue array_;
};

/// A JSON object whose keys must all be read. Created by JsonValue::object().
class JsonObject {
 public:
  const JsonValue& value() const { return value_; }

  /// An optional key's value.
  std::optional<JsonValue> find(std::string_view key);
  /// A required key's value; `what` completes "missing key: wanted ...".
  JsonValue at(std::string_view key, std::string_view what);
  bool has(std::string_view key) { return find(key).has_value(); }

  double number(std::string_view key, double fallback, const Range& range = any_number);
  int integer(std::string_view key, int fallback, int low, int high);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string_view fallback);
  std::string choice(std::string_view key, std::string_view fallback,
                     std::span<const std::string_view> names);
  template <class Row, std::size_t N>
  auto choose(std::string_view key, decltype(Row::value) fallback, const std::array<Row, N>& table) {
    const auto found = find(key);
    return found ? found->choose(table) : fallback;
  }
  glm::dvec3 vec3(std::string_view key, const glm::dvec3& fallback, const Range& each = any_number);
  glm::dvec3 color(std::string_view key, const glm::dvec3& fallback, const Range& each = color_range);

  /// Returns which of `keys` is present; exactly one must be.
  std::string one_of(std::span<const std::string_view> keys);
  /// Rejects `second` if `first` is present.
  void not_both(std::string_view first, std::string_view second);

 private:
  friend class JsonValue;
  JsonObject(const JsonValue& value, std::string_view kind);
  void ask(std::string_view key);
  void refuse_unasked() const;

  JsonValue value_;
  std::string kind_;
  std::vector<std::string> asked_;  // may repeat
};

/// "a, b or c", each in quotes.
std::string list_names(Names names, std::string_view conjunction = "or");

/// Appends a reference token to `pointer`, escaped by RFC 6901.
std::string join_pointer(std::string_view pointer, std::string_view key);

template <class Read>
auto JsonValue::object(std::string_view kind, Read read) const {
  JsonObject object(*this, kind);
  if constexpr (std::is_void_v<decltype(read(object))>) {
    read(object);
    object.refuse_unasked();
  } else {
    auto result = read(object);
    object.refuse_unasked();
    return result;
  }
}

}  // namespace sundog
