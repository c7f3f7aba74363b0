#include "scene/decode_images.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <new>
#include <string_view>

#include "base/error.h"
#include "base/pixels/image_levels.h"

namespace sundog {
namespace {

/// Images of the same bytes and use become one.
void merge_images(SceneDescription& scene) {
  std::map<std::pair<std::string_view, bool>, int> first;
  std::vector<int> index_of;
  std::vector<bool> kept;
  int count = 0;
  for (const ImageDescription& image : scene.images) {
    const auto [found, added] = first.try_emplace({image.encoded, image.srgb}, count);
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
  if (image.encoded.empty() && image.pixels.width > 0) return;  // made, not read
  try {
    image.pixels = decode_stored(image.encoded);
    settle_samples(image.pixels, image.srgb);
  } catch (const std::bad_alloc&) {
    throw SceneError(image.file, image.place,
                     fmt::format("the image {} does not fit into memory", image.name));
  } catch (const std::exception& error) {
    throw SceneError(image.file, image.place, fmt::format("the image {}: {}", image.name, error.what()));
  }
  image.file_width = image.pixels.width;
  image.file_height = image.pixels.height;
  image.encoded.clear();
  image.encoded.shrink_to_fit();
}

/// With its smaller levels.
std::size_t device_bytes(const ImageDescription& image) {
  return image.pixels.pixel_count() * image.pixels.pixel_bytes() * 4 / 3;
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
    image.pixels = half_size(image.pixels, image.srgb);
    total += device_bytes(image);
  }
  for (const ImageDescription& image : scene.images)
    if (image.pixels.width != image.file_width || image.pixels.height != image.file_height)
      scene.warnings.push_back(
          fmt::format("the image {} is made smaller, from {}x{} to {}x{}: the scene's images take more than "
                      "the {} MiB of "
                      "/render/texture_memory",
                      image.name, image.file_width, image.file_height, image.pixels.width,
                      image.pixels.height, scene.render.texture_memory));
}

}  // namespace

void decode_images(SceneDescription& scene) {
  if (scene.images.empty()) return;
  merge_images(scene);
  tbb::parallel_for(std::size_t{0}, scene.images.size(), [&](std::size_t i) { decode(scene.images[i]); });
  fit_images(scene);
}

}  // namespace sundog
