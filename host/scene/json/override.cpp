// Splits JSON pointers (RFC 6901), and sets values by them; errors name the setting.
#include "scene/json/override.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/names.h"
#include "base/numbers.h"
#include "scene/json/parse.h"
#include "scene/json/schema.h"
#include "scene/json/value.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// The reference tokens of a JSON pointer that starts with "/", unescaped (RFC 6901).
std::vector<std::string> split_pointer(std::string_view pointer) {
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~') {
      const char next = i + 1 < pointer.size() ? pointer[i + 1] : ' ';
      if (next != '0' && next != '1')
        throw UsageError(
            fmt::format("the setting {}: wanted ~0 (for ~) or ~1 (for /) in a JSON pointer", pointer));
      tokens.back() += next == '0' ? '~' : '/';
      ++i;
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

std::optional<std::size_t> array_index(std::string_view token) {
  const bool canonical = token.size() == 1 || !token.starts_with('0');
  return canonical ? whole_number<std::size_t>(token) : std::nullopt;
}

/// The index of the item that a token identifies: by index, or by a name that no other item has.
std::optional<std::size_t> item_index(const json& array, std::string_view token) {
  if (const auto index = array_index(token)) return *index < array.size() ? index : std::nullopt;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < array.size(); ++i)
    if (array[i].is_object() && array[i].contains("name") && array[i]["name"] == token) {
      if (found) return std::nullopt;
      found = i;
    }
  return found;
}

/// The way to the only item of a group in `objects` with that name, as tokens; empty: none, or several.
std::vector<std::string> way_to_member(const json& objects, std::string_view name) {
  std::vector<std::string> way;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto inner = objects[i].is_object() ? objects[i].find("objects") : objects[i].end();
    if (inner == objects[i].end() || !inner->is_array()) continue;
    const std::optional<std::size_t> item = item_index(*inner, name);
    std::vector<std::string> rest = item ? std::vector{std::to_string(*item)} : way_to_member(*inner, name);
    if (rest.empty()) continue;
    if (!way.empty()) return {};
    way = {std::to_string(i), "objects"};
    way.insert(way.end(), rest.begin(), rest.end());
  }
  return way;
}

/// split_pointer(), with "/objects/NAME" of a group's member as the way through its groups.
std::vector<std::string> steps_of(const json& document, std::string_view pointer) {
  std::vector<std::string> tokens = split_pointer(pointer);
  const auto objects = document.find("objects");
  if (tokens.size() < 2 || tokens[0] != "objects" || objects == document.end() || !objects->is_array() ||
      tokens[1] == "-" || array_index(tokens[1]) || item_index(*objects, tokens[1]))
    return tokens;
  if (const std::vector<std::string> way = way_to_member(*objects, tokens[1]); !way.empty()) {
    tokens.erase(tokens.begin() + 1);
    tokens.insert(tokens.begin() + 1, way.begin(), way.end());
  }
  return tokens;
}

/// The child that a token identifies; null: none.
const json* child_of(const json& parent, const std::string& token) {
  if (parent.is_array()) {
    const auto index = item_index(parent, token);
    return index ? &parent[*index] : nullptr;
  }
  const auto found = parent.find(token);  // end() unless `parent` is an object
  return found == parent.end() ? nullptr : &*found;
}

/// The schema's default for the missing key that the tokens lead to; null: none.
const json* standard_at(const json& document, std::span<const std::string> tokens) {
  using Type = SchemaRule::Type;
  const SchemaRule* rule = schema_rule("scene");
  const json* place = &document;
  for (std::size_t i = 0; rule; ++i) {
    const SchemaRule* of = rule->as(place && place->is_array() ? Type::array : Type::object);
    if (!of) break;
    if (of->type == Type::array) {
      rule = of->items;
    } else {
      if (place) of = &of->typed(*place);
      const auto key = of->keys.find(tokens[i]);
      if (i + 1 == tokens.size()) return key == of->keys.end() ? nullptr : key->second.standard;
      rule = key == of->keys.end() ? of->others : key->second.rule;
    }
    place = place ? child_of(*place, tokens[i]) : nullptr;
    if (i + 1 == tokens.size()) break;
  }
  return nullptr;
}

json parse_value(std::string_view text, const fs::path& file) {
  try {
    return parse_json(text, file);
  } catch (const SceneError&) {
    return std::string(text);
  }
}

/// One step along a pointer: the child of `parent`, created if allowed.
class Step {
 public:
  Step(const json& document, const std::vector<std::string>& tokens, std::string_view subject,
       const fs::path& file)
      : document_(document), tokens_(tokens), subject_(subject), file_(file) {}

  json* go(json& parent, std::size_t depth) const {
    if (parent.is_array()) return item(parent, depth);
    if (!parent.is_object()) fail(depth, fmt::format("{} holds a single value", pointer(depth)));
    const bool last = depth + 1 == tokens_.size();
    if (!parent.contains(tokens_[depth]) && !last) may_add(parent, depth);
    return &parent[tokens_[depth]];
  }

