// `sundog bench textures`: a frame with textures and without, and the time that images take to load.
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "app/options/option_helpers.h"
#include "base/clock.h"
#include "base/pixels/stored_image.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"
#include "render/film/hash.h"
#include "scene/decode_images.h"
#include "scene/description.h"

namespace sundog {
namespace {

/// Colours that change over several sizes, as pictures of surfaces do: bilinear noise in octaves.
StoredImage made_image(int edge, unsigned seed) {
  StoredImage image;
  image.width = image.height = edge;
  image.channels = 4;
  const auto size = static_cast<std::size_t>(edge);
  std::vector<float> sums(size * size * 3, 0.0f);
  std::mt19937 random(seed);
  float strength = 0.5f;
  for (std::size_t cells = 4; cells <= 256 && cells <= size; cells *= 2, strength *= 0.6f) {
    std::vector<float> lattice((cells + 1) * (cells + 1) * 3);
    for (float& value : lattice) value = static_cast<float>(random() & 0xFFFFu) / 65535.0f;
    for (std::size_t y = 0; y < size; ++y)
      for (std::size_t x = 0; x < size; ++x) {
        const std::size_t cx = x * cells / size, cy = y * cells / size;
        const float s = static_cast<float>(x * cells % size) / static_cast<float>(size),
                    t = static_cast<float>(y * cells % size) / static_cast<float>(size);
        for (std::size_t c = 0; c < 3; ++c) {
          const auto at = [&](std::size_t i, std::size_t j) {
            return lattice[((cy + j) * (cells + 1) + cx + i) * 3 + c];
          };
          const float up = at(0, 0) + s * (at(1, 0) - at(0, 0)), down = at(0, 1) + s * (at(1, 1) - at(0, 1));
          sums[(y * size + x) * 3 + c] += strength * (up + t * (down - up));
        }
      }
  }
  image.data.resize(size * size * 4, 255);
  for (std::size_t i = 0; i < size * size; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      image.data[4 * i + c] = static_cast<std::uint8_t>(255 * std::clamp(sums[3 * i + c], 0.0f, 1.0f));
  return image;
}

/// Noise as a camera's sensor has it, more for each further image up to the fourth: what PNG cannot pack.
void add_grain(StoredImage& image, unsigned index) {
  std::mt19937 random(index + 1);
  const unsigned most = index % 4 * 2;
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % 4 != 3)
      image.data[i] = static_cast<std::uint8_t>(std::clamp(
          image.data[i] + static_cast<int>(random() % (2u * most + 1u)) - static_cast<int>(most), 0, 255));
}

/// Material `index` with a texture of its own.
void add_textured_material(SceneDescription& scene, int edge, int index) {
  ImageDescription image;
  image.name = fmt::format("made {}", index);
  image.pixels = made_image(edge, static_cast<unsigned>(index) + 1);
  image.file_width = image.file_height = edge;
  scene.images.push_back(std::move(image));
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = index;
  scene.textures.push_back(texture);
  MaterialDescription material;
  material.textures.ambient = material.textures.diffuse = index;
  if (index % 4 == 2) material.reflection = dvec3(0.3);
  scene.materials.push_back(material);
}

/// The scene with the numbers and colours of its materials alone.
SceneDescription without_textures(SceneDescription scene) {
  for (MaterialDescription& material : scene.materials) {
    material.textures = {};
    material.metal_rough.reset();
    material.cutoff = 0;
    material.parallax = 0;
  }
  scene.textures.clear();
  scene.images.clear();
  return scene;
}

/// Eight solids on a floor, each with a colour image of its own, `edge` texels a side, trilinear; two lights,
/// two mirrors. The images are made here.
SceneDescription eight_textures(int edge) {
  SceneDescription scene;
  scene.camera.position = {0, 3, 9};
  scene.camera.target = {0, 0.8, 0};
  scene.image.background_bottom = {0.6, 0.7, 0.8};
  scene.image.background_top = {0.2, 0.3, 0.5};
  scene.render.max_depth = 4;
  scene.render.samples = 4;
  scene.media.push_back({"world", 1, dvec3(0), world_priority});
  LightDescription ambient, sun, lamp;
  ambient.type = LightType::ambient;
  sun.type = LightType::directional;
  sun.direction = {0.5, -1, -0.6};
  sun.intensity = 0.7;
  lamp.position = {-4, 6, 5};
  lamp.intensity = 0.5;
  scene.lights = {ambient, sun, lamp};
  const Shape shapes[8] = {PlaneShape{},
                           SphereShape{0.9},
                           BoxShape{dvec3(0.7)},
                           TorusShape{0.6, 0.3},
                           CylinderShape{0.6, 0.9},
                           SphereShape{0.8},
                           ConeShape{0.8, 0, 1},
                           RoundBoxShape{dvec3(0.7), 0.2}};
  for (int i = 0; i < 8; ++i) {
    add_textured_material(scene, edge, i);
    Object object;
    object.shape = shapes[i];
    object.material = i;
    if (i > 0)
      object.world_from_object = glm::translate(dmat4(1), dvec3(1.6 * (i - 4), 1, i % 2 ? 0.0 : -1.6));
    scene.objects.push_back(object);
  }
  return scene;
}

/// Frames with a scene's textures and without them, in turn, by the time of their kernels.
class TextureCost {
 public:
  TextureCost(std::string scene_name, const SceneDescription& scene, const DeviceInfo& device)
      : scene_(std::move(scene_name)), device_(device_place(device)) {
    const auto add = [&](const char* what, const SceneDescription& described) {
      const auto flat = std::make_shared<const CompiledScene>(compile(described));
      const auto rays = rays_.emplace_back(std::make_shared<double>());
      const auto open = [=] {
        return std::make_shared<FrameRunner>(std::vector{frame_worker(device, flat)}, flat);
      };
      subjects_.push_back(frame_subject(fmt::format("{} on {}, {}", scene_, device_, what),
                                        {open, [rays](const FrameRunner& frames) { *rays = frames.rays(); },
                                         [](const FrameRunner& frames) { return frames.kernel_seconds(); }}));
    };
    add("without", without_textures(scene));
    add("textured", scene);
  }

  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  void add_to(Report& report) const {
    std::vector<Field> row{{"scene", "", scene_}, {"device", "", device_}};
    const char* names[] = {"without", "textured"};
    for (std::size_t i = 0; i < 2; ++i) {
      row.push_back({names[i], "ms", milliseconds(subjects_[i])});
      row.push_back({fmt::format("rays {}", names[i]), "", *rays_[i]});
      report.ways.push_back(subjects_[i]);
    }
    if (subjects_[0].is_good() && subjects_[1].is_good())
      row.push_back({"ratio", "", subjects_[1].seconds().median / subjects_[0].seconds().median});
    for (const Subject& subject : subjects_)
      if (!subject.problem.empty()) row.push_back({"problem", "", subject.problem});
    add_row(report.measurements, row);
  }

