// Applies changes to the document and checks them by reading the scene. An undo step is the whole document as
// CBOR; at most 200 steps and 64 MiB are kept.
#include "app/serve/scene_document.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/numbers.h"
#include "models/model.h"
#include "scene/description.h"
#include "scene/document.h"
#include "scene/json/override.h"
#include "scene/json/parse.h"

namespace sundog {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int most_shown_edge = 65500;  // a JPEG's limit

/// A session's bytes per pixel: film, picture, and the copy for pages. Measured from 2048x2048 to 4096x4096.
constexpr std::uint64_t bytes_a_shown_pixel = 130;

double gigabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e9; }

/// Throws SceneError at /image/width or /image/height if pages cannot show a picture of this size, or if it
/// needs more than a quarter of the `available` bytes (none: unknown). `shown` pixels are already in memory.
void check_frame(const SceneDescription& scene, std::int64_t shown, std::optional<std::uint64_t> available) {
  const int width = scene.image.width, height = scene.image.height;
  const auto refuse = [&](bool wide, const std::string& why) {
    throw SceneError(scene.file.string(), wide ? "/image/width" : "/image/height",
                     fmt::format("{}; `sundog render` renders it", why));
  };
  if (width > most_shown_edge || height > most_shown_edge)
    refuse(width > most_shown_edge, fmt::format("the viewer shows at most {} pixels an edge, found {}",
                                                most_shown_edge, std::max(width, height)));
  const std::int64_t pixels = std::int64_t{width} * height;
  const std::uint64_t bytes = bytes_a_shown_pixel * static_cast<std::uint64_t>(pixels);
  if (pixels > shown && available && bytes > *available / 4)
    refuse(
        width >= height,
        fmt::format(
            "{}x{} pixels take {:.1f} GB in the viewer, more than a quarter of the {:.1f} GB that are free",
            width, height, gigabytes(bytes), gigabytes(*available)));
}

constexpr std::size_t most_undone = 200, most_tokens = max_json_depth;
constexpr std::size_t most_undo_bytes = std::size_t{64} << 20;

/// Adds a step; drops the oldest steps beyond the limits.
void remember(std::deque<DocumentStep>& steps, DocumentStep newest) {
  steps.push_back(std::move(newest));
  std::size_t bytes = 0;
  for (const DocumentStep& step : steps) bytes += step.size();
  for (; steps.size() > most_undone || (bytes > most_undo_bytes && steps.size() > 1); steps.pop_front())
    bytes -= steps.front().size();
}

std::size_t text_size(const json& document) { return json_text(document).size(); }

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
  const auto index = whole_number<std::size_t>(token);
  if (!index || *index >= array.size()) lead_nowhere(pointer);
  return *index;
}

/// The child of `parent`; created if missing, unless `parent` is an array and `token` an index.
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

void check_document_size(std::uintmax_t bytes, const fs::path& file) {
  if (bytes > most_document_bytes)
    throw SceneError(file.string(), "",
                     fmt::format("the viewer holds scenes of at most {} bytes of JSON, found {}; keep meshes "
                                 "in files of their own",
                                 most_document_bytes, bytes));
}

void apply_change(json& document, const Change& change) {
  const std::vector<std::string> tokens = tokens_of(change.pointer);
  json* place = &document;
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {
    if (!change.value && !leads_on(*place, tokens[i])) return;  // nothing to remove
    place = &child_of(*place, tokens[i], change.pointer);
  }
  if (change.value)
    child_of(*place, tokens.back(), change.pointer) = *change.value;
  else
    remove_child(*place, tokens.back(), change.pointer);
}

/// Throws SceneError for a document or picture that is too large for the viewer.
void SceneDocument::check(const json& next, const SceneDescription& scene) const {
  check_document_size(text_size(next), scene.file);
  const std::int64_t shown = scene_ ? std::int64_t{scene_->image.width} * scene_->image.height : 0;
  check_frame(scene, shown, available_memory());
}

void SceneDocument::begin(json document, const fs::path& file) {
  auto scene = std::make_shared<const SceneDescription>(load_scene_document(document, file));
  check(document, *scene);
  now_ = opened_ = std::move(document);
  file_ = file;
  scene_ = std::move(scene);
  past_.clear(), future_.clear(), gesture_.clear();
  opened_version_ = ++version_;
}

void SceneDocument::open(const fs::path& file) {
  std::error_code missing;  // read_scene_document() reports it
  const std::uintmax_t bytes = fs::file_size(file, missing);
  if (!missing && !is_model_file(file)) check_document_size(bytes, file);
  begin(read_scene_document(file), file);
  is_file_ = true;
}

void SceneDocument::replace(json document, const fs::path& file) {
  begin(std::move(document), file);
  is_file_ = false;
}

/// Reads the scene of `next`, checks it, and makes both current.
void SceneDocument::take(json next) {
  auto scene = scene_ ? change_scene(*scene_, now_, next) : nullptr;
  if (!scene) scene = std::make_shared<const SceneDescription>(load_scene_document(next, file_));
  check(next, *scene);
  scene_ = std::move(scene);
  now_ = std::move(next);
  ++version_;
}

void SceneDocument::apply(const std::vector<Change>& changes, const std::string& gesture) {
  json next = now_;
  for (const Change& change : changes) apply_change(next, change);
  DocumentStep before = json::to_cbor(now_);
  take(std::move(next));
  future_.clear();
  if (!gesture.empty() && gesture == gesture_ && !past_.empty()) return;
  gesture_ = gesture;
  remember(past_, std::move(before));
}

bool SceneDocument::step(std::deque<DocumentStep>& from, std::deque<DocumentStep>& to) {
  if (from.empty()) return false;
  DocumentStep before = json::to_cbor(now_);
  take(json::from_cbor(from.back()));
  from.pop_back();
  remember(to, std::move(before));
  gesture_.clear();
  return true;
}

bool SceneDocument::undo() { return step(past_, future_); }

bool SceneDocument::redo() { return step(future_, past_); }

std::optional<std::vector<std::string>> settings_between(const json& opened, const json& now,
                                                         const fs::path& file) {
  constexpr std::size_t most_settings = 40;
  const json patch = json::diff(opened, now);
  std::vector<std::string> settings;
  json made = opened;
  try {
    for (const json& step : patch) {
      if (step["op"] == "remove" || settings.size() == most_settings) return {};
      settings.push_back(fmt::format("{}={}", step["path"].get<std::string>(), json_text(step["value"])));
      apply_override(made, settings.back(), file);
    }
  } catch (const std::exception&) {
    return {};
  }
  if (made != now) return {};
  return settings;
}

}  // namespace sundog
