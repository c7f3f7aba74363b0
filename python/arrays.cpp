// Converts arrays, JSON, scenes and devices between Python and the library.
#include "values.h"

#include <dlfcn.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <tuple>
#include <utility>

namespace {

template <std::size_t count, class Array>
auto groups(const Array& array) {
  using Number = std::remove_cv_t<std::remove_pointer_t<decltype(array.data())>>;
  return std::span(reinterpret_cast<const std::array<Number, count>*>(array.data()), array.shape(0));
}

/// Arrays that nobody reads any more, to be freed.
std::atomic<const HeldArrays*> let_go_of{nullptr};

/// Frees them. The caller must hold the interpreter's lock.
int free_let_go(void*) {
  for (const HeldArrays* held = let_go_of.exchange(nullptr); held;) delete std::exchange(held, held->next);
  return 0;
}

/// Whether this thread holds the interpreter's lock; false if the interpreter does not tell.
bool has_interpreter() {
  static const auto check =  // outside the stable ABI
      reinterpret_cast<int (*)()>(::dlsym(RTLD_DEFAULT, "PyGILState_Check"));
  return check && check() == 1;
}

/// Deletes the arrays. The last owner may be a thread of the library, which must not wait for the
/// interpreter's lock, because a thread that holds it may wait for this one. Then the interpreter frees them
/// later.
void let_go(const HeldArrays* held) {
  if (!Py_IsInitialized()) return;
  held->next = let_go_of;
  while (!let_go_of.compare_exchange_weak(held->next, held)) {
  }
  if (has_interpreter())
    free_let_go(nullptr);
  else
    Py_AddPendingCall(free_let_go, nullptr);  // if its queue is full, a later call frees these too
}

}  // namespace

Pixels pixels_of(const sundog::Image& image) {
  auto* shared = new sundog::Image(image);
  const nb::capsule owner(shared, [](void* held) noexcept { delete static_cast<sundog::Image*>(held); });
  const std::size_t shape[] = {std::size_t(image.height()), std::size_t(image.width()),
                               std::size_t(image.channels())};
  return Pixels(image.pixels().data(), image.channels() == 1 ? 2 : 3, shape, owner);
}

sundog::Image image_of(const PixelsIn& pixels) {
  if (pixels.ndim() != 2 && pixels.ndim() != 3)
    throw sundog::Error(sundog::ErrorKind::usage,
                        "an image wants an array of (height, width, channels) or (height, width)");
  const int channels = pixels.ndim() == 3 ? int(pixels.shape(2)) : 1;
  return {int(pixels.shape(1)), int(pixels.shape(0)), channels, std::span(pixels.data(), pixels.size())};
}

void add_mesh(OwnScene& scene, const std::string& name, const Floats3& positions, const Indices& triangles,
              const std::optional<Floats3>& normals, const std::optional<Floats2>& uvs,
              const std::optional<Floats3>& colors) {
  sundog::MeshView mesh{.positions = groups<3>(positions), .triangles = groups<3>(triangles)};
  if (normals) mesh.normals = groups<3>(*normals);
  if (uvs) mesh.uvs = groups<2>(*uvs);
  if (colors) mesh.colors = groups<3>(*colors);
  // The scene reads the arrays in place.
  const std::shared_ptr<const HeldArrays> held(new HeldArrays{positions, triangles, normals, uvs, colors},
                                               let_go);
  mesh.owner = held;
  scene.add_mesh(name, mesh);
  scene.arrays[name] = held;
  ++scene.edits;
  free_let_go(nullptr);
}

std::string json_of(nb::handle value) {
  const nb::object plain = nb::cpp_function([](nb::handle other) -> nb::object {
    if (nb::hasattr(other, "tolist")) return other.attr("tolist")();
    throw nb::type_error("a scene holds dicts, lists, numbers, text, True, False and None");
  });
  return nb::cast<std::string>(nb::module_::import_("json").attr("dumps")(value, nb::arg("default") = plain));
}

