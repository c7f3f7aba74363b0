// The rules of scenes/scene.schema.json, which is embedded in the program: ranges, choices, defaults and
// keys. Readers find a rule by the kind of object (its name in the schema's $defs). Compiled once.
#pragma once
#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sundog {

/// Allowed numbers. The default limits keep every square finite as a float.
struct Range {
  double low = -1e18, high = 1e18;
  bool low_open = false, high_open = false;
};
inline constexpr Range any_number{};

/// Completes "wanted a number ".
std::string describe(const Range& range);

/// Allowed keys or choices.
using Names = std::span<const std::string_view>;

/// Formats names as "a, b or c", each in quotes.
std::string list_names(Names names, std::string_view conjunction = "or");

/// The schema's rule for one value.
struct SchemaRule {
  enum class Type { any, object, array, string, number, integer, boolean };
  Type type = Type::any;
  std::string_view title;                      // completes "wanted "; empty: derived from the rest
  Range range;                                 // for numbers
  const nlohmann::json* barred = nullptr;      // values that are refused
  std::string_view pattern;                    // for strings; bounded, because std::regex recurses
  std::vector<std::string_view> names;         // for strings; empty: any
  unsigned least_items = 0, most_items = ~0u;  // for arrays
  const SchemaRule* items = nullptr;           // for arrays
  const SchemaRule* others = nullptr;          // values of an object with arbitrary keys
  struct Key {
    const SchemaRule* rule = nullptr;
    std::string_view description;
    const nlohmann::json* standard = nullptr;  // the default for a missing key
    bool required = false;
  };
  std::map<std::string_view, Key> keys;                   // for objects
  std::map<std::string_view, const SchemaRule*> of_type;  // for objects whose keys depend on their "type"
  std::vector<const SchemaRule*> options;
  using KeyPair = std::pair<std::string_view, std::string_view>;
  std::vector<KeyPair> clashes;          // keys that exclude each other
  std::vector<KeyPair> needs;            // the first key needs the second
  std::vector<std::string_view> one_of;  // keys of single-key alternatives, of which exactly one is given

  bool bars(const nlohmann::json& value) const;
  /// The rule for an object of this "type"; this rule if its keys do not depend on that.
  const SchemaRule& typed(const nlohmann::json& object) const;
  /// This rule, or its first option, for values of this type; nullptr: none.
  const SchemaRule* as(Type wanted) const;
  /// Completes "wanted "; with or without a number's limits.
  std::string describe(bool limits = true) const;
  /// The number of items that an array may have, as "2 " or "1 to 64 "; empty: any.
  std::string count() const;
};

/// The rule for a kind of object; nullptr if the schema lacks it.
const SchemaRule* schema_rule(std::string_view kind);

struct SchemaFile {
  std::string_view path, bytes;
};
/// The schema's text.
std::span<const SchemaFile> embedded_schema();

}  // namespace sundog
