// Decodes JPEG with libjpeg-turbo, to one channel if the file is grey.
#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>
#include <stdexcept>

#include "base/memory.h"
#include "base/pixels/stored_image.h"

namespace sundog {
namespace {

struct DestroyJpeg {
  void operator()(void* handle) const { tjDestroy(handle); }
};

/// A Huffman-coded block of 64 pixels takes at least a bit; doubled for arithmetic coding.
constexpr std::int64_t jpeg_pixels_a_byte = 1024;

/// Throws for errors and warnings, except harmless ones: libjpeg only warns when it invents missing pixels.
void check_jpeg(void* handle, int result) {
  if (result == 0) return;
  const std::string_view reason = tjGetErrorStr2(handle);
  if (tjGetErrorCode(handle) == TJERR_WARNING && reason.find("extraneous bytes") != reason.npos) return;
  throw std::runtime_error(fmt::format("a bad JPEG image: {}", reason));
}

/// Converts CMYK to RGB. Adobe stores inks inverted: 255 is no ink.
void colors_from_inks(std::vector<std::uint8_t>& data) {
  for (std::size_t i = 0; i + 3 < data.size(); i += 4) {
    const unsigned black = data[i + 3];
    for (std::size_t c = 0; c < 3; ++c) data[i + c] = static_cast<std::uint8_t>(data[i + c] * black / 255);
    data[i + 3] = 255;
  }
}

}  // namespace

StoredImage decode_jpeg(std::string_view bytes) {
  const std::unique_ptr<void, DestroyJpeg> handle(tjInitDecompress());
  if (!handle) throw std::bad_alloc();
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto size = static_cast<unsigned long>(bytes.size());
  StoredImage stored;
  int sampling = 0, space = 0;
  check_jpeg(handle.get(),
             tjDecompressHeader3(handle.get(), data, size, &stored.width, &stored.height, &sampling, &space));
  check_image_size(stored.width, stored.height, 4, bytes.size(), jpeg_pixels_a_byte);
  const bool inks = space == TJCS_CMYK || space == TJCS_YCCK, grey = space == TJCS_GRAY;
  stored.channels = grey ? 1 : 4;
  fill_large(stored.data, stored.pixel_count() * stored.pixel_bytes());
  check_jpeg(handle.get(),
             tjDecompress2(handle.get(), data, size, stored.data.data(), stored.width, 0, stored.height,
                           grey   ? TJPF_GRAY
                           : inks ? TJPF_CMYK
                                  : TJPF_RGBA,
                           TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS));
  if (inks) colors_from_inks(stored.data);
  return stored;
}

}  // namespace sundog
