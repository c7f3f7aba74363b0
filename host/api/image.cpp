// Implements the public Image: shares the immutable pixels of a host image.
#include <algorithm>

#include "api/impl.h"
#include "base/code_names.h"

namespace sundog {
inline namespace v0 {
namespace {

core::ToneMap tone_map_of(const ToneMap& map) {
  const auto& curves = sundog::enumerator_names<sundog::ToneCurve>;
  const auto curve = std::ranges::find(curves, std::string_view(map.curve));
  if (curve == curves.end() || map.curve.empty())
    throw Error(ErrorKind::usage,
                "tone map: wanted the curve none, reinhard, aces or agx, found \"" + map.curve + "\"");
  if (!(std::abs(map.exposure) <= 32))
    throw Error(ErrorKind::usage, "tone map: wanted an exposure of -32 to 32 stops");
  const bool white = map.white_balance >= sundog::least_white && map.white_balance <= sundog::greatest_white;
  if (map.white_balance != 0 && !white)
    throw Error(ErrorKind::usage, "tone map: wanted a white balance of 1667 to 25000 kelvin, or 0");
  return core::ToneMap{static_cast<sundog::ToneCurve>(curve - curves.begin()), map.exposure,
                       map.white_balance};
}

std::shared_ptr<const Image::Impl> no_pixels() {
  static const auto none =
      std::make_shared<const Image::Impl>(Image::Impl{std::make_shared<const core::Image>()});
  return none;
}

const core::Image& with_colors(const core::Image& image) {
  if (image.channels < 3 || image.width < 1 || image.height < 1)
    throw Error(ErrorKind::usage, "a file wants a picture of 3 or 4 channels and a pixel or more");
  return image;
}

}  // namespace

Image share(core::Image image) { return share(std::make_shared<const core::Image>(std::move(image))); }

Image share(std::shared_ptr<const core::Image> image) {
  if (!image) return {};
  return Image(std::make_shared<const Image::Impl>(Image::Impl{std::move(image)}));
}

Image::Image() : impl_(no_pixels()) {}
Image::Image(std::shared_ptr<const Impl> impl) noexcept : impl_(std::move(impl)) {}

Image::Image(int width, int height, int channels, std::span<const float> pixels) {
  constexpr int most = 65536;
  if (width < 1 || height < 1 || width > most || height > most || channels < 1 || channels > 4 ||
      channels == 2)
    throw Error(ErrorKind::usage, "an image wants 1 to 65536 pixels each way, and 1, 3 or 4 channels");
  const auto wanted = std::size_t(width) * std::size_t(height) * std::size_t(channels);
  if (pixels.size() != wanted)
    throw Error(ErrorKind::usage, "an image of " + std::to_string(width) + "x" + std::to_string(height) +
                                      "x" + std::to_string(channels) + " wants " + std::to_string(wanted) +
                                      " floats, found " + std::to_string(pixels.size()));
  core::Image image(width, height, channels);
  std::ranges::copy(pixels, image.data.begin());
  impl_ = std::make_shared<const Impl>(Impl{std::make_shared<const core::Image>(std::move(image))});
}

int Image::width() const noexcept { return impl_->image->width; }
int Image::height() const noexcept { return impl_->image->height; }
int Image::channels() const noexcept { return impl_->image->channels; }
std::span<const float> Image::pixels() const noexcept { return impl_->image->data; }

Image Image::tone_mapped(const ToneMap& map) const {
  core::Image changed = *impl_->image;
  const core::ToneMap wanted = tone_map_of(map);
  if (changed.channels >= 3) apply(wanted, changed);
  return share(std::move(changed));
}

Image Image::load(const std::filesystem::path& file) {
  return translated([&] { return share(read_image(file)); });
}

void Image::save(const std::filesystem::path& file) const {
  translated([&] { write_image(with_colors(*impl_->image), file); });
}

std::string Image::encode(const std::string& extension) const {
  return translated([&] { return encode_image(with_colors(*impl_->image), "picture." + extension); });
}

}  // namespace v0
}  // namespace sundog