nb::object value_of(const std::string& json) { return nb::module_::import_("json").attr("loads")(json); }

OwnScene load_scene(const std::filesystem::path& file, const sundog::LoadOptions& options) {
  const Unlocked unlocked;
  return {sundog::Scene::load(file, options), std::filesystem::absolute(file).parent_path(), options};
}

OwnScene scene_of(nb::handle value) {
  if (nb::isinstance<OwnScene>(value)) {
    if (!nb::inst_ready(value)) throw nb::type_error("sundog.Scene: its __init__() was not called");
    return nb::cast<OwnScene&>(value);
  }
  if (nb::isinstance<nb::dict>(value)) return sundog::Scene::from_json(json_of(value));
  const nb::bytes file(nb::module_::import_("os").attr("fsencode")(value));
  return load_scene(std::string(file.c_str(), file.size()), {});
}

namespace {

using Meshes = std::map<std::string, std::tuple<Floats3, Indices, std::optional<Floats3>,
                                                std::optional<Floats2>, std::optional<Floats3>>>;

}  // namespace

nb::tuple state_of(const OwnScene& scene) {
  Meshes meshes;
  for (const auto& [name, held] : scene.arrays)
    meshes.try_emplace(name, held->positions, held->triangles, held->normals, held->uvs, held->colors);
  const sundog::LoadOptions& options = scene.options;
  return nb::make_tuple(scene.to_json(), scene.folder, options.frame, options.native_code,
                        options.outside_files, options.size, meshes);
}

OwnScene scene_of_state(const nb::tuple& state) {
  const auto folder = nb::cast<std::filesystem::path>(state[1]);
  const sundog::LoadOptions options{.frame = nb::cast<std::optional<double>>(state[2]),
                                    .native_code = nb::cast<bool>(state[3]),
                                    .outside_files = nb::cast<bool>(state[4]),
                                    .size = nb::cast<std::array<int, 2>>(state[5])};
  OwnScene scene(sundog::Scene::from_json(nb::cast<std::string>(state[0]), folder, options), folder, options);
  for (const auto& [name, mesh] : nb::cast<Meshes>(state[6])) {
    const auto& [positions, triangles, normals, uvs, colors] = mesh;
    add_mesh(scene, name, positions, triangles, normals, uvs, colors);
  }
  return scene;
}

SceneInUse::SceneInUse(nb::handle value) : copy_(scene_of(value)) {
  if (!nb::isinstance<OwnScene>(value)) return;
  owner_ = nb::borrow(value);
  edits_ = nb::cast<OwnScene&>(value).edits;
}

SceneInUse::~SceneInUse() {
  if (!owner_.is_valid()) return;
  auto& own = nb::cast<OwnScene&>(owner_);
  if (own.edits == edits_) static_cast<sundog::Scene&>(own) = std::move(copy_);
}

std::vector<sundog::Device> devices_of(nb::handle value) {
  if (value.is_none()) return {};
  if (nb::isinstance<sundog::Device>(value)) return {nb::cast<sundog::Device>(value)};
  if (nb::isinstance<nb::str>(value)) return sundog::choose_devices({nb::cast<std::string>(value)});
  std::vector<sundog::Device> devices;
  std::vector<std::string> specs;
  for (const nb::handle item : nb::iter(value))
    if (nb::isinstance<nb::str>(item))
      specs.push_back(nb::cast<std::string>(item));
    else if (nb::isinstance<sundog::Device>(item))
      devices.push_back(nb::cast<sundog::Device>(item));
    else
      throw nb::type_error(
          ("devices: wanted a sundog.Device, a text such as \"cpu\", or a list of these, found " +
           nb::cast<std::string>(nb::repr(item)))
              .c_str());
  if (!specs.empty())
    for (sundog::Device& device : sundog::choose_devices(specs)) devices.push_back(std::move(device));
  return devices;
}
