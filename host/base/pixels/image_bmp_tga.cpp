// Decodes BMP and TGA, the texture formats of old models, with stb_image, whose code is compiled only here.
#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <stdexcept>

#include "base/pixels/stored_image.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>

namespace sundog {
namespace {

/// Tells whether stb_image read beyond the end, where it silently reads zeros.
struct WatchedBytes {
  std::string_view left;
  bool short_of = false;
};

constexpr stbi_io_callbacks callbacks = {
    .read = [](void* user, char* data, int size) -> int {
      auto& bytes = *static_cast<WatchedBytes*>(user);
      const std::size_t count = std::min(bytes.left.size(), static_cast<std::size_t>(size));
      if (count == 0) bytes.short_of = true;
      std::memcpy(data, bytes.left.data(), count);
      bytes.left.remove_prefix(count);
      return static_cast<int>(count);
    },
    .skip =
        [](void* user, int size) {
          auto& bytes = *static_cast<WatchedBytes*>(user);
          bytes.left.remove_prefix(std::min(bytes.left.size(), static_cast<std::size_t>(std::max(size, 0))));
        },
    .eof = [](void* user) { return static_cast<int>(static_cast<WatchedBytes*>(user)->left.empty()); }};

}  // namespace

int channels_of_bmp_or_tga(std::string_view bytes) {
  int width = 0, height = 0, channels = 0;
  WatchedBytes watched{bytes};
  return stbi_info_from_callbacks(&callbacks, &watched, &width, &height, &channels) != 0 ? channels : 0;
}

StoredImage decode_bmp_or_tga(std::string_view bytes) {
  StoredImage stored;
  int channels = 0;
  WatchedBytes watched{bytes};
  stbi_info_from_callbacks(&callbacks, &watched, &stored.width, &stored.height, &channels);
  constexpr int most_pixels_a_byte = 64;  // a run of TGA: 128 in two bytes
  check_image_size(stored.width, stored.height, 4, bytes.size(), most_pixels_a_byte);
  watched = {bytes};
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_callbacks(&callbacks, &watched, &stored.width, &stored.height, &channels, 4),
      stbi_image_free);
  if (!pixels) throw std::runtime_error(fmt::format("a bad BMP or TGA image: {}", stbi_failure_reason()));
  if (watched.short_of) throw std::runtime_error("the BMP or TGA image is cut short");
  stored.data.assign(pixels.get(), pixels.get() + 4 * stored.pixel_count());
  return stored;
}

}  // namespace sundog