 private:
  std::string scene_, device_;
  std::vector<Subject> subjects_;              // without textures, with them
  std::vector<std::shared_ptr<double>> rays_;  // of a frame of each
};

/// Loading eight PNG files of `edge` texels a side, from their bytes to the tables of texels: decoding, and
/// the rest, which is smaller levels and tiles.
class ImageCost {
 public:
  explicit ImageCost(int edge) : edge_(edge), parts_(std::make_shared<Parts>()) {
    struct Made {
      SceneDescription scene;
      std::vector<std::string> files;
      std::uint64_t result = 0, expected = 0;
    };
    const auto made = std::make_shared<Made>();
    Subject& subject = subjects_.emplace_back();
    subject.name = fmt::format("eight PNG, {0}x{0}", edge_);
    subject.prepare = [made, edge] {
      made->scene = eight_textures(edge);
      for (ImageDescription& image : made->scene.images) {
        add_grain(image.pixels, static_cast<unsigned>(made->files.size()));
        made->files.push_back(encode_png(image.pixels));
        image.pixels = {};
      }
    };
    subject.run = [made, parts = parts_] {
      SceneDescription scene = made->scene;
      for (std::size_t k = 0; k < made->files.size(); ++k) scene.images[k].encoded = made->files[k];
      const double before = processor_seconds();
      const Stopwatch clock;
      decode_images(scene);
      const double decoded = clock.seconds();
      const CompiledScene compiled = compile(scene);
      const double seconds = clock.seconds();
      parts->decode.push_back(decoded);
      parts->levels.push_back(seconds - decoded);
      parts->processor.push_back(processor_seconds() - before);
      made->result = hash_scene(compiled);
      return seconds;
    };
    subject.check = [made]() -> std::string {
      if (made->expected == 0) made->expected = made->result;
      return made->result == made->expected ? "" : "its texels are not those of the first run";
    };
  }

  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  void add_to(Report& report) const {
    const Subject& subject = subjects_.front();
    std::vector<Field> row{{"scene", "", subject.name}};
    if (subject.is_good()) {
      const auto later = [&](const std::vector<double>& all) {
        return scaled(spread(subject.counted(all)), 1e3);
      };
      row.insert(row.end(), {{"decoding", "ms", later(parts_->decode)},
                             {"levels", "ms", later(parts_->levels)},
                             {"loading", "ms", milliseconds(subject)},
                             {"loading on processors", "ms", later(parts_->processor)}});
    }
    add_row(report.measurements, row, subject);
    report.ways.push_back(subject);
  }

