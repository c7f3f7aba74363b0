#include "app/serve/scene_document.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "base/error.h"
#include "scene/document.h"
#include "scene/json/override.h"
#include "scene/json/parse.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t most_undone = 200, most_tokens = max_json_depth;

[[noreturn]] void lead_nowhere(const std::string& pointer) {
  throw UsageError(fmt::format("{}: there is no such place in the scene", pointer));
}

std::vector<std::string> tokens_of(const std::string& pointer) {
  std::vector<std::string> tokens;
  try {
    for (json::json_pointer rest(pointer); !rest.empty(); rest.pop_back())
      tokens.insert(tokens.begin(), rest.back());
  } catch (const json::exception&) {
    lead_nowhere(pointer);
  }
  if (tokens.empty() || tokens.size() > most_tokens) lead_nowhere(pointer);
  return tokens;
}

std::size_t index_of(const json& array, const std::string& token, const std::string& pointer) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), index);
  if (error != std::errc() || end != token.data() + token.size() || index >= array.size())
    lead_nowhere(pointer);
  return index;
}

/// The child of `parent`; of an object it is made where it is missing.
json& child_of(json& parent, const std::string& token, const std::string& pointer) {
  if (parent.is_array()) {
    if (token == "-") return parent.emplace_back();
    return parent[index_of(parent, token, pointer)];
  }
  if (parent.is_null()) parent = token == "-" ? json::array() : json::object();
  if (parent.is_array()) return parent.emplace_back();
  if (!parent.is_object()) lead_nowhere(pointer);
  return parent[token];
}

void remove_child(json& parent, const std::string& token, const std::string& pointer) {
  if (parent.is_array())
    parent.erase(index_of(parent, token, pointer));
  else if (!parent.is_object())
    lead_nowhere(pointer);
  else
    parent.erase(token);
}

bool leads_on(const json& place, const std::string& token) {
  return place.is_array() || (place.is_object() && place.contains(token));
}

}  // namespace

void apply_change(json& document, const Change& change) {
  const std::vector<std::string> tokens = tokens_of(change.pointer);
  json* place = &document;
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    if (!change.value && !leads_on(*place, tokens[i])) return;  // what is not there need not be taken out
    place = &child_of(*place, tokens[i], change.pointer);
  }
  if (change.value)
    child_of(*place, tokens.back(), change.pointer) = *change.value;
  else
    remove_child(*place, tokens.back(), change.pointer);
}

void SceneDocument::begin(json document, const fs::path& file) {
  auto scene = std::make_shared<const SceneDescription>(load_scene_document(document, file));
  now_ = opened_ = std::move(document);
  file_ = file;
  scene_ = std::move(scene);
  past_.clear(), future_.clear(), gesture_.clear();
  ++version_;
}

void SceneDocument::open(const fs::path& file) { begin(read_scene_document(file), file); }

void SceneDocument::replace(json document, const fs::path& file) { begin(std::move(document), file); }

/// Reads the scene of `next`, and takes both.
void SceneDocument::take(json next) {
  auto scene = scene_ ? change_scene(*scene_, now_, next) : nullptr;
  if (!scene) scene = std::make_shared<const SceneDescription>(load_scene_document(next, file_));
  scene_ = std::move(scene);
  now_ = std::move(next);
  ++version_;
}

void SceneDocument::apply(const std::vector<Change>& changes, const std::string& gesture) {
  json next = now_, before = now_;
  for (const Change& change : changes) apply_change(next, change);
  take(std::move(next));
  future_.clear();
  if (!gesture.empty() && gesture == gesture_ && !past_.empty()) return;
  gesture_ = gesture;
  past_.push_back(std::move(before));
  if (past_.size() > most_undone) past_.pop_front();
}

bool SceneDocument::undo() {
  if (past_.empty()) return false;
  json before = now_;
  take(past_.back());
  past_.pop_back();
  future_.push_back(std::move(before));
  gesture_.clear();
  return true;
}

bool SceneDocument::redo() {
  if (future_.empty()) return false;
  json before = now_;
  take(future_.back());
  future_.pop_back();
  past_.push_back(std::move(before));
  gesture_.clear();
  return true;
}

std::optional<std::vector<std::string>> settings_between(const json& opened, const json& now,
                                                         const fs::path& file) {
  constexpr std::size_t most_settings = 40;
  const json patch = json::diff(opened, now);
  std::vector<std::string> settings;
  json made = opened;
  try {
    for (const json& step : patch) {
      if (step["op"] == "remove" || settings.size() == most_settings) return {};
      settings.push_back(fmt::format("{}={}", step["path"].get<std::string>(), step["value"].dump()));
      apply_override(made, settings.back(), file);
    }
  } catch (const std::exception&) {
    return {};
  }
  if (made != now) return {};
  return settings;
}

}  // namespace sundog
