// Samples of images against double precision, and pictures of surfaces with textures whose values are known.
#include <base/pixels/image_levels.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "catch.h"
#include "compile/textures.h"
#include "devices.h"
#include "scenes.h"
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

void check_samples(const DeviceInfo& device, const ImageDescription& image, const TextureDescription& texture,
                   u32 page = 0) {
  CompiledScene flat = compile(textured_plane(image, texture));
  if (page) cut_into_pages(std::move(flat.texels0), page, flat);
  Levels levels{{image.pixels}, image.srgb};
  for (StoredImage& level : smaller_levels(image.pixels, image.srgb)) levels.all.push_back(std::move(level));
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

// --- pictures ---

namespace {

int add_image(SceneDescription& scene, int width, std::vector<std::uint8_t> data, int channels = 1) {
  ImageDescription image;
  image.srgb = false;
  image.pixels.width = width;
  image.pixels.channels = channels;
  image.pixels.height = static_cast<int>(data.size()) / width / channels;
  image.pixels.data = std::move(data);
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = static_cast<int>(scene.images.size());
  scene.images.push_back(image);
  scene.textures.push_back(texture);
  return texture.image;
}

/// A clamped image without filter.
int add_halves(SceneDescription& scene, std::uint8_t left, std::uint8_t right) {
  const int texture = add_image(scene, 2, {left, right});
  scene.textures.back().wrap[0] = scene.textures.back().wrap[1] = Wrap::clamp;
  scene.textures.back().filter = TextureFilter::nearest;
  return texture;
}

constexpr float leaf_at = 10, bent_at = 20, front_at = 30, wall_at = 40, back_at = 50;

void place_disk(SceneDescription& scene, const MaterialDescription& material, dvec3 at, double radius) {
  scene.materials.push_back(material);
  scenes::place(scene, DiskShape{radius, 0}, static_cast<int>(scene.materials.size()) - 1,
                glm::translate(glm::dmat4(1), at));
}

/// Many things in one scene, whose kernels drivers compile once: a floor that glows in a checker of texels
/// and above it disks, along x. The sun stands at 0.8 over the disks, towards +x.
SceneDescription many_disks() {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scene.image.background_bottom = scene.image.background_top = dvec3(0.25);
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {-0.6, -0.8, 0};
  scene.lights.push_back(sun);
  std::vector<std::uint8_t> cells;
  for (int i = 0; i < 64 * 64; ++i) cells.push_back((i / 64 + i) % 2 ? 255 : 0);
  MaterialDescription glow, white;
  white.ambient = dvec3(0), white.diffuse = dvec3(1);
  glow.ambient = glow.diffuse = dvec3(0);
  glow.emission = dvec3(1, 0.5, 0.25);
  glow.textures.emission = add_image(scene, 64, std::move(cells));
  scene.materials.push_back(glow);
  scenes::place(scene, PlaneShape{}, 0);
  MaterialDescription leaf = glow;
  leaf.emission = {0, 1, 0};
  leaf.textures = {};
  leaf.textures.opacity = add_halves(scene, 255, 0);
  leaf.cutoff = 0.5;
  place_disk(scene, white, {leaf_at, 1, 0}, 3);
  place_disk(scene, leaf, {leaf_at, 2, 0}, 1);
  MaterialDescription bent = white;
  bent.textures.normal = add_image(scene, 1, {179, 128, 230, 255}, 4);
  place_disk(scene, bent, {bent_at, 1, 0}, 1);
  MaterialDescription front = white;
  front.ambient = dvec3(1), front.diffuse = dvec3(0);
  front.one_sided = true;
  place_disk(scene, front, {front_at, 1, 0}, 1);
  // From above and from the sun only their backs would be seen, which are not there.
  place_disk(scene, white, {back_at, 0.5, 0}, 3);
  place_disk(scene, front, {back_at, 1, 0}, 1);
  scene.objects.back().world_from_object =
      glm::rotate(scene.objects.back().world_from_object, std::numbers::pi, dvec3(1, 0, 0));
  MaterialDescription wall = white;
  wall.textures.height = add_halves(scene, 0, 255);
  wall.bump = 0;
  wall.parallax = 0.2;
  place_disk(scene, wall, {wall_at, 1, 0}, 1);
  return scene;
}

dvec3 seen(const DeviceInfo& info, const SceneDescription& scene, dvec3 from, dvec3 to, double fov = 1e-3) {
  SceneDescription view = scene;
  view.camera.position = from;
  view.camera.target = to;
  view.camera.fov = fov;
  return scenes::pixel_on(info, view);
}

}  // namespace

TEST_CASE("pictures have what textures make of surfaces") {
  const SceneDescription scene = many_disks();
  on_every_device([&](const DeviceInfo& info) {
    if (info.native_vector_width == 1) return;  // whose drivers compile so many features for minutes
    const auto below = [&](double x, double height) { return seen(info, scene, {x, height, 0}, {x, 0, 0}); };
    // 70 repeats of the checker in a pixel are its mean; near by a texel is what it is.
    const dvec3 far = seen(info, scene, {-300, 2000, 0.1}, {-300, 0, 0.1}, 2);
    CHECK(far.x == Approx(0.5).epsilon(1e-2));
    CHECK(far.y == Approx(0.25).epsilon(1e-2));
    const dvec3 texel{-5 + 20.5 / 64, 0, 11.5 / 64 - 1};
    CHECK(seen(info, scene, texel + dvec3(0, 1e-3, 0), texel).x == Approx((11 + 20) % 2).margin(2e-3));
    // The leaf's left half is there, with its shadow 0.75 to the left; the right half lets all through.
    CHECK(below(leaf_at - 0.7, 5).y == Approx(1));
    CHECK(below(leaf_at - 0.7, 5).x == Approx(0).margin(1e-6));
    CHECK(below(leaf_at + 0.5, 5).x == Approx(0.8));
    CHECK(below(leaf_at - 1.2, 1.5).x == Approx(0).margin(1e-6));
    CHECK(below(leaf_at - 0.1, 1.5).x == Approx(0.8));
    const dvec3 n = glm::normalize(dvec3(179 / 127.5 - 1, 230 / 127.5 - 1, 1 - 128 / 127.5));
    // Less what the terminator takes (Conty Estevez and others 2019).
    const double lit = glm::dot(n, dvec3(0.6, 0.8, 0)), alpha2 = 0.125 * (1 - n.y * n.y) / (n.y * n.y);
    CHECK(below(bent_at, 3).x == Approx(lit * 2 / (1 + std::sqrt(1 + alpha2 * 0.36 / 0.64))).margin(2e-3));
    CHECK(below(front_at, 3).x == Approx(1));
    CHECK(seen(info, scene, {front_at, 0.5, 0}, {front_at, 3, 0}).x == Approx(0.25));
    CHECK(below(back_at, 3).x == Approx(0.8));
    // Left of the wall, which is 0.2 high, its shadow is 0.15 wide.
    CHECK(below(wall_at - 0.07, 3).x == Approx(0).margin(1e-6));
    CHECK(below(wall_at - 0.3, 3).x == Approx(0.8));
    CHECK(below(wall_at + 0.3, 3).x == Approx(0.8));
  });
}

TEST_CASE("heights on a further set of coordinates bend normals and sink in as on the first") {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {-0.6, -0.8, 0};
  scene.lights.push_back(sun);
  Mesh quad;
  quad.normals.assign(4, {0, 1, 0});
  for (const glm::vec2 corner : {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)}) {
    quad.positions.push_back({corner.x, 0, corner.y});
    quad.uvs.push_back({0.5f + 0.5f * corner.x, 0.5f - 0.5f * corner.y});
  }
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  quad.further_uvs = {quad.uvs};
  // The second set is that of the first; the first of the other quad is turned by a quarter.
  Mesh other = quad;
  for (glm::vec2& uv : other.uvs) uv = {1 - uv.y, uv.x};
  scene.meshes = {quad, other};
  const int image = add_image(scene, 8, {0, 10, 40, 90, 160, 200, 230, 255});
  MaterialDescription material;
  material.ambient = dvec3(0), material.diffuse = dvec3(1);
  material.textures.height = image;
  material.bump = 0.2;
  material.parallax = 0.1;
  scene.materials.assign(2, material);
  scene.textures.push_back(scene.textures[static_cast<std::size_t>(image)]);
  scene.textures.back().uv_set = 1;
  scene.materials[1].textures.height = static_cast<int>(scene.textures.size()) - 1;
  scenes::place(scene, MeshShape{0}, 0);
  scenes::place(scene, MeshShape{1}, 1, glm::translate(glm::dmat4(1), dvec3(10, 0, 0)));
  on_picture_devices([&](const DeviceInfo& info) {
    for (const double x : {-0.6, -0.1, 0.35}) {
      INFO(x);
      const double first = seen(info, scene, {x + 1, 3, 0.2}, {x, 0, 0.2}).x,
                   further = seen(info, scene, {x + 11, 3, 0.2}, {x + 10, 0, 0.2}).x;
      CHECK(std::abs(first - 0.8) > 0.01);  // of a flat surface
      CHECK(further == Approx(first).margin(2e-3));
    }
  });
}