 private:
  struct Parts {
    std::vector<double> decode, levels, processor;  // seconds of each run, the first one too
  };
  int edge_;
  std::shared_ptr<Parts> parts_;
  std::vector<Subject> subjects_;
};

struct TexturesOptions : BenchOptions {
  int edge = 1024;         // of the made scene's images
  int loaded_edge = 2048;  // of those that are loaded
};

int bench_textures(const TexturesOptions& options) {
  BenchRun run("textures", "What textures cost", options);
  run.head().notes.push_back(fmt::format(
      "Median of {} frames of each after one to warm up, in turn; times are those of the kernels, "
      "and the ratio is of the medians. Without textures the materials keep their colors and "
      "numbers. Levels: all that compiling the scene takes, mostly the smaller levels of the "
      "images. Loading: both. Every result was compared before its time counted.",
      options.repeat));
  const std::vector<DeviceInfo> devices = run.devices();
  const auto measure = [&](const std::string& name, const std::string& file, const SceneDescription& scene) {
    run.add_scene(name, file, compile(scene));
    for (const DeviceInfo& device : devices) run.measure(std::make_shared<TextureCost>(name, scene, device));
  };
  for (const std::string& file : options.scenes)
    measure(scene_name(file), file, bench_description(file, options));
  if (options.scenes.empty()) {
    measure(fmt::format("eight {0}x{0}", options.edge), "", sized(eight_textures(options.edge), options));
    run.measure(std::make_shared<ImageCost>(options.loaded_edge));
  }
  return run.publish();
}

}  // namespace

void add_bench_textures(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<TexturesOptions>();
  Arguments* app = add_bench_command(bench, chosen, "textures", "A frame with textures and without them",
                                     options, bench_textures, false);
  add_bench_size(app, *options);
  value(app, "--edge", "N", options->edge, "texels a side of the made scene's images (default 1024)")
      ->range(1, 8192);
  value(app, "--loaded-edge", "N", options->loaded_edge,
        "texels a side of the PNG files whose loading is timed (default 2048)")
      ->range(1, 8192);
}

}  // namespace sundog
