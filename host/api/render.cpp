// render(): compiles a Scene, opens the devices, renders, and converts options and results.

#include <algorithm>
#include <atomic>
#include <exception>

#include "api/impl.h"
#include "base/clock.h"
#include "base/file.h"
#include "render/film/group_names.h"
#include "scene/shot.h"

namespace sundog {
inline namespace v0 {
namespace {

/// Calls the program's callbacks until close(): a thread left in a driver may return after render() has. An
/// exception of a callback stops the render and is rethrown by close().
class Callbacks : public std::enable_shared_from_this<Callbacks> {
 public:
  explicit Callbacks(const RenderOptions& options)
      : progress_(options.on_progress), picture_(options.on_picture) {}

  void install(core::RenderOptions& to) {
    to.stop = &stop_;
    if (progress_)
      to.on_progress = [self = shared_from_this()](const RenderProgress& now) {
        self->call([&] { self->progress_({now.pixels_done, now.pixels_total, now.seconds}); });
      };
    if (picture_)
      to.on_picture = [self = shared_from_this()](const core::Film& film) {
        self->call([&] { self->picture_(share(film.develop())); });
      };
  }
  void stop() noexcept { stop_ = true; }
  /// Ends all calls. Rethrows a callback's exception.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  }

 private:
  template <class F>
  void call(const F& f) {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    try {
      f();
    } catch (...) {
      thrown_ = std::current_exception();
      closed_ = true;
      stop_ = true;
    }
  }

  std::function<void(const Progress&)> progress_;
  std::function<void(const Image&)> picture_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  bool closed_ = false;
  std::exception_ptr thrown_;
};

DeviceFigures figures_of(const sundog::DeviceReport& report) {
  DeviceFigures figures;
  figures.label = report.info.label();
  figures.tiles = report.tiles;
  figures.pixels = report.pixels;
  figures.share = report.share;
  figures.busy_seconds = report.busy_seconds;
  for (const auto& [name, times] : report.kernels)
    figures.kernel_ms += times.device_ms > 0 ? times.device_ms : times.host_ms;
  figures.retired = report.retired;
  figures.messages = report.messages;
  figures.messages.insert(figures.messages.end(), report.notes.begin(), report.notes.end());
  return figures;
}

Figures figures_of(const RenderResult& result, double compile_seconds) {
  Figures figures;
  figures.primary = result.counts[COUNT_PRIMARY];
  figures.reflection = result.counts[COUNT_REFLECTION];
  figures.refraction = result.counts[COUNT_REFRACTION];
  figures.shadow = result.counts[COUNT_SHADOW];
  figures.march_steps = result.counts[COUNT_MARCH_STEPS];
  figures.dropped_samples = result.counts[COUNT_NON_FINITE];
  figures.compile_seconds = compile_seconds;
  figures.build_seconds = result.times.build_kernels;
  figures.render_seconds = result.times.render;
  figures.cached = result.times.cached;
  figures.efficiency = result.efficiency;
  for (const auto& report : result.devices) figures.devices.push_back(figures_of(report));
  return figures;
}

std::shared_ptr<Film::Impl> render_host(const Scene& scene, const RenderOptions& options,
                                        Callbacks& callbacks) {
  for (const std::string& name : options.aovs) check_aov(name);
  auto film = std::make_shared<Film::Impl>();
  const auto description = scene.impl().describe();
  const Stopwatch clock;
  const auto flat = std::make_shared<const CompiledScene>(compile(*description));
  const double compile_seconds = clock.seconds();
  sundog::check_frame_memory(
      static_cast<int>(flat->info.width), static_cast<int>(flat->info.height),
      {.file = {}, .aovs = options.aovs, .tile = options.tile, .passes = sundog::in_passes(flat->sampling)});
  const std::vector<DeviceInfo> devices = devices_of(options.devices);
  film->warnings = description->warnings;
  for (std::string& warning : sundog::view_warnings(*description, *flat, devices))
    film->warnings.push_back(std::move(warning));
  core::RenderOptions wanted;
  wanted.work_group = group_of(options.work_group);
  wanted.tile = tile_of(options.tile);
  wanted.aovs = options.aovs;
  wanted.time_limit = seconds_of("the time limit", options.time_limit);
  wanted.picture_seconds = seconds_of("the time between pictures", options.picture_seconds);
  wanted.tuning = [flat](const DeviceInfo& device) { return sundog::saved_tuning(device, *flat); };
  callbacks.install(wanted);
  film->result = core::render(flat, devices, wanted);
  wait_for_threads_at_exit();
  film->tone_map = description->image.tone_map;
  film->transparent = description->image.transparent;
  film->shot = sundog::shot_of(*description);
  film->shot.next = sundog::next_shot(*description, nullptr);
  sundog::find_motion(film->result.aovs, film->shot);
  film->figures = figures_of(film->result, compile_seconds);
  film->image = share(std::move(film->result.image));
  film->result.film = {};
  film->texts = sundog::name_cryptomattes(
      film->result.aovs, {sundog::names_of(description->objects), sundog::names_of(description->materials)});
  for (auto& [name, image] : film->result.aovs) film->aovs.emplace(name, share(std::move(image)));
  return film;
}

core::Image without_coverage(const core::Image& image) {
  core::Image colors(image.width, image.height, 3);
  for (std::size_t i = 0; i < colors.data.size(); ++i) colors.data[i] = image.data[i / 3 * 4 + i % 3];
  return colors;
}

}  // namespace

Film render(const Scene& scene, const RenderOptions& options) {
  const auto callbacks = std::make_shared<Callbacks>(options);
  const std::stop_callback asked(options.stop, [&] { callbacks->stop(); });
  std::shared_ptr<Film::Impl> film;
  try {
    film = translated([&] { return render_host(scene, options, *callbacks); });
  } catch (...) {
    callbacks->close();  // a callback's exception takes precedence
    throw;
  }
  callbacks->close();
  return Film(std::move(film));
}

Film::Film() : impl_(std::make_shared<const Impl>()) {}
Film::Film(std::shared_ptr<const Impl> impl) noexcept : impl_(std::move(impl)) {}

int Film::width() const noexcept { return impl_->image.width(); }
int Film::height() const noexcept { return impl_->image.height(); }
bool Film::complete() const noexcept { return impl_->result.complete && width() > 0; }
Image Film::image() const { return impl_->image; }
const Figures& Film::figures() const noexcept { return impl_->figures; }
const std::vector<std::string>& Film::warnings() const noexcept { return impl_->warnings; }

Image Film::shown() const {
  core::Image shown = *impl_->image.impl()->image;
  apply(impl_->tone_map, shown);
  return share(std::move(shown));
}

Image Film::aov(const std::string& name) const {
  const auto found = impl_->aovs.find(name);
  if (found == impl_->aovs.end())
    throw Error(ErrorKind::usage, "the film has no AOV \"" + name + "\"; name it in RenderOptions::aovs");
  return found->second;
}

std::vector<std::string> Film::aovs() const {
  std::vector<std::string> names;
  for (const auto& [name, image] : impl_->aovs) names.push_back(name);
  return names;
}

void Film::save(const std::filesystem::path& file) const {
  translated([&] {
    if (width() < 1) throw UsageError("the film has no pixels to save");
    const bool all = lower_extension(file) == ".exr";
    AovImages aovs;
    if (all)
      for (const auto& [name, image] : impl_->aovs) aovs.emplace(name, *image.impl()->image);
    const core::Image& image = *impl_->image.impl()->image;
    if (all)
      return sundog::write_file(
          file, encode_image(image, file, aovs, {.texts = impl_->texts, .shot = impl_->shot}));
    core::Image colors =
        impl_->transparent && sundog::is_png(file) ? core::Image(image) : without_coverage(image);
    write_image(sundog::shown_in(file, std::move(colors), impl_->tone_map), file);
  });
}

}  // namespace v0
}  // namespace sundog
