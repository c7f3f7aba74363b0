// Samples of images against double precision.
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "compile/surfaces/textures.h"
#include "devices.h"
#include "scenes.h"
#include "smaller_levels.h"
#include "surface_testing.h"

using namespace sundog;
using glm::dvec4;

namespace {

/// An image of any kind with pixels that differ.
ImageDescription noise(int width, int height, int channels, StoredImage::Sample sample, bool srgb) {
  ImageDescription image;
  image.srgb = srgb;
  image.pixels.width = width;
  image.pixels.height = height;
  image.pixels.channels = channels;
  image.pixels.sample = sample;
  image.pixels.data.resize(image.pixels.pixel_count() * image.pixels.pixel_bytes());
  u32 state = 1;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 16; };
  for (std::size_t i = 0; i < image.pixels.data.size(); ++i)
    if (sample != StoredImage::Sample::half) image.pixels.data[i] = static_cast<std::uint8_t>(next());
  if (sample == StoredImage::Sample::half)
    for (std::size_t i = 0; i + 1 < image.pixels.data.size(); i += 2) {
      const std::uint16_t bits = half_from_float(static_cast<float>(next()) / 8192);
      std::memcpy(image.pixels.data.data() + i, &bits, 2);
    }
  return image;
}

/// A scene whose only material has the texture as its diffuse colour, on a plane.
SceneDescription textured_plane(const ImageDescription& image, TextureDescription texture) {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  texture.kind = TEXTURE_IMAGE;
  texture.image = 0;
  scene.images.push_back(image);
  scene.textures.push_back(texture);
  const int material = scenes::add_white(scene);
  scene.materials[static_cast<std::size_t>(material)].textures.diffuse = 0;
  scenes::place(scene, PlaneShape{}, material);
  return scene;
}

// --- the reference ---

struct Levels {
  std::vector<StoredImage> all;
  bool srgb;
  dvec4 texel(std::size_t level, int x, int y) const {
    const StoredImage& image = all[level];
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
    dvec4 value(1);
    for (std::size_t c = 0; c < static_cast<std::size_t>(image.channels); ++c) {
      const std::size_t i = at * static_cast<std::size_t>(image.channels) + c;
      std::uint16_t word = 0;
      if (image.sample != StoredImage::Sample::byte) std::memcpy(&word, image.data.data() + 2 * i, 2);
      const double linear = image.sample == StoredImage::Sample::byte   ? image.data[i] / 255.0
                            : image.sample == StoredImage::Sample::word ? word / 65535.0
                                                                        : double(float_from_half(word));
      const bool encoded = srgb && c < 3 && image.sample == StoredImage::Sample::byte;
      value[static_cast<int>(c)] = !encoded            ? linear
                                   : linear <= 0.04045 ? linear / 12.92
                                                       : std::pow((linear + 0.055) / 1.055, 2.4);
    }
    if (image.channels == 1) value = dvec4(value.x, value.x, value.x, 1);
    return value;
  }
};

int wrapped(int i, int n, Wrap mode) {
  if (mode == Wrap::clamp) return std::clamp(i, 0, n - 1);
  if (mode == Wrap::repeat) return ((i % n) + n) % n;
  const int k = ((i % (2 * n)) + 2 * n) % (2 * n);
  return k < n ? k : 2 * n - 1 - k;
}

dvec4 sample_one(const Levels& levels, std::size_t level, const TextureDescription& texture, double u,
                 double v) {
  const StoredImage& image = levels.all[level];
  const auto at = [&](int x, int y) {
    return levels.texel(level, wrapped(x, image.width, texture.wrap[0]),
                        wrapped(y, image.height, texture.wrap[1]));
  };
  const bool nearest = texture.filter == TextureFilter::nearest;
  const double x = u * image.width - (nearest ? 0 : 0.5), y = (1 - v) * image.height - (nearest ? 0 : 0.5);
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  if (nearest) return at(x0, y0);
  const double s = x - x0, t = y - y0;
  return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), s), glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), s),
                  t);
}

dvec4 sample(const Levels& levels, const TextureDescription& texture, double u, double v, double footprint) {
  const double last = static_cast<double>(levels.all.size() - 1);
  const double level = footprint > 1 ? std::min(std::log2(footprint), last) : 0;
  if (texture.filter != TextureFilter::trilinear)
    return sample_one(levels, static_cast<std::size_t>(level + 0.5), texture, u, v);
  const auto low = static_cast<std::size_t>(level);
  const dvec4 fine = sample_one(levels, low, texture, u, v);
  if (level == double(low)) return fine;
  return glm::mix(fine, sample_one(levels, low + 1, texture, u, v), level - double(low));
}

// --- the device ---

/// Texture 0 at points (u, v, footprint in the world's units, where u is x and v is -z).
std::vector<float4> sample_on(const DeviceInfo& info, const CompiledScene& flat,
                              const std::vector<float4>& points) {
  std::vector<surfaces::Point> at(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) at[i].p = {points[i].x, 0, -points[i].y, points[i].z};
  std::vector<float4> values;
  for (const surfaces::Shaded& shaded : surfaces::shade(info, surfaces::Part::value, flat, at))
    values.push_back(shaded.value);
  return values;
}

