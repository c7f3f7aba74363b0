// Reads JSON strictly. A JsonValue knows its place (file and JSON pointer), for error messages, and its rule
// in the schema; a JsonObject records the keys requested and at the end rejects all others.
#pragma once
#include <algorithm>
#include <array>
#include <concepts>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/code_names.h"
#include "base/error.h"
#include "base/named_values.h"
#include "scene/json/schema.h"

namespace sundog {

inline constexpr Range at_least_0{.low = 0};

class FrameCache;

/// Settings and logs shared by the values of one file. `asked`, if set, collects the keys that readers
/// request, by kind of object; a test compares them with the JSON Schema.
struct JsonContext {
  std::filesystem::path file;
  std::map<std::string, std::set<std::string>, std::less<>>* asked = nullptr;
  bool native_code = false;                      // the scene may contain OpenCL C
  std::vector<std::string>* warnings = nullptr;  // if set, collects warnings
  bool measures = true;         // whether to survey formulas; not needed when only keys and types are checked
  bool outside_files = false;   // the scene may name files outside its folder
  FrameCache* cache = nullptr;  // files and meshes of earlier frames
  std::optional<double> seconds = std::nullopt;  // the frame's time; none: the scene as written
  bool* plays = nullptr;  // if set, receives whether a value that depends on `seconds` was read
};

/// Appends a reference token to `pointer`, escaped by RFC 6901.
std::string join_pointer(std::string_view pointer, std::string_view key);

inline constexpr std::string_view quaternion_text = "a quaternion of 4 numbers x, y, z, w that are not all 0";

class JsonItems;
class JsonObject;

/// A JSON value, its place and its rule. The document and the context must outlive it.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, const JsonContext& context, std::string pointer = "",
            const SchemaRule* rule = nullptr)
      : json_(&json), context_(&context), pointer_(std::move(pointer)), rule_(rule) {}

  const nlohmann::json& json() const { return *json_; }
  const JsonContext& context() const { return *context_; }
  const std::string& pointer() const { return pointer_; }

  /// Throws SceneError at this place.
  [[noreturn]] void fail(std::string_view reason, Remedy remedy = Remedy::none) const;
  /// Adds a one-line warning with this place.
  void warn(std::string_view reason) const;
  /// Throws "wanted `what`, found <this value, shortened>".
  [[noreturn]] void wanted(std::string_view what) const;

  /// Checked against the rule's range, or against the given one.
  double number() const;
  double number(const Range& range) const;
  int integer() const;
  int integer(int low, int high) const;
  bool boolean() const;
  /// A non-empty string.
  std::string text() const;
  /// The string, which must be one of the rule's names, or one of `names`.
  std::string choice() const { return choice(rule_of(SchemaRule::Type::string).names); }
  std::string choice(Names names) const;
  /// The value of the table row that the string names.
  template <class Row, std::size_t N>
  auto choose(const std::array<Row, N>& table) const {
    return std::ranges::find(table, choice(names_of(table)), &Row::name)->value;
  }
  /// Three numbers; where the schema allows it, one number stands for all three.
  glm::dvec3 vec3() const { return vector<3>(); }
  /// A nonzero [x, y, z], normalised.
  glm::dvec3 direction() const;

  /// Sets `to` to the value, which must obey the rule. Enumerators have the schema's names.
  void get(double& to) const { to = number(); }
  template <std::integral T>
  void get(T& to) const {
    to = static_cast<T>(integer());
  }
  void get(bool& to) const { to = boolean(); }
  void get(std::string& to) const;
  template <glm::length_t N>
  void get(glm::vec<N, double>& to) const {
    to = vector<N>();
  }
  template <class T>
  void get(std::optional<T>& to) const {
    get(to.emplace());
  }
  template <class T>
    requires std::is_enum_v<T>
  void get(T& to) const {
    to = enumerator_named<T>(choice());
  }

  /// Items of an array; `what` completes "wanted an array of ...".
  JsonItems items(std::string_view what) const;
  /// Members of an object with arbitrary keys.
  std::vector<std::pair<std::string, JsonValue>> members(std::string_view what) const;
  /// A required member; not recorded as requested.
  JsonValue member(std::string_view key, std::string_view what) const;
  /// The required "type", which chooses an object's keys.
  std::string type() const;

  /// Passes this value, which must be an object, to `read(JsonObject&)`, then rejects unread keys. `kind` is
  /// the object's name in the JSON Schema's $defs; its "type" may choose among the keys there.
  template <class Read>
  auto object(std::string_view kind, Read read) const;

 private:
  friend class JsonItems;
  friend class JsonObject;
  JsonValue child(std::string_view key, const nlohmann::json& value, const SchemaRule* rule) const;
  /// The rule for a value of this type; a rule without limits if the schema has none.
  const SchemaRule& rule_of(SchemaRule::Type type) const;
  /// Fails in the schema's words if the value may have several types, otherwise with `plain`.
  [[noreturn]] void wanted_type(std::string_view plain) const;
  void read_numbers(double* to, std::size_t count) const;
  template <glm::length_t N>
  glm::vec<N, double> vector() const {
    glm::vec<N, double> result{};
    read_numbers(&result[0], N);
    return result;
  }

  const nlohmann::json* json_;
  const JsonContext* context_;
  std::string pointer_;
  const SchemaRule* rule_;
};

