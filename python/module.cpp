// The Python module: the library's classes and functions under the names in its headers.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>
#include <unistd.h>

#include "values.h"

using namespace sundog;
using WithoutLock = nb::call_guard<Unlocked>;

// Arrays of other numbers are converted, so a checker of types must let them pass.
#define ANY_NUMBERS "numpy.typing.NDArray[numpy.floating | numpy.integer]"

namespace {

constexpr const char* states[] = {"idle",    "compiling", "preparing", "drawing",
                                  "settled", "stopped",   "failed"};

nb::typed<nb::list, nb::str> texts_of(const std::vector<std::string>& texts) {
  nb::list result;
  for (const std::string& text : texts) result.append(text_of(text));
  return result;
}

/// The image as PNG; None for fewer than three channels, so that a notebook shows its text instead.
nb::object png_of(const Image& image) {
  if (image.channels() < 3) return nb::none();
  const std::string bytes = [&] {
    const Unlocked unlocked;
    return image.encode("png");
  }();
  return nb::bytes(bytes.data(), bytes.size());
}

nb::dict dict_of(const DeviceFigures& figures) {
  nb::dict result;
  result["label"] = figures.label;
  result["tiles"] = figures.tiles;
  result["pixels"] = figures.pixels;
  result["share"] = figures.share;
  result["busy_seconds"] = figures.busy_seconds;
  result["kernel_ms"] = figures.kernel_ms;
  result["retired"] = figures.retired;
  result["messages"] = figures.messages;
  return result;
}

nb::dict dict_of(const Figures& figures) {
  nb::dict result;
  result["primary"] = figures.primary;
  result["reflection"] = figures.reflection;
  result["refraction"] = figures.refraction;
  result["shadow"] = figures.shadow;
  result["march_steps"] = figures.march_steps;
  result["dropped_samples"] = figures.dropped_samples;
  result["compile_seconds"] = figures.compile_seconds;
  result["build_seconds"] = figures.build_seconds;
  result["render_seconds"] = figures.render_seconds;
  result["cached"] = figures.cached;
  result["efficiency"] = figures.efficiency;
  nb::list devices;
  for (const DeviceFigures& device : figures.devices) devices.append(dict_of(device));
  result["devices"] = devices;
  return result;
}

Film render_scene(nb::handle scene, nb::handle devices, const std::vector<std::string>& aovs,
                  std::optional<std::pair<unsigned, unsigned>> work_group, int tile, double time_limit,
                  std::function<nb::object(std::uint64_t, std::uint64_t, double)> on_progress,
                  std::function<void(Image)> on_picture, double picture_seconds) {
  const SceneInUse used(scene);
  std::stop_source stop;
  RenderOptions options{.devices = devices_of(devices), .aovs = aovs, .tile = tile, .time_limit = time_limit};
  if (work_group) options.work_group = {.x = work_group->first, .y = work_group->second};
  options.stop = stop.get_token();
  if (on_progress)
    options.on_progress = [&](const Progress& now) {
      const nb::gil_scoped_acquire acquire;
      if (on_progress(now.pixels_done, now.pixels_total, now.seconds).ptr() == Py_False) stop.request_stop();
    };
  if (on_picture)
    options.on_picture = [&](const Image& image) {
      const nb::gil_scoped_acquire acquire;
      on_picture(image);
    };
  options.picture_seconds = picture_seconds;
  return interruptible([&] { return render(used.scene(), options); }, [&] { stop.request_stop(); });
}

/// A session that is destroyed without the interpreter's lock, because it waits for its threads. The
/// destructor releases the lock before the base Session is destroyed; ReleasedAtEnd takes it again
/// afterwards.
struct ReleasedAtEnd {
  std::optional<Call> call;
  std::optional<nb::gil_scoped_release> released;
};
struct OpenSession : private ReleasedAtEnd, public Session {
  using Session::Session;
  OpenSession(const OpenSession&) = delete;
  OpenSession& operator=(const OpenSession&) = delete;
  ~OpenSession() { call.emplace(), released.emplace(); }
};

void add_images(nb::module_& m) {
  nb::class_<Device>(m, "Device", "One OpenCL device, as devices() and choose_devices() give it.")
      .def_ro("label", &Device::label)
      .def_ro("platform", &Device::platform)
      .def_ro("index", &Device::index)
      .def_ro("platform_name", &Device::platform_name)
      .def_ro("name", &Device::name)
      .def_ro("vendor", &Device::vendor)
      .def_ro("driver", &Device::driver)
      .def_ro("type", &Device::type)
      .def_ro("compute_units", &Device::compute_units)
      .def_ro("global_memory", &Device::global_memory, "Bytes.")
      .def_ro("usable", &Device::usable)
      .def_ro("problem", &Device::problem, "Why it is not usable.")
      .def("__repr__", [](const Device& device) { return "<sundog.Device " + device.label + ">"; });
  m.def("devices", &devices, WithoutLock(), "Every device, the broken ones too.");
  m.def(
      "choose_devices",
      [](nb::handle specs) { return specs.is_none() ? choose_devices() : devices_of(specs); },
      nb::arg("specs").none() = nb::none(),
      "The devices that a spec or a list of them means: \"cpu\", \"0:1\", a part of a name. None: the "
      "fastest.");
  nb::class_<Image>(m, "Image", "Linear floats that copies share.")
      .def(
          "__init__", [](Image* self, const PixelsIn& pixels) { new (self) Image(image_of(pixels)); },
          nb::arg("pixels"), nb::sig("def __init__(self, pixels: " ANY_NUMBERS ") -> None"),
          "A copy of an array of (height, width, channels) or (height, width).")
      .def_prop_ro("width", &Image::width)
      .def_prop_ro("height", &Image::height)
      .def_prop_ro("channels", &Image::channels)
      .def_prop_ro("pixels", &pixels_of, nb::rv_policy::automatic,
                   "numpy, read-only, without a copy: (height, width, channels), float32.")
      .def(
          "__array__",
          [](const Image& image, nb::handle dtype, nb::handle copy) -> nb::object {
            const nb::object array = nb::cast(pixels_of(image));
            if (dtype.is_none() && copy.ptr() != Py_True) return array;
            return nb::module_::import_("numpy").attr("array")(array, dtype);
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none())
      .def(
          "tone_mapped",
          [](const Image& image, const std::string& curve, double exposure, double white_balance) {
            const Unlocked unlocked;
            return image.tone_mapped({curve, exposure, white_balance});
          },
          nb::arg("curve") = "none", nb::arg("exposure") = 0.0, nb::arg("white_balance") = 0.0)
      .def_static(
          "load", [](const std::filesystem::path& file) { return Image::load(file); }, nb::arg("file"),
          WithoutLock())
      .def(
          "save", [](const Image& image, const std::filesystem::path& file) { image.save(file); },
          nb::arg("file"), WithoutLock(), "Writes .png .jpg .exr .hdr or .pfm.")
      .def("__getstate__", &pixels_of)
      .def("__setstate__",
           [](Image& image, const PixelsIn& pixels) {
             new (&image) Image(pixels.size() > 0 ? image_of(pixels) : Image());
           })
      .def("_repr_png_", &png_of);
  nb::class_<Film>(m, "Film", "A finished or stopped render.")
      .def_prop_ro("width", &Film::width)
      .def_prop_ro("height", &Film::height)
      .def_prop_ro("complete", &Film::complete, "False: stopped, or out of time.")
      .def_prop_ro("image", &Film::image, "Linear RGBA; alpha is coverage.")
      .def_prop_ro(
          "shown",
          [](const Film& film) {
            const Unlocked unlocked;
            return film.shown();
          },
          "The image after the scene's tone map.")
      .def("aov", &Film::aov, nb::arg("name"))
      .def_prop_ro("aovs", &Film::aovs)
      .def_prop_ro(
          "figures", [](const Film& film) { return dict_of(film.figures()); }, "Rays, seconds, devices.")
      .def_prop_ro("warnings", [](const Film& film) { return texts_of(film.warnings()); })
      .def(
          "save", [](const Film& film, const std::filesystem::path& file) { film.save(file); },
          nb::arg("file"), WithoutLock(), "As `sundog render -o` does.")
      .def("_repr_png_", [](const Film& film) { return png_of(film.shown()); });
}

void add_scene(nb::module_& m) {
  nb::class_<OwnScene>(m, "Scene",
                       "A JSON document (docs/reference/scene-reference.md), with meshes from memory.")
      .def(
          "__init__",
          [](OwnScene* self, nb::handle source) {
            if (source.is_none())
              new (self) OwnScene();
            else
              new (self) OwnScene(scene_of(source));
          },
          nb::arg("source").none() = nb::none(), "Of a dict, a file or another Scene; empty without.")
      .def_static(
          "load",
          [](const std::filesystem::path& file, std::optional<double> frame, bool native_code,
             bool outside_files, std::array<int, 2> size) {
            return load_scene(
                file,
                {.frame = frame, .native_code = native_code, .outside_files = outside_files, .size = size});
          },
          nb::arg("file"), nb::arg("frame") = nb::none(), nb::arg("native_code") = false,
          nb::arg("outside_files") = false, nb::arg("size") = std::array{0, 0},
          "A scene or model file; `size` is the picture's (width, height), which a model's camera fits.")
      .def("to_dict", [](const OwnScene& scene) { return value_of(scene.to_json()); })
      .def(
          "__getitem__", [](const OwnScene& scene, const std::string& at) { return value_of(scene.get(at)); },
          "The value at a JSON pointer: scene[\"/camera/fov\"].")
      .def(
          "__setitem__",
          [](OwnScene& scene, const std::string& at, nb::handle value) {
            scene.set(at, json_of(value)), ++scene.edits;
          },
          nb::arg("at"), nb::arg("value").none())
      .def("__delitem__", [](OwnScene& scene, const std::string& at) { scene.remove(at), ++scene.edits; })
      .def("__contains__", [](const OwnScene& scene, std::string_view at) { return scene.contains(at); })
      .def("__copy__", [](const OwnScene& scene) { return OwnScene(scene); })
      .def("__deepcopy__", [](const OwnScene& scene, nb::handle) { return OwnScene(scene); })
      .def("copy", [](const OwnScene& scene) { return OwnScene(scene); })
      .def("__getstate__", &state_of)
      .def("__setstate__",
           [](OwnScene& scene, const nb::tuple& state) { new (&scene) OwnScene(scene_of_state(state)); })
      .def("add_mesh", &add_mesh, nb::arg("name"), nb::arg("positions"), nb::arg("triangles"),
           nb::arg("normals") = nb::none(), nb::arg("uvs") = nb::none(), nb::arg("colors") = nb::none(),
           nb::sig("def add_mesh(self, name: str, positions: " ANY_NUMBERS ", triangles: " ANY_NUMBERS
                   ", normals: " ANY_NUMBERS " | None = None, uvs: " ANY_NUMBERS
                   " | None = None, colors: " ANY_NUMBERS " | None = None) -> None"),
           "A mesh of arrays (n, 3), indices (m, 3), for objects {\"type\": \"mesh\", \"mesh\": name}. "
           "Arrays of float32 and uint32 in C order are held, not copied: leave them as they are.")
      .def(
          "add",
          [](OwnScene& scene, nb::handle object) { scene.set("/objects/-", json_of(object)), ++scene.edits; },
          nb::arg("object"), "Appends a dict to the objects.")
      .def(
          "check",
          [](nb::handle self) {
            const SceneInUse used(self);
            const std::vector<std::string> warnings = [&] {
              const Unlocked unlocked;
              return used.scene().check();
            }();
            return texts_of(warnings);
          },
          "Reads the whole scene; returns warnings, raises Error.");
}

void add_session(nb::module_& m) {
  nb::class_<Snapshot>(m, "Snapshot", "A session at one moment.")
      .def_ro("generation", &Snapshot::generation)
      .def_ro("shown", &Snapshot::shown)
      .def_ro("revision", &Snapshot::revision)
      .def_prop_ro("state", [](const Snapshot& now) { return states[static_cast<int>(now.state)]; })
      .def_ro("error", &Snapshot::error)
      .def_ro("fraction", &Snapshot::fraction)
      .def_ro("samples", &Snapshot::samples)
      .def_ro("block", &Snapshot::block)
      .def_ro("seconds", &Snapshot::seconds)
      .def_ro("image", &Snapshot::picture);
  nb::class_<Pick>(m, "Pick", "What a pixel's centre shows.")
      .def_ro("object", &Pick::object)
      .def_ro("material", &Pick::material)
      .def_ro("position", &Pick::position)
      .def_ro("normal", &Pick::normal)
      .def_ro("depth", &Pick::depth);
  nb::class_<OpenSession>(m, "Session", "Devices that stay open and draw one scene after the other.")
      .def(
          "__init__",
          [](OpenSession* self, nb::handle devices) { new (self) OpenSession(devices_of(devices)); },
          nb::arg("devices").none() = nb::none())
      .def(
          "start",
          [](OpenSession& session, nb::handle scene, bool coarse, double patience) {
            const SceneInUse used(scene);
            const Unlocked unlocked;
            return session.start(used.scene(), {.coarse = coarse, .patience = patience});
          },
          nb::arg("scene"), nb::arg("coarse") = true, nb::arg("patience") = 0.15,
          "Draws this scene from now on.")
      .def(
          "cancel", [](OpenSession& session) { session.cancel(); }, WithoutLock())
      .def(
          "use_devices",
          [](OpenSession& session, nb::handle devices) {
            const std::vector<Device> chosen = devices_of(devices);
            const Unlocked unlocked;
            session.use_devices(chosen);
          },
          nb::arg("devices").none())
      .def(
          "snapshot", [](const OpenSession& session, bool picture) { return session.snapshot(picture); },
          nb::arg("picture") = true, WithoutLock())
      .def(
          "wait",
          [](const OpenSession& session, double seconds) {
            return waited([&](double slice) { return session.wait_for(slice); }, seconds);
          },
          nb::arg("seconds") = 1e9,
          "Waits until the picture is settled, stopped or failed (snapshot().state); False: not within that "
          "time.")
      .def(
          "wait_for_change",
          [](const OpenSession& session, std::uint64_t revision, double seconds) {
            return waited([&](double slice) { return session.wait_for_change(revision, slice); }, seconds);
          },
          nb::arg("revision"), nb::arg("seconds"),
          "Waits until snapshot().revision is another one; False: not within that time.")
      .def(
          "finish",
          [](const OpenSession& session) {
            waited([&](double slice) { return session.wait_for(slice); }, 1e9);
            const Unlocked unlocked;
            return session.finish();
          },
          "wait(), then the picture.")
      .def(
          "pick",
          [](OpenSession& session, int x, int y) {
            return interruptible([&] { return session.pick(x, y); }, [&] { session.cancel(); });
          },
          nb::arg("x"), nb::arg("y"),
          "Casts one ray; the first may build a kernel. Ctrl-C stops the drawing too.");
}

}  // namespace

NB_MODULE(_sundog, m) {
  m.doc() = "The module behind the package sundog.";
  add_error(m);
  add_images(m);
  add_scene(m);
  add_session(m);
  m.def("version", &version);
  m.def(
      "threads_left_behind", [](nb::handle) { return threads_left_behind(); },
      nb::arg("devices").none() = nb::none(),
      "How many threads drivers have not let go of; the process waits for them at its exit, whichever the "
      "devices.");
  m.def("wait_for_threads", &wait_for_threads, WithoutLock(), "Waits for these threads, up to a minute.");
  m.def(
      "_end",
      [process = ::getpid()] {
        ending = std::this_thread::get_id();
        for (int i = 0; calls > 0 && ::getpid() == process && i < 6000; ++i)
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        wait_for_threads();
      },
      nb::call_guard<nb::gil_scoped_release>(), "The interpreter calls it at its end.");
  m.def("render", &render_scene, nb::arg("scene"), nb::arg("devices").none() = nb::none(),
        nb::arg("aovs") = std::vector<std::string>(), nb::arg("work_group") = nb::none(), nb::arg("tile") = 0,
        nb::arg("time_limit") = 0.0, nb::arg("on_progress").none() = nb::none(),
        nb::arg("on_picture").none() = nb::none(), nb::arg("picture_seconds") = 1.0,
        "Renders a Scene, a file or a dict, and waits; other threads continue. on_progress(pixels, of, "
        "seconds) may return False to stop; Ctrl-C stops too and raises KeyboardInterrupt.");
}
