// Filters texels in double precision, with the textures' wrap modes.
#include "scene/heights.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/image_io.h"

namespace sundog {
namespace {

double channel_value(const ImageDescription& image, int x, int y, int channel) {
  const StoredImage& pixels = image.pixels;
  const auto channels = static_cast<std::size_t>(pixels.channels);
  const auto pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(x);
  if (channels == 1 && channel == 3) return 1;
  const std::size_t sample = pixel * channels + (channels == 1 ? 0 : static_cast<std::size_t>(channel));
  if (pixels.sample == StoredImage::Sample::byte) {
    const double value = pixels.data[sample] / 255.0;
    return image.srgb && channel < 3 ? double(linear_from_srgb(static_cast<float>(value))) : value;
  }
  std::uint16_t word = 0;
  std::memcpy(&word, pixels.data.data() + 2 * sample, 2);
  return pixels.sample == StoredImage::Sample::word ? word / 65535.0 : double(float_from_half(word));
}

double wrap(double x, Wrap mode) {
  if (!std::isfinite(x)) return 0;
  if (mode == Wrap::repeat) return x - std::floor(x);
  if (mode == Wrap::mirror) return 1 - std::abs(1 - (x - 2 * std::floor(x / 2)));
  return std::clamp(x, 0.0, 1.0);
}

int wrap_texel(int x, int size, Wrap mode) {
  if (mode == Wrap::repeat) x = x < 0 ? x + size : x >= size ? x - size : x;
  return std::clamp(x, 0, size - 1);
}

}  // namespace

double texture_number(const SceneDescription& scene, const TextureDescription& texture, glm::dvec2 uv) {
  const ImageDescription& image = scene.images.at(static_cast<std::size_t>(texture.image));
  const int channel = std::max(texture.channel, 0);
  const glm::dvec3 at = texture.uv * glm::dvec3(uv, 1);
  const bool nearest = texture.filter == TextureFilter::nearest;
  const double middle = nearest ? 0 : 0.5;
  const double x = wrap(at.x, texture.wrap[0]) * image.pixels.width - middle,
               y = wrap(1 - at.y, texture.wrap[1]) * image.pixels.height - middle;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto texel = [&](int dx, int dy) {
    return channel_value(image, wrap_texel(x0 + dx, image.pixels.width, texture.wrap[0]),
                         wrap_texel(y0 + dy, image.pixels.height, texture.wrap[1]), channel);
  };
  const double s = x - x0, t = y - y0;
  const double value =
      nearest ? texel(0, 0)
              : glm::mix(glm::mix(texel(0, 0), texel(1, 0), s), glm::mix(texel(0, 1), texel(1, 1), s), t);
  return value * texture.factor[channel] + texture.offset[channel];
}

}  // namespace sundog
