// In this order: the document of the file or around the model, settings, the frame's tracks, then the
// readers.
#include "scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>

#include "base/error.h"
#include "base/file.h"
#include "models/model.h"
#include "scene/animate.h"
#include "scene/document.h"
#include "scene/integrators.h"
#include "scene/json/override.h"
#include "scene/json/parse.h"
#include "scene/model_scene.h"
#include "scene/read/frame_cache.h"
#include "scene/read/scene_reader.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

void apply_overrides(json& document, const fs::path& file, const std::vector<std::string>& overrides) {
  for (const std::string& setting : overrides) try {
      apply_override(document, setting, file);
    } catch (const SceneError& error) {
      throw SettingError(error.file, error.place, error.reason, error.remedy);
    }
}

/// Width / height of a document's image; 0 if missing or invalid (reading will report the error).
double aspect_of(const json& document) {
  const auto size = [&](const char* pointer) {
    const json::json_pointer place(pointer);
    return document.contains(place) && document[place].is_number() ? document[place].get<double>() : 0;
  };
  const double height = size("/image/height");
  return height > 0 ? std::max(size("/image/width"), 0.0) / height : 0;
}

/// Generates the document around a model. Its camera fits the overridden image size, and its ground the
/// overridden camera.
json make_scene(const fs::path& file, const Model& model, const std::vector<std::string>& overrides,
                bool plays = false) {
  json document = make_model_scene(file, model, std::nullopt, plays);
  json changed = document;
  apply_overrides(changed, file, overrides);
  const double aspect = aspect_of(changed);
  if (aspect > 0 && aspect != aspect_of(document)) document = make_model_scene(file, model, aspect, plays);
  const json::json_pointer height("/camera/position/1");
  if (changed.contains(height) && changed[height].is_number())
    take_ground_above(document, changed[height].get<double>());
  return document;
}

/// The integrator that a document names, or the default one; nullptr if invalid (reading will report it).
const Integrator* integrator_in(const json& document) {
  const json::json_pointer place("/render/integrator");
  if (!document.contains(place)) return &integrators.front();
  return document[place].is_string() ? find_integrator(document[place].get<std::string>()) : nullptr;
}

/// A file's document before any frame is applied, with the model around which it was generated, if any.
struct SceneSource {
  fs::path file;
  json document;
  std::optional<Model> model = std::nullopt;
  json played = {};  // for a model with animations: the document before settings
};

/// Reads the model and generates the document around it. Generated lights need materials read for paths, so
/// the model may be read twice.
void read_model(SceneSource& source, const std::vector<std::string>& overrides, bool outside_files) {
  const auto read = [&](std::optional<bool> for_paths) {
    source.model = load_model(source.file, {.outside_files = outside_files, .for_paths = for_paths});
  };
  json stated = json::object();
  for (const std::string& setting : overrides)
    if (setting.starts_with("/render/integrator=")) apply_override(stated, setting, source.file);
  const Integrator* wanted = integrator_in(stated);
  read(wanted && wanted->own_materials ? std::optional(true) : std::nullopt);
  source.document = make_scene(source.file, *source.model, overrides);
  apply_overrides(source.document, source.file, overrides);
  wanted = integrator_in(source.document);
  if (!wanted || wanted->own_materials == source.model->for_paths) return;
  if (source.model->pose) source.played = make_scene(source.file, *source.model, overrides, true);
  source.model.reset();
  read(wanted->own_materials);
}

SceneSource open_source(const fs::path& path, const std::vector<std::string>& overrides,
                        const LoadOptions& options) {
  SceneSource source{path, {}};
  const HostEnvironment& environment = value_of(options.environment);
  if (is_standard_input(path) && environment.standard_input) {
    source.file = scene_file_name(path);
    source.document = parse_json(environment.standard_input(), source.file);
  } else {
    require_readable(path, path, "");
    if (is_model_file(path)) {
      read_model(source, overrides, options.outside_files);
      return source;
    } else if (lower_extension(path) == ".json") {
      source.document = read_json_file(path, environment.faults);
    } else {
      throw SceneError(path.string(), "",
                       "wanted a scene (.json) or a model (" SUNDOG_MODEL_EXTENSIONS
                       ", each also .gz), found another extension");
    }
  }
  apply_overrides(source.document, source.file, overrides);
  return source;
}

