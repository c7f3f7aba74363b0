// Implements the C interface with the C++ one: turns exceptions into a status and details in an error handle.
#include "api/impl.h"
// Public headers must follow the host's (api/core.h).
#include <sundog/session.h>
#include <sundog/sundog.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>
#include <stop_token>

struct sundog_scene {
  sundog::v0::Scene scene;
};
struct sundog_devices {
  std::vector<sundog::v0::Device> list;
};
struct sundog_film {
  sundog::v0::Film film;
  std::vector<std::pair<std::string, sundog::v0::Image>> images;  // "": the beauty image
};
struct sundog_session {
  sundog::v0::Session session;
};
struct sundog_error {
  std::string line, file, place;
};

namespace sundog {
inline namespace v0 {
namespace {

sundog_status keep(sundog_error* error, sundog_status status, const char* line, const std::string& file = {},
                   const std::string& place = {}) noexcept {
  if (!error) return status;
  try {
    *error = {line, file, place};
  } catch (...) {
    *error = {};  // out of memory, even for the message
  }
  return status;
}

sundog_status status_of(ErrorKind kind) {
  return static_cast<sundog_status>(static_cast<int>(kind) + SUNDOG_USAGE);
}
static_assert(static_cast<int>(ErrorKind::internal) + SUNDOG_USAGE == SUNDOG_INTERNAL);
static_assert(static_cast<int>(SessionState::failed) == SUNDOG_FAILED);

/// Runs f(), which may throw or return a status.
template <class F>
sundog_status guarded(sundog_error* kept, const F& f) noexcept {
  try {
    if constexpr (std::is_void_v<decltype(f())>) {
      f();
      return SUNDOG_OK;
    } else {
      return f();
    }
  } catch (const Error& error) {
    return keep(kept, status_of(error.kind()), error.what(), error.file(), error.place());
  } catch (const std::exception& error) {
    return keep(kept, SUNDOG_INTERNAL, error.what());
  } catch (...) {
    return keep(kept, SUNDOG_INTERNAL, "an unknown exception");
  }
}

template <class T>
T& wanted(T* pointer, const char* name) {
  if (!pointer) throw Error(ErrorKind::usage, std::string(name) + ": wanted a value, found NULL");
  return *pointer;
}

std::vector<std::string> split(const char* list) {
  std::vector<std::string> items;
  for (const char* at = list; at && *at;) {
    const std::size_t length = std::strcspn(at, ",");
    items.emplace_back(at, length);
    at += length + (at[length] == ',');
  }
  return items;
}

/// Stores the result of `make` in a new handle.
template <class Handle, class F>
sundog_status made(sundog_error* error, Handle** handle, const char* name, const F& make) noexcept {
  return guarded(error, [&] {
    Handle*& result = wanted(handle, name);
    result = std::make_unique<Handle>(make()).release();
  });
}

/// Indices have 32 bits. Throws Error (usage) for larger counts, e.g. a negative number converted to size_t.
void check_count(std::size_t length) {
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorKind::usage,
                "a mesh of " + std::to_string(length) + " vertices or triangles: wanted at most 4294967295");
}

template <std::size_t count, class T>
std::span<const std::array<T, count>> groups(const T* values, std::size_t length) {
  static_assert(sizeof(std::array<T, count>) == count * sizeof(T));
  check_count(values ? length : 0);
  return {reinterpret_cast<const std::array<T, count>*>(values), values ? length : 0};
}

/// A view of C arrays. Throws Error (usage) for required arrays that are NULL.
MeshView mesh_of(const float* positions, size_t vertex_count, const uint32_t* triangles,
                 size_t triangle_count, const float* normals, const float* uvs) {
  wanted(positions, "positions");
  wanted(triangles, "triangles");
  return {.positions = groups<3>(positions, vertex_count),
          .triangles = groups<3>(triangles, triangle_count),
          .normals = groups<3>(normals, vertex_count),
          .uvs = groups<2>(uvs, vertex_count)};
}

/// Calls release() when the last holder lets go, provided that the mesh was handed over.
struct Owner {
  void (*release)(void* user);
  void* user;
  bool handed_over = false;

  Owner(void (*call)(void*), void* with) : release(call), user(with) {}
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;
  ~Owner() {
    if (!handed_over || !release) return;
    try {
      release(user);
    } catch (...) {  // no caller is left to report it to
    }
  }
};

RenderOptions options_of(const sundog_options* options, std::stop_source& stop) {
  RenderOptions result;
  if (!options) return result;
  if (options->devices) result.devices = options->devices->list;
  result.aovs = split(options->aovs);
  if (options->work_group_x > 0)
    result.work_group = {.x = options->work_group_x, .y = std::max(1u, options->work_group_y)};
  result.tile = options->tile;
  result.time_limit = options->time_limit;
  if (options->progress)
    result.on_progress = [call = options->progress, user = options->user, &stop](const Progress& now) {
      if (call(now.pixels_done, now.pixels_total, now.seconds, user) != 0) stop.request_stop();
    };
  result.stop = stop.get_token();
  return result;
}

}  // namespace
}  // namespace v0
}  // namespace sundog

