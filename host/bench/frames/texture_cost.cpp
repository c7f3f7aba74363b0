// See texture_cost.h.
#include "bench/frames/texture_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/clock.h"
#include "base/pixels/stored_image.h"
#include "bench/frames/frame_runner.h"
#include "compile/compiled_scene.h"
#include "scene/decode_images.h"
#include "scene/materials/by_integrator.h"

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

/// Both frames, ready to be rendered again and again.
struct Pair {
  CompiledScene textured, plain;
  FrameRunner textured_frames, plain_frames;

  Pair(const SceneDescription& scene, const DeviceInfo& device)
      : textured(compile(scene)),
        plain(compile(without_textures(scene))),
        textured_frames(device, textured),
        plain_frames(device, plain) {}
};

double kernel_seconds(FrameRunner& frames) {
  frames.run();
  double sum = 0;
  for (const auto& [name, times] : frames.kernel_times()) sum += frames.kernel_seconds(name);
  return sum;
}

double rays_of(const FrameRunner& frames) {
  double rays = 0;
  for (const int kind : {COUNT_PRIMARY, COUNT_REFLECTION, COUNT_REFRACTION, COUNT_SHADOW})
    rays += static_cast<double>(frames.counts()[static_cast<std::size_t>(kind)]);
  return rays;
}

}  // namespace

SceneDescription without_textures(SceneDescription scene) {
  for (MaterialDescription& each : scene.materials)
    change_all(each, [](MaterialDescription& material) {
      material.textures = {};
      material.metal_rough.reset();
      material.cutoff = 0;
      material.parallax = 0;
    });
  scene.textures.clear();
  scene.images.clear();
  return scene;
}

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

TextureCost measure_texture_cost(const SceneDescription& scene, const DeviceInfo& device, int repeat,
                                 const std::function<void(const std::string&)>& on_step) {
  on_step("compiling");
  Pair pair(scene, device);
  kernel_seconds(pair.textured_frames);
  kernel_seconds(pair.plain_frames);
  TextureCost cost;
  std::vector<double> textured, plain, ratios;
  for (int i = 0; i < repeat; ++i) {
    on_step(fmt::format("run {} of {}", i + 1, repeat));
    plain.push_back(kernel_seconds(pair.plain_frames));
    textured.push_back(kernel_seconds(pair.textured_frames));
    ratios.push_back(textured.back() / plain.back());
  }
  const Spread ratio = spread(ratios);
  cost.textured = spread(textured);
  cost.plain = spread(plain);
  cost.ratio = ratio.median;
  cost.ratio_low = ratio.min;
  cost.ratio_high = ratio.max;
  cost.rays_textured = rays_of(pair.textured_frames);
  cost.rays_plain = rays_of(pair.plain_frames);
  return cost;
}

ImageCost measure_image_cost(int edge, int repeat, const std::function<void(const std::string&)>& on_step) {
  on_step(fmt::format("making eight images of {} texels a side", edge));
  SceneDescription made = eight_textures(edge);
  std::vector<std::string> files;
  for (ImageDescription& image : made.images) {
    add_grain(image.pixels, static_cast<unsigned>(files.size()));
    files.push_back(encode_png(image.pixels));
    image.pixels = {};
  }
  std::vector<double> decode, levels, both, processor;
  for (int i = 0; i < repeat; ++i) {
    on_step(fmt::format("loading images, run {} of {}", i + 1, repeat));
    SceneDescription scene = made;
    for (std::size_t k = 0; k < files.size(); ++k) scene.images[k].encoded = files[k];
    const double before = processor_seconds();
    Stopwatch clock;
    decode_images(scene);
    decode.push_back(clock.seconds());
    clock = {};
    compile(scene);
    levels.push_back(clock.seconds());
    both.push_back(decode.back() + levels.back());
    processor.push_back(processor_seconds() - before);
  }
  return {spread(decode), spread(levels), spread(both), spread(processor)};
}

void add_texture_rows(Report& report, const std::string& scene, const DeviceInfo& device,
                      const TextureCost& cost) {
  if (report.measurements.columns.empty())
    report.measurements.columns = {{"scene", ""},
                                   {"device", ""},
                                   {"without", "ms"},
                                   {"textured", "ms"},
                                   {"ratio", ""},
                                   {"ratio low", ""},
                                   {"ratio high", ""},
                                   {"rays without", ""},
                                   {"rays textured", ""},
                                   {"decoding", "ms"},
                                   {"levels", "ms"},
                                   {"loading", "ms"},
                                   {"loading on processors", "ms"}};
  const std::string label = device.label();
  report.measurements.rows.push_back({scene, label.substr(0, label.find(' ')), scaled(cost.plain, 1e3),
                                      scaled(cost.textured, 1e3), cost.ratio, cost.ratio_low, cost.ratio_high,
                                      cost.rays_plain, cost.rays_textured, Cell(), Cell(), Cell(), Cell()});
}

void add_image_rows(Report& report, int edge, const ImageCost& cost) {
  std::vector<Cell> row(report.measurements.columns.size());
  row[0] = fmt::format("eight PNG, {0}x{0}", edge);
  row[row.size() - 4] = scaled(cost.decode, 1e3);
  row[row.size() - 3] = scaled(cost.levels, 1e3);
  row[row.size() - 2] = scaled(cost.both, 1e3);
  row[row.size() - 1] = scaled(cost.processor, 1e3);
  report.measurements.rows.push_back(std::move(row));
}

}  // namespace sundog
