// Merges equal images, decodes them in parallel, and halves the largest until all fit.
#include "scene/decode_images.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <new>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "base/pixels/image_levels.h"
#include "scene/read/frame_cache.h"

namespace sundog {
namespace {

/// Merges images of equal bytes and use.
void merge_images(SceneDescription& scene) {
  std::map<std::tuple<std::string_view, bool, bool>, int> first;
  std::vector<int> index_of;
  std::vector<bool> kept;
  int count = 0;
  for (const ImageDescription& image : scene.images) {
    const auto [found, added] = first.try_emplace({image.encoded, image.srgb, image.plain}, count);
    kept.push_back(added || image.encoded.empty());
    index_of.push_back(kept.back() ? count++ : found->second);
  }
  for (TextureDescription& texture : scene.textures)
    if (texture.image >= 0) texture.image = index_of.at(static_cast<std::size_t>(texture.image));
  std::vector<ImageDescription> images;
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (kept[i]) images.push_back(std::move(scene.images[i]));
  scene.images = std::move(images);
}

void decode(ImageDescription& image) {
  if (image.encoded.empty() && image.pixels.width > 0) return;  // generated, not read
  try {
    image.pixels = decode_stored(image.encoded, image.srgb && !image.plain);
    if (image.plain) image.pixels.exponent.reset();
    settle_samples(image.pixels, image.srgb);
  } catch (const std::bad_alloc&) {
    throw SceneError(image.file, image.place,
                     fmt::format("the image {} does not fit into memory", image.name));
  } catch (const std::exception& error) {
    throw SceneError(image.file, image.place, fmt::format("the image {}: {}", image.name, error.what()));
  }
  image.file_width = image.pixels.width;
  image.file_height = image.pixels.height;
  image.content = std::max<std::uint64_t>(std::hash<std::string>()(image.encoded), 1);
  image.encoded.clear();
  image.encoded.shrink_to_fit();
}

/// Decodes the image. A model's image that cannot be decoded becomes one white pixel, and `failure` says why.
void decode_or_white(ImageDescription& image, std::string& failure, FrameCache* cache) {
  try {
    if (cache && !image.encoded.empty())
      cache->decode(image, decode);
    else
      decode(image);
  } catch (const SceneError& error) {
    if (!image.of_model) throw;
    failure = fmt::format("{}; materials go without it", error.what());
    image.encoded.clear();
    image.pixels = StoredImage();
    image.pixels.width = image.pixels.height = 1;
    image.pixels.data.assign(4, 255);
    image.file_width = image.file_height = 1;
  }
}

/// Removes normal and height maps that became white: white is neutral as a factor, but not as a normal or
/// height.
void drop_reliefs(MaterialDescription& material, const std::vector<bool>& white,
                  const SceneDescription& scene) {
  const auto drop = [&](int& texture) {
    if (texture < 0) return;
    const int image = scene.textures[static_cast<std::size_t>(texture)].image;
    if (image >= 0 && white[static_cast<std::size_t>(image)]) texture = -1;
  };
  drop(material.textures.normal);
  drop(material.textures.height);
  drop(material.displaced_by);
}

/// Bytes of the image on a device, including mip levels.
std::size_t device_bytes(const ImageDescription& image) {
  return image.pixels.pixel_count() * image.pixels.pixel_bytes() * 4 / 3;
}

/// Colours are weighted by alpha if any texture uses the alpha.
SampleUse use_of(const ImageDescription& image, const SceneDescription& scene) {
  if (!image.srgb) return SampleUse::data;
  const bool cut = std::ranges::any_of(scene.textures, [&](const TextureDescription& texture) {
    return texture.image >= 0 && texture.channel == 3 &&
           same_picture(image, scene.images[static_cast<std::size_t>(texture.image)]);
  });
  return cut ? SampleUse::color_by_alpha : SampleUse::color;
}

void fit_images(SceneDescription& scene) {
  const auto budget = static_cast<std::size_t>(scene.render.texture_memory) << 20;
  const auto greatest = [&] { return std::ranges::max_element(scene.images, {}, device_bytes); };
  std::size_t total = 0;
  for (const ImageDescription& image : scene.images) total += device_bytes(image);
  while (total > budget) {
    ImageDescription& image = *greatest();
    if (image.pixels.pixel_count() == 1) break;
    total -= device_bytes(image);
    image.pixels = half_size(image.pixels, use_of(image, scene));
    total += device_bytes(image);
  }
  for (const ImageDescription& image : scene.images)
    if (image.pixels.width != image.file_width || image.pixels.height != image.file_height)
      scene.warnings.push_back(
          fmt::format("the image {} is made smaller, from {}x{} to {}x{}: the scene's images take more than "
                      "the {} MiB of /render/texture_memory",
                      image.name, image.file_width, image.file_height, image.pixels.width,
                      image.pixels.height, scene.render.texture_memory));
}

}  // namespace

void decode_images(SceneDescription& scene, FrameCache* cache) {
  if (scene.images.empty()) return;
  merge_images(scene);
  std::vector<std::string> failures(scene.images.size());
  tbb::parallel_for(std::size_t{0}, failures.size(),
                    [&](std::size_t i) { decode_or_white(scene.images[i], failures[i], cache); });
  std::vector<bool> white;
  for (const std::string& failure : failures) {
    white.push_back(!failure.empty());
    if (white.back() && std::ranges::count(scene.warnings, failure) == 0) scene.warnings.push_back(failure);
  }
  if (std::ranges::count(white, true) > 0)
    for (MaterialDescription& material : scene.materials) drop_reliefs(material, white, scene);
  fit_images(scene);
}

}  // namespace sundog