/// All over the image and beyond its edges, at footprints of 0 to 40 texels.
std::vector<float4> sample_points(const StoredImage& image) {
  std::vector<float4> points;
  const double size = std::sqrt(double(image.width) * image.height);
  for (int i = 0; i < 200; ++i) {
    const double u = 2.3 * std::fmod(i * 0.618034, 1) - 0.7, v = 3.1 * std::fmod(i * 0.414214, 1) - 1.2;
    const double texels = i % 3 == 0 ? 0 : 40.0 * (i % 17) / 17;
    points.push_back({float(u), float(v), float(texels / size), 0});
  }
  return points;
}

double greatest_difference(const float4& a, const dvec4& b) {
  return std::max({std::abs(double(a.x) - b.x), std::abs(double(a.y) - b.y), std::abs(double(a.z) - b.z),
                   std::abs(double(a.w) - b.w)});
}

/// Splits the scene's texels into pages of at least `least` units each.
void cut_into_pages(u32 least, CompiledScene& flat) {
  const SharedTable<u32> texels = flat.texels0;
  const std::size_t bytes = texels.size() * sizeof(u32);
  TexelTables made = make_texel_tables(bytes / TEXEL_UNIT, least);
  const TexelPages pages = made.pages;
  flat.info.texel_page = static_cast<u32>(pages.units);
  flat.features.texel_pages = made.several;
  flat.texels0 = made.tables[0], flat.texels1 = made.tables[1];
  flat.texels2 = made.tables[2], flat.texels3 = made.tables[3];
  REQUIRE_FALSE(flat.texels1.empty());
  const std::size_t page = pages.units * TEXEL_UNIT;
  for (std::size_t i = 0; i * page < bytes; ++i)
    std::memcpy(pages.bytes[i], reinterpret_cast<const std::uint8_t*>(texels.data()) + i * page,
                std::min(page, bytes - i * page));
}

void check_samples(const DeviceInfo& device, const ImageDescription& image, const TextureDescription& texture,
                   u32 page = 0) {
  CompiledScene flat = compile(textured_plane(image, texture));
  if (page) cut_into_pages(page, flat);
  Levels levels{{image.pixels}, image.srgb};
  for (StoredImage& level : smaller_levels(image.pixels, image.srgb ? SampleUse::color : SampleUse::data))
    levels.all.push_back(std::move(level));
  const std::vector<float4> points = sample_points(image.pixels);
  const std::vector<float4> found = sample_on(device, flat, points);
  const double size = std::sqrt(double(image.pixels.width) * image.pixels.height);
  const double bound = image.pixels.sample == StoredImage::Sample::half ? 1e-3 : 1e-4;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dvec4 wanted =
        sample(levels, texture, double(points[i].x), double(points[i].y), double(points[i].z) * size);
    // A nearest texel, or level, may be the other one where rounding decides.
    const bool decided = texture.filter == TextureFilter::trilinear || points[i].z == 0;
    INFO(points[i].x << " " << points[i].y << " " << points[i].z);
    if (decided) REQUIRE(greatest_difference(found[i], wanted) < bound);
  }
}

}  // namespace

TEST_CASE("samples of every kind of image are those in double precision") {
  using Sample = StoredImage::Sample;
  on_every_device([&](const DeviceInfo& info) {
    for (const Sample kind : {Sample::byte, Sample::word, Sample::half})
      for (const int channels : {1, 4}) {
        INFO(static_cast<int>(kind) << " with " << channels << " channels");
        check_samples(info, noise(13, 7, channels, kind, false), {});
      }
    check_samples(info, noise(16, 16, 4, Sample::byte, true), {});
    check_samples(info, noise(1, 1, 4, Sample::byte, true), {});
    check_samples(info, noise(1, 33, 1, Sample::byte, true), {});
  });
}

TEST_CASE("samples beyond an image's edges repeat, mirror or clamp it, by axis") {
  on_every_device([&](const DeviceInfo& info) {
    const ImageDescription image = noise(9, 6, 4, StoredImage::Sample::byte, false);
    for (const Wrap u : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
      for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::trilinear}) {
        TextureDescription texture;
        texture.wrap[0] = u;
        texture.wrap[1] = u == Wrap::clamp ? Wrap::mirror : Wrap::clamp;
        texture.filter = filter;
        check_samples(info, image, texture);
      }
  });
}

TEST_CASE("images cut into pages give the same samples") {
  on_every_device([&](const DeviceInfo& info) {
    check_samples(info, noise(40, 30, 4, StoredImage::Sample::byte, true), {}, TEXEL_ALIGNMENT);
    check_samples(info, noise(20, 30, 4, StoredImage::Sample::word, false), {}, TEXEL_ALIGNMENT);
  });
}

TEST_CASE("a checkerboard far away is its mean") {
  ImageDescription image;
  image.pixels.width = image.pixels.height = 64;
  image.pixels.channels = 1;
  for (int i = 0; i < 64 * 64; ++i) image.pixels.data.push_back((i / 64 + i) % 2 ? 255 : 0);
  const CompiledScene flat = compile(textured_plane(image, {}));
  on_every_device([&](const DeviceInfo& info) {
    for (const float4& value : sample_on(info, flat, {{0.3f, 0.1f, 70, 0}, {0.77f, 0.2f, 3, 0}}))
      CHECK(double(value.x) == Approx(0.5).epsilon(1e-2));
    CHECK(sample_on(info, flat, {{20.5f / 64, 1 - 11.5f / 64, 0, 0}}).front().x == Approx(1).margin(2e-3));
  });
}
