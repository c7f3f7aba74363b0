// Implements the public Scene: a JSON document and meshes from memory.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "api/impl.h"
#include "base/json_text.h"

namespace sundog {
inline namespace v0 {
namespace {

using nlohmann::json;

[[noreturn]] void fail_at(std::string_view pointer, const std::string& reason) {
  throw Error(ErrorKind::usage, std::string(pointer) + ": " + reason,
              {.file = {}, .place = std::string(pointer), .reason = reason, .log = {}});
}

/// Calls f() with the parsed pointer; turns the JSON library's exceptions into Errors.
template <class F>
auto at(std::string_view pointer, const F& f) {
  try {
    return f(json::json_pointer(std::string(pointer)));
  } catch (const json::exception&) {
    fail_at(pointer, "wanted a JSON pointer that leads to a value, such as /camera/fov");
  }
}

/// Whether a value can be set at `place`: array indices must exist or append.
bool has_room(const json& document, json::json_pointer place) {
  for (std::size_t depth = 0; !place.empty(); place = place.parent_pointer()) {
    if (++depth > sundog::max_json_depth) return false;
    const json::json_pointer around = place.parent_pointer();
    const json* parent = document.contains(around) ? &document.at(around) : nullptr;
    if (parent && parent->is_object()) continue;
    const std::string& key = place.back();
    const bool index = !key.empty() && key.find_first_not_of("0123456789") == std::string::npos;
    const std::size_t rows = parent && parent->is_array() ? parent->size() : 0;
    if (index && (key.size() > 9 || std::stoul(key) > rows)) return false;
  }
  return true;
}

core::LoadOptions options_of(const LoadOptions& options) {
  for (const int pixels : options.size)
    if (pixels < 0)
      throw UsageError(fmt::format("size: wanted pixels, or 0 for the file's, found {}", pixels));
  if (options.frame && !std::isfinite(*options.frame))
    throw UsageError(fmt::format("frame: wanted a frame's number, found {}", *options.frame));
  return {options.frame, options.native_code, options.outside_files, options.size};
}

}  // namespace

Scene::Impl::Impl() : document({{"objects", json::array()}}), file(no_file) {}

Scene::Impl::Impl(const Impl& other)
    : document(other.document), file(other.file), options(other.options), meshes(other.meshes) {
  const std::lock_guard lock(other.mutex_);
  described_document_ = other.described_document_;
  described_ = other.described_;
}

void Scene::Impl::forget_description() {
  std::shared_ptr<const SceneDescription> old;  // freed outside the lock: a mesh's owner may run any code
  const std::lock_guard lock(mutex_);
  old.swap(described_);
}

std::shared_ptr<const SceneDescription> Scene::Impl::describe() const {
  enter_threads();
  std::shared_ptr<const SceneDescription> old, next;
  const std::lock_guard lock(mutex_);
  if (described_ && described_document_ == document) return described_;
  if (described_ && !options.frame) next = change_scene(*described_, described_document_, document, options);
  if (!next) {
    json moved = document;
    if (options.frame) apply_animation(moved, *options.frame, JsonContext{.file = file});
    next = std::make_shared<const SceneDescription>(load_scene_document(moved, file, options, meshes));
  }
  described_document_ = document;
  old = std::exchange(described_, std::move(next));
  return described_;
}

Scene::Scene() : impl_(std::make_unique<Impl>()) {}
Scene::Scene(const Scene& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Scene Scene::load(const std::filesystem::path& file, const LoadOptions& options) {
  return translated([&] {
    Scene scene;
    scene.impl_->options = options_of(options);
    scene.impl_->document = read_scene_document(file, scene.impl_->options);
    std::error_code failed;
    scene.impl_->file = std::filesystem::absolute(file, failed);  // the program may change its folder
    if (failed) scene.impl_->file = file;
    return scene;
  });
}

Scene Scene::from_json(std::string_view text, const std::filesystem::path& folder,
                       const LoadOptions& options) {
  return translated([&] {
    Scene scene;
    scene.impl_->options = options_of(options);
    scene.impl_->file = folder == "." ? no_file : folder / no_file;
    scene.impl_->document = sundog::parse_json(text, scene.impl_->file);
    return scene;
  });
}

std::string Scene::to_json() const { return json_text(impl_->document, 2); }

std::string Scene::get(std::string_view pointer) const {
  return at(pointer, [&](const json::json_pointer& place) { return json_text(impl_->document.at(place)); });
}

bool Scene::contains(std::string_view pointer) const {
  return at(pointer, [&](const json::json_pointer& place) { return impl_->document.contains(place); });
}

Scene& Scene::set(std::string_view pointer, std::string_view text) {
  json value;
  try {
    value = sundog::parse_json(text, no_file);
  } catch (const SceneError& error) {
    fail_at(pointer, "wanted JSON, found " + std::string(text.substr(0, 40)) + ": " + error.reason);
  }
  json changed = impl_->document;
  at(pointer, [&](const json::json_pointer& place) {
    if (!has_room(changed, place))
      fail_at(pointer, "wanted a place in the document, or behind an array's last row");
    changed[place] = std::move(value);
  });
  impl_->document = std::move(changed);
  return *this;
}

Scene& Scene::set(std::string_view pointer, double value) { return set(pointer, json_text(json(value))); }

Scene& Scene::remove(std::string_view pointer) {
  at(pointer, [&](const json::json_pointer& place) {
    json& parent = impl_->document.at(place.parent_pointer());
    if (place.empty() || !impl_->document.contains(place)) fail_at(pointer, "there is no such value");
    if (parent.is_array())
      parent.erase(std::stoul(place.back()));
    else
      parent.erase(place.back());
  });
  return *this;
}

std::vector<std::string> Scene::check() const {
  return translated([&] { return impl_->describe()->warnings; });
}

}  // namespace v0
}  // namespace sundog