 private:
  std::string pointer(std::size_t depth) const {
    std::string result;
    for (std::size_t i = 0; i < depth; ++i) result = join_pointer(result, tokens_[i]);
    return result;
  }

  [[noreturn]] void fail(std::size_t depth, std::string_view why) const {
    throw SceneError(file_.string(), pointer(depth + 1), fmt::format("{} leads nowhere: {}", subject_, why));
  }

  json* item(json& array, std::size_t depth) const {
    if (tokens_[depth] == "-") return &array.emplace_back();
    const auto index = item_index(array, tokens_[depth]);
    if (!index)
      fail(depth, fmt::format("{} has {} items, counted from 0{}", pointer(depth), array.size(),
                              array_index(tokens_[depth]) ? "" : ", and not one alone of that name"));
    return &array[*index];
  }

  /// Adds an object, unless this token names a thing that must exist. Adds an array, which the next token
  /// indexes, if it is the default.
  void may_add(json& parent, std::size_t depth) const {
    const std::string& token = tokens_[depth];
    const json* standard = standard_at(document_, std::span(tokens_).first(depth + 1));
    if (standard && standard->is_array()) {
      parent[token] = *standard;
      return;
    }
    const bool named = depth == 1 && (tokens_[0] == "materials" || tokens_[0] == "media" ||
                                      tokens_[0] == "meshes" || tokens_[0] == "fields");
    if (named || tokens_[depth + 1] == "-" || array_index(tokens_[depth + 1])) {
      std::vector<std::string> known;
      for (const auto& [key, value] : parent.items()) known.push_back(key);
      const std::string mend = did_you_mean(token, known);
      fail(depth, fmt::format("there is no {}{}{}", pointer(depth + 1), mend.empty() ? "" : ": ", mend));
    }
    parent[token] = json::object();
  }

  const json& document_;
  const std::vector<std::string>& tokens_;
  std::string_view subject_;
  const fs::path& file_;
};

/// The end of a setting's pointer: the first "=" before which the pointer leads to something, or else the
/// first.
std::size_t end_of_pointer(const json& document, std::string_view setting) {
  const std::size_t first = setting.find('=');
  if (first == std::string_view::npos || first < 2 || setting[0] != '/')
    throw UsageError(
        fmt::format("the setting {}: wanted JSON_POINTER=VALUE, such as /camera/fov=30", setting));
  for (std::size_t at = first; at != std::string_view::npos; at = setting.find('=', at + 1)) {
    const json* place = &document;
    for (const std::string& token : steps_of(document, setting.substr(0, at))) {
      if (!place) break;
      place = child_of(*place, token);
    }
    if (place) return at;
  }
  return first;
}

}  // namespace

bool leads_through(std::string_view longer, std::string_view shorter) {
  return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '/');
}

bool overlap(std::string_view a, std::string_view b) { return leads_through(a, b) || leads_through(b, a); }

namespace {

/// With `later`, "-" is the last item but for so many.
std::string resolved(const json& document, std::string_view pointer, std::optional<std::size_t> later) {
  std::string result;
  const json* place = &document;
  for (const std::string& token : steps_of(document, pointer)) {
    const bool appended = later && token == "-" && place && place->is_array() && place->size() > *later;
    const std::string key = appended ? std::to_string(place->size() - 1 - *later) : token;
    const auto index = place && place->is_array() ? item_index(*place, key) : std::nullopt;
    result = join_pointer(result, index ? std::to_string(*index) : key);
    if (place) place = child_of(*place, key);
  }
  return result;
}

}  // namespace

std::string resolve_names(const json& document, std::string_view pointer) {
  return resolved(document, pointer, std::nullopt);
}

json value_or_default(const json& document, std::string_view pointer) {
  const std::vector<std::string> tokens = steps_of(document, pointer);
  const json* place = &document;
  for (std::size_t i = 0; place && i < tokens.size(); ++i) place = child_of(*place, tokens[i]);
  if (!place) place = standard_at(document, tokens);
  return place ? *place : json();
}

std::string pointer_of(const json& document, std::string_view setting, std::size_t later) {
  return resolved(document, setting.substr(0, end_of_pointer(document, setting)), later);
}

void set_value(json& document, std::string_view pointer, json value, const fs::path& file,
               std::string_view subject) {
  const std::vector<std::string> tokens = steps_of(document, pointer);
  const Step step(document, tokens, subject, file);
  json* place = &document;
  for (std::size_t depth = 0; depth < tokens.size(); ++depth) place = step.go(*place, depth);
  *place = std::move(value);
}

void apply_override(json& document, std::string_view setting, const fs::path& file) {
  const std::size_t equals = end_of_pointer(document, setting);
  set_value(document, setting.substr(0, equals), parse_value(setting.substr(equals + 1), file), file,
            fmt::format("the setting {}", setting));
}

bool concerns(std::string_view setting, std::string_view place) {
  return !place.empty() && overlap(setting.substr(0, setting.find('=')), place);
}

}  // namespace sundog