/// Inputs and logs of reading a document.
struct Reading {
  const fs::path& file;
  const std::vector<std::string>& overrides;
  const LoadOptions& options;
  std::vector<std::string> warnings = {};
  FrameCache* cache = nullptr;
  std::optional<double> seconds = std::nullopt;  // the frame's time
  bool plays = false;

  JsonContext context() {
    return {.file = file,
            .native_code = options.native_code,
            .warnings = &warnings,
            .measures = !(cache && cache->checks()),
            .outside_files = options.outside_files,
            .cache = cache,
            .seconds = seconds,
            .plays = &plays};
  }
};

/// Calls read(). An error's place is in the document as changed by settings and tracks, so the error names
/// the track or setting that changed it.
template <class Read>
auto explained(const json& document, const Reading& reading, const Read& read) {
  try {
    return read();
  } catch (const SceneError& error) {
    if (error.file != reading.file.string() || error.place.empty()) throw;
    if (const auto frame = reading.options.frame; frame && !error.place.starts_with("/animate"))
      if (const std::string track = track_of(document, error.place); !track.empty())
        throw SceneError(error.file, error.place,
                         fmt::format("{} (in frame {}, moved by {})", error.reason, *frame, track),
                         error.remedy);
    std::map<std::string, std::size_t> later;                                  // settings behind, by pointer
    for (const std::string& setting : std::views::reverse(reading.overrides))  // the last one counts
      if (overlap(pointer_of(document, setting, later[setting.substr(0, setting.find('='))]++), error.place))
        throw SettingError(error.file, error.place,
                           fmt::format("{} (changed by the setting {})", error.reason, setting),
                           error.remedy);
    throw;
  }
}

/// The document around an animated model, with the model's camera and lights at the frame.
json play_view(SceneSource& source, const Reading& reading) {
  if (source.played.is_null())
    source.played = make_scene(source.file, *source.model, reading.overrides, true);
  json document = source.played;
  apply_overrides(document, source.file, reading.overrides);
  const json object = document.value(json::json_pointer("/objects/0"), json::object());
  const auto name = object.find("animation"), cycle = object.find("cycle");
  Playing playing{.seconds = seconds_at(document, *reading.options.frame)};
  if (name != object.end() && name->is_string()) playing.animation = name->get<std::string>();
  if (cycle != object.end() && cycle->is_boolean()) playing.cycle = cycle->get<bool>();
  document = source.played;
  set_view(document, posed(*source.model, source.file, playing));
  apply_overrides(document, source.file, reading.overrides);
  return document;
}

/// The document before tracks are applied.
json unmoved_document(SceneSource& source, const Reading& reading) {
  const bool plays = reading.options.frame && source.model && source.model->pose;
  return plays ? play_view(source, reading) : source.document;
}

/// The frame's document. Refuses a setting that a track would undo.
json document_at_frame(SceneSource& source, Reading& reading) {
  json document = unmoved_document(source, reading);
  if (!reading.options.frame) return document;
  const JsonContext context = reading.context();
  explained(document, reading, [&] { apply_animation(document, *reading.options.frame, context); });
  for (const std::string& setting : reading.overrides)
    if (const std::string track = track_of(document, pointer_of(document, setting), true); !track.empty())
      throw SettingError(
          reading.file.string(), track,
          fmt::format("sets in each frame what the setting {} sets too: leave that out, or change the track",
                      setting));
  return document;
}