TEST_CASE("an opacity cut off lets rays and light through where the texture says") {
  // The left half of the disk is there, the right half is not; a floor that glows, and one that is lit,
  // below.
  ImageDescription image;
  image.srgb = false;
  image.pixels.width = 2;
  image.pixels.height = 1;
  image.pixels.channels = 1;
  image.pixels.data = {255, 0};
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = 0;
  texture.wrap[0] = texture.wrap[1] = Wrap::clamp;
  scene.images.push_back(image);
  scene.textures.push_back(texture);
  MaterialDescription leaf;
  leaf.ambient = leaf.diffuse = dvec3(0);
  leaf.emission = {0, 1, 0};
  leaf.textures.opacity = 0;
  leaf.cutoff = 0.5;
  scene.materials.push_back(leaf);
  scenes::place(scene, DiskShape{1, 0}, 0, glm::translate(glm::dmat4(1), dvec3(0, 1, 0)));
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};
  scene.lights.push_back(sun);
  on_every_device([&](const DeviceInfo& info) {
    const auto at = [&](double x, double height) {
      SceneDescription view = scene;
      view.camera.position = {x, height, 0};
      view.camera.target = {x, 0, 0};
      return scenes::pixel_on(info, view);
    };
    CHECK(at(-0.7, 5).y == Approx(1));  // the leaf
    CHECK(at(-0.7, 5).x == Approx(0));
    CHECK(at(0.7, 5).x == Approx(1));     // the lit floor through it
    CHECK(at(-0.7, 0.5).x == Approx(0));  // its shadow
    CHECK(at(0.7, 0.5).x == Approx(1));   // no shadow
  });
}
