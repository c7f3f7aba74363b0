// Splits JSON pointers (RFC 6901), and sets values by them; errors name the setting.
#include "scene/json/override.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/names.h"
#include "base/numbers.h"
#include "scene/json/parse.h"
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

/// The child that a token identifies; null: none.
const json* child_of(const json& parent, const std::string& token) {
  if (parent.is_array()) {
    const auto index = item_index(parent, token);
    return index ? &parent[*index] : nullptr;
  }
  const auto found = parent.find(token);  // end() unless `parent` is an object
  return found == parent.end() ? nullptr : &*found;
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
  Step(const std::vector<std::string>& tokens, std::string_view subject, const fs::path& file)
      : tokens_(tokens), subject_(subject), file_(file) {}

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

  /// Adds an object, unless the next token indexes an array or this token names a thing that must exist.
  void may_add(json& parent, std::size_t depth) const {
    const std::string& token = tokens_[depth];
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
    for (const std::string& token : split_pointer(setting.substr(0, at))) {
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

/// `appends`: "-" is the last item.
std::string resolved(const json& document, std::string_view pointer, bool appends) {
  std::string result;
  const json* place = &document;
  for (const std::string& token : split_pointer(pointer)) {
    auto index = place && place->is_array() ? item_index(*place, token) : std::nullopt;
    if (appends && place && place->is_array() && !place->empty() && token == "-") index = place->size() - 1;
    result = join_pointer(result, index ? std::to_string(*index) : token);
    if (place) place = index ? &(*place)[*index] : child_of(*place, token);
  }
  return result;
}

}  // namespace

std::string resolve_names(const json& document, std::string_view pointer) {
  return resolved(document, pointer, false);
}

std::string pointer_of(const json& document, std::string_view setting) {
  return resolved(document, setting.substr(0, end_of_pointer(document, setting)), true);
}

void set_value(json& document, std::string_view pointer, json value, const fs::path& file,
               std::string_view subject) {
  const std::vector<std::string> tokens = split_pointer(pointer);
  const Step step(tokens, subject, file);
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