SceneDescription read_document(const json& document, Reading& reading, std::optional<Model> model,
                               const NamedMeshes& made = {}) {
  if (const auto frame = reading.options.frame) reading.seconds = seconds_at(document, *frame);
  return explained(document, reading, [&] {
    const JsonContext context = reading.context();
    SceneDescription scene = read_scene(JsonValue(document, context), std::move(model), made);
    scene.warnings.insert(scene.warnings.end(), reading.warnings.begin(), reading.warnings.end());
    return scene;
  });
}

}  // namespace

struct SceneFrames::State {
  SceneSource source;
  std::vector<std::string> overrides;
  LoadOptions options;
  FrameCache cache = {};
  json document = {};                               // the last frame's
  std::shared_ptr<const SceneDescription> scene{};  // read from that document; null: none was read
};

SceneFrames::SceneFrames(const fs::path& path, std::vector<std::string> overrides, LoadOptions options)
    : state_(std::make_unique<State>(open_source(path, overrides, options), std::move(overrides),
                                     std::move(options))) {
  if (auto& model = state_->source.model)
    for (Mesh& mesh : model->meshes) share_vertices(mesh);
}

SceneFrames::~SceneFrames() = default;

std::shared_ptr<const SceneDescription> SceneFrames::read(std::optional<double> frame) {
  State& state = *state_;
  LoadOptions options = state.options;
  options.frame = frame;
  Reading reading{state.source.file, state.overrides, options, {}, &state.cache};
  json document = document_at_frame(state.source, reading);
  std::shared_ptr<const SceneDescription> next;
  if (state.scene && !state.scene->plays)
    next = explained(document, reading,
                     [&] { return change_scene(*state.scene, state.document, document, options); });
  if (!next) {
    next = std::make_shared<const SceneDescription>(read_document(document, reading, state.source.model));
    state.cache.end_frame();
  }
  state.document = std::move(document);
  return state.scene = std::move(next);
}

std::shared_ptr<const SceneDescription> SceneFrames::check(const std::vector<int>& frames) {
  std::shared_ptr<const SceneDescription> first;
  state_->cache.check(true);
  for (const int frame : frames)
    if (const auto scene = read(frame); !first) first = scene;
  state_->cache.check(false);
  state_->scene = nullptr;
  return first;
}

Shutter SceneFrames::shutter() const {
  const auto number = [&](const char* key, double otherwise) {
    const json::json_pointer place(std::string("/camera/") + key);
    const json& document = state_->source.document;
    return document.contains(place) && document[place].is_number() ? document[place].get<double>()
                                                                   : otherwise;
  };
  return {number("shutter", 0), static_cast<int>(number("shutter_steps", 16))};
}

bool is_standard_input(const fs::path& path) { return path == "-" || path == "/dev/stdin"; }

std::string scene_file_name(const fs::path& path) {
  return is_standard_input(path) ? "standard input" : path.string();
}

SceneDescription load_scene(const fs::path& path, const std::vector<std::string>& overrides,
                            const LoadOptions& options) {
  SceneSource source = open_source(path, overrides, options);
  Reading reading{source.file, overrides, options};
  const json document = document_at_frame(source, reading);
  return read_document(document, reading, std::move(source.model));
}

json read_scene_document(const fs::path& path, const LoadOptions& options) {
  constexpr const char* keys[] = {"width", "height"};
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < 2; ++i)
    if (options.size[i] > 0) overrides.push_back(fmt::format("/image/{}={}", keys[i], options.size[i]));
  SceneSource source = open_source(path, overrides, options);
  return unmoved_document(source, {source.file, overrides, options});
}

SceneDescription load_scene_document(const json& document, const fs::path& file, const LoadOptions& options,
                                     const NamedMeshes& made) {
  const std::vector<std::string> no_overrides;
  Reading reading{file, no_overrides, options};
  SceneDescription scene = read_document(document, reading, std::nullopt, made);
  if (made.empty())  // meshes of the calling program are already shared
    for (Mesh& mesh : scene.meshes) share_vertices(mesh);
  return scene;
}

}  // namespace sundog