/// Items of an array, created on access, so that the first invalid one of millions is found without memory
/// for the others.
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

/// A JSON object whose keys must all be read; a "type" by which the schema chooses its keys counts as read.
/// Created by JsonValue::object().
class JsonObject {
 public:
  const JsonValue& value() const { return value_; }

  /// A section of a document as a value; `kind` and `key` select its rule.
  static JsonValue section(std::string_view kind, std::string_view key, const nlohmann::json& value,
                           const JsonContext& context) {
    return {value, context, join_pointer("", key), schema_rule(kind)->keys.at(key).rule};
  }
  /// Whether the schema has the key.
  bool knows(std::string_view key) const { return rule_ && rule_->keys.contains(key); }
  /// A key's value; an error if the schema requires it and it is missing.
  std::optional<JsonValue> find(std::string_view key);
  /// A required key's value; `what`, or else the schema, completes "missing key: wanted ...".
  JsonValue at(std::string_view key, std::string_view what = "");
  bool has(std::string_view key);

  /// Sets `to` to the key's value or the schema's default; without either, leaves it unchanged. Further pairs
  /// likewise.
  template <class T, class... More>
  void read(std::string_view key, T& to, More&&... more) {
    if (const auto found = find_or_standard(key)) found->get(to);
    if constexpr (sizeof...(more) > 0) read(std::forward<More>(more)...);
  }
  /// Like read(), with the value of the table row that the key's string names.
  template <class T, class Row, std::size_t N>
  void read(std::string_view key, T& to, const std::array<Row, N>& table) {
    if (const auto found = find_or_standard(key)) to = found->choose(table);
  }
  /// Checks a value that is not used here.
  void check(std::string_view key);

  /// Read numbers whose ranges and defaults depend on other values.
  double number(std::string_view key, double fallback, const Range& range);
  int integer(std::string_view key, int fallback, int low, int high);

  /// Returns the one key present among those of the schema's "oneOf".
  std::string one_of();

 private:
  friend class JsonValue;
  JsonObject(const JsonValue& value, std::string_view kind);
  /// The schema's entry for a key; if the schema has this kind, it must have the key.
  const SchemaRule::Key* ask(std::string_view key);
  std::optional<JsonValue> find_or_standard(std::string_view key);
  [[noreturn]] void fail_missing(std::string_view key, std::string_view beside, std::string_view what) const;
  void check_together() const;
  void refuse_unasked() const;

  JsonValue value_;
  std::string kind_;
  const SchemaRule* rule_;
  std::vector<std::string_view> asked_;  // the schema's strings; may repeat
};

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
