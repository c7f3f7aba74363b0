// Reading JSON strictly: a JsonValue is a value with its place (file and JSON pointer), so that every error
// names both; a JsonObject remembers the keys it was asked for, and refuses all others when it has been read.
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

/// The numbers a place accepts. The outermost limits keep every square finite as a float.
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
};

/// Keys or choices; pass a static array of them.
using Names = std::span<const std::string_view>;

class JsonItems;
class JsonObject;

/// A JSON value and where it stands. Refers to the document and the context, which must outlive it.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, const JsonContext& context, std::string pointer = "")
      : json_(&json), context_(&context), pointer_(std::move(pointer)) {}

  const nlohmann::json& json() const { return *json_; }
  const JsonContext& context() const { return *context_; }
  const std::string& pointer() const { return pointer_; }

  /// Throws SceneError at this place.
  [[noreturn]] void fail(std::string_view reason) const;
  /// Warns of this place, in one line like an error's.
  void warn(std::string_view reason) const;
  /// Throws "wanted `what`, found <this value, shortened>".
  [[noreturn]] void wanted(std::string_view what) const;

  double number(const Range& range = any_number) const;
  int integer(int low, int high) const;
  bool boolean() const;
  /// A string that is not empty.
  std::string text() const;
  /// Which of `names` the string is.
  std::string choice(std::span<const std::string_view> names) const;
  /// The value of the row that the string names.
  template <class Row, std::size_t N>
  auto choose(const std::array<Row, N>& table) const {
    return std::ranges::find(table, choice(names_of(table)), &Row::name)->value;
  }
  glm::dvec3 vec3(const Range& each = any_number) const;
  /// [x, y, z] that is not all zero; returned with length 1.
  glm::dvec3 direction() const;
  /// Linear [r, g, b], each from 0.
  glm::dvec3 color(const Range& each = color_range) const;

  /// The items of an array; `what` completes "wanted an array of ...".
  JsonItems items(std::string_view what) const;
  /// The members of an object whose keys are free names.
  std::vector<std::pair<std::string, JsonValue>> members(std::string_view what) const;
  /// One member of an object, by a key that must be there (but not recorded as asked for): to find out its
  /// type first.
  JsonValue member(std::string_view key, std::string_view what) const;
  /// The same where `names` are wanted.
  JsonValue member(std::string_view key, Names names) const;

  /// Hands this value, which must be an object, to `read(JsonObject&)`, and then refuses keys it did not ask
  /// for. `kind` is the object's name in the JSON Schema's $defs.
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

/// The items of an array. Each is made when it is asked for: the first bad one of millions is found without
/// memory for the others.
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

/// A JSON object of which every key must be asked for. Made by JsonValue::object().
class JsonObject {
 public:
  const JsonValue& value() const { return value_; }

  /// The value of a key that may be missing.
  std::optional<JsonValue> find(std::string_view key);
  /// The value of a key that must be there; `what` completes "missing key: wanted ...".
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

  /// Exactly one of `keys` must be there; says which.
  std::string one_of(std::span<const std::string_view> keys);
  /// Refuses `second` beside `first`.
  void not_both(std::string_view first, std::string_view second);

 private:
  friend class JsonValue;
  JsonObject(const JsonValue& value, std::string_view kind);
  void ask(std::string_view key);
  void refuse_unasked() const;

  JsonValue value_;
  std::string kind_;
  std::vector<std::string> asked_;  // as often as they were asked for
};

/// "a, b or c", each in quotes.
std::string list_names(Names names, std::string_view conjunction = "or");

/// `pointer` with one more reference token, escaped by RFC 6901.
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