using namespace sundog::v0;

const char* sundog_version(void) noexcept { return version_text(); }

sundog_error* sundog_error_new(void) noexcept { return new (std::nothrow) sundog_error; }
const char* sundog_error_line(const sundog_error* error) noexcept { return error ? error->line.c_str() : ""; }
const char* sundog_error_file(const sundog_error* error) noexcept { return error ? error->file.c_str() : ""; }
const char* sundog_error_place(const sundog_error* error) noexcept {
  return error ? error->place.c_str() : "";
}
void sundog_error_free(sundog_error* error) noexcept { delete error; }

sundog_status sundog_scene_load(const char* file, sundog_scene** scene, sundog_error* error) noexcept {
  return made(error, scene, "scene", [&] { return Scene::load(&wanted(file, "file")); });
}

sundog_status sundog_scene_load_frame(const char* file, double frame, sundog_scene** scene,
                                      sundog_error* error) noexcept {
  return made(error, scene, "scene", [&] { return Scene::load(&wanted(file, "file"), {.frame = frame}); });
}

sundog_status sundog_scene_from_json(const char* text, const char* folder, sundog_scene** scene,
                                     sundog_error* error) noexcept {
  return made(error, scene, "scene",
              [&] { return Scene::from_json(&wanted(text, "text"), folder ? folder : "."); });
}

sundog_status sundog_scene_set(sundog_scene* scene, const char* pointer, const char* json,
                               sundog_error* error) noexcept {
  return guarded(error, [&] {
    wanted(scene, "scene").scene.set(&wanted(pointer, "pointer"), std::string_view(&wanted(json, "json")));
  });
}

sundog_status sundog_scene_add_mesh(sundog_scene* scene, const char* name, const float* positions,
                                    size_t vertex_count, const uint32_t* triangles, size_t triangle_count,
                                    const float* normals, const float* uvs, sundog_error* error) noexcept {
  return guarded(error, [&] {
    const MeshView mesh = mesh_of(positions, vertex_count, triangles, triangle_count, normals, uvs);
    wanted(scene, "scene").scene.add_mesh(&wanted(name, "name"), mesh);
  });
}

sundog_status sundog_scene_hold_mesh(sundog_scene* scene, const char* name, const float* positions,
                                     size_t vertex_count, const uint32_t* triangles, size_t triangle_count,
                                     const float* normals, const float* uvs, void (*release)(void* user),
                                     void* user, sundog_error* error) noexcept {
  return guarded(error, [&] {
    MeshView mesh = mesh_of(positions, vertex_count, triangles, triangle_count, normals, uvs);
    const auto owner = std::make_shared<Owner>(release, user);
    mesh.owner = owner;
    wanted(scene, "scene").scene.add_mesh(&wanted(name, "name"), mesh);
    owner->handed_over = true;
  });
}

sundog_status sundog_scene_check(const sundog_scene* scene, sundog_error* error) noexcept {
  return guarded(error, [&] { (void)wanted(scene, "scene").scene.check(); });
}

void sundog_scene_free(sundog_scene* scene) noexcept { delete scene; }

sundog_status sundog_devices_list(sundog_devices** devices, sundog_error* error) noexcept {
  return made(error, devices, "devices", [&] { return sundog::v0::devices(); });
}

sundog_status sundog_devices_choose(const char* specs, sundog_devices** devices,
                                    sundog_error* error) noexcept {
  return made(error, devices, "devices", [&] { return choose_devices(split(specs)); });
}

size_t sundog_devices_count(const sundog_devices* devices) noexcept {
  return devices ? devices->list.size() : 0;
}

const char* sundog_devices_label(const sundog_devices* devices, size_t index) noexcept {
  return index < sundog_devices_count(devices) ? devices->list[index].label.c_str() : nullptr;
}

const char* sundog_devices_problem(const sundog_devices* devices, size_t index) noexcept {
  return index < sundog_devices_count(devices) ? devices->list[index].problem.c_str() : nullptr;
}

void sundog_devices_free(sundog_devices* devices) noexcept { delete devices; }

void sundog_wait_for_threads() noexcept { sundog::wait_for_threads(); }

sundog_status sundog_render(const sundog_scene* scene, const sundog_options* options, sundog_film** film,
                            sundog_error* error) noexcept {
  return guarded(error, [&]() -> sundog_status {
    sundog_film*& result = wanted(film, "film");
    std::stop_source stop;
    auto made = std::make_unique<sundog_film>();
    made->film = render(wanted(scene, "scene").scene, options_of(options, stop));
    made->images.emplace_back("", made->film.image());
    for (const std::string& name : made->film.aovs()) made->images.emplace_back(name, made->film.aov(name));
    result = made.release();
    return stop.stop_requested() ? keep(error, SUNDOG_STOPPED, "the progress callback ended the render")
                                 : SUNDOG_OK;
  });
}

int sundog_film_complete(const sundog_film* film) noexcept { return film && film->film.complete() ? 1 : 0; }

const char* sundog_film_warning(const sundog_film* film, size_t index) noexcept {
  return film && index < film->film.warnings().size() ? film->film.warnings()[index].c_str() : nullptr;
}

sundog_status sundog_film_pixels(const sundog_film* film, const char* aov, const float** pixels, int* width,
                                 int* height, int* channels, sundog_error* error) noexcept {
  return guarded(error, [&] {
    const std::string name = aov ? aov : "";
    const auto& images = wanted(film, "film").images;
    const auto found = std::ranges::find(images, name, &std::pair<std::string, Image>::first);
    if (found == images.end())
      throw Error(ErrorKind::usage, "the film has no AOV \"" + name + "\"; name it in sundog_options::aovs");
    wanted(pixels, "pixels") = found->second.pixels().data();
    if (width) *width = found->second.width();
    if (height) *height = found->second.height();
    if (channels) *channels = found->second.channels();
  });
}

sundog_status sundog_film_save(const sundog_film* film, const char* file, sundog_error* error) noexcept {
  return guarded(error, [&] { wanted(film, "film").film.save(&wanted(file, "file")); });
}

void sundog_film_free(sundog_film* film) noexcept { delete film; }

sundog_status sundog_session_open(const sundog_devices* devices, sundog_session** session,
                                  sundog_error* error) noexcept {
  return made(error, session, "session",
              [&] { return Session(devices ? devices->list : std::vector<Device>()); });
}

sundog_status sundog_session_start(sundog_session* session, const sundog_scene* scene,
                                   sundog_error* error) noexcept {
  return guarded(error, [&] { wanted(session, "session").session.start(wanted(scene, "scene").scene); });
}

sundog_status sundog_session_cancel(sundog_session* session, sundog_error* error) noexcept {
  return guarded(error, [&] { wanted(session, "session").session.cancel(); });
}

sundog_status sundog_session_wait(const sundog_session* session, double seconds, sundog_state* state,
                                  sundog_error* error) noexcept {
  return guarded(error, [&] {
    const Session& waiting = wanted(session, "session").session;
    if (seconds < 0)
      waiting.wait();
    else
      waiting.wait_for(seconds);
    const Snapshot now = waiting.snapshot(false);
    if (state) *state = static_cast<sundog_state>(now.state);
    if (now.state == SessionState::failed) throw Error(ErrorKind::device, now.error);
  });
}

sundog_status sundog_session_picture(const sundog_session* session, float* pixels, size_t capacity,
                                     int* width, int* height, sundog_error* error) noexcept {
  return guarded(error, [&] {
    const Image picture = wanted(session, "session").session.snapshot().picture;
    wanted(width, "width") = picture.width();
    wanted(height, "height") = picture.height();
    if (picture.pixels().empty()) return;
    if (picture.pixels().size() > capacity)
      throw Error(ErrorKind::usage, "the picture has " + std::to_string(picture.pixels().size()) +
                                        " floats; wanted room for them, found " + std::to_string(capacity));
    std::ranges::copy(picture.pixels(), &wanted(pixels, "pixels"));
  });
}

void sundog_session_free(sundog_session* session) noexcept { delete session; }
