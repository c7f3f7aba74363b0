// Reads Radiance pictures (Ward, "Real Pixels", Graphics Gems II): text lines, a blank line, "-Y height +X
// width", then scanlines of red, green, blue mantissas and a shared exponent, flat or run-length coded.
// stb_image's reader would loop forever on truncated files.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  std::uint8_t next() {
    if (at_ >= bytes_.size()) throw std::runtime_error("the HDR data is cut short");
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }
  Rgbe next_pixel() { return {next(), next(), next(), next()}; }
  std::string_view line() {
    const std::size_t first = at_, end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) throw std::runtime_error("the HDR header is cut short");
    at_ = end + 1;
    return bytes_.substr(first, end - first);
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

struct Size {
  int width = 0, height = 0;
};

Size read_header(Bytes& bytes) {
  for (std::string_view line = bytes.line(); !line.empty(); line = bytes.line())
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      throw std::runtime_error(
          fmt::format("HDR header: wanted FORMAT=32-bit_rle_rgbe, found {}", line.substr(0, 40)));
  const std::string resolution(bytes.line());
  Size size;
  char end = 0;
  if (std::sscanf(resolution.c_str(), "-Y %9d +X %9d%c", &size.height, &size.width, &end) != 2 ||
      size.width <= 0 || size.height <= 0)
    throw std::runtime_error(
        fmt::format("HDR header: wanted -Y height +X width, found '{}'", resolution.substr(0, 40)));
  // The best compression: two bytes for a run of 127, in each of four components.
  if (static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) / 32 > bytes.left())
    throw std::runtime_error(fmt::format("the HDR data is cut short: {}x{} pixels in {} bytes", size.width,
                                         size.height, bytes.left()));
  return size;
}

/// Decodes one component of a scanline: runs (count above 128, value) and literals (count, values).
void read_runs(Bytes& bytes, std::vector<Rgbe>& row, std::size_t component) {
  for (std::size_t x = 0; x < row.size();) {
    std::size_t count = bytes.next();
    const bool run = count > 128;
    if (run) count -= 128;
    if (count == 0 || count > row.size() - x) throw std::runtime_error("the HDR data has a bad run length");
    std::uint8_t value = run ? bytes.next() : std::uint8_t{0};
    for (; count > 0; --count) row[x++][component] = run ? value : bytes.next();
  }
}

/// Decodes the older form: flat pixels, where (1, 1, 1, n) repeats the last pixel n times, and each
/// consecutive mark counts 256 times as much as the previous mark.
void read_flat(Bytes& bytes, std::vector<Rgbe>& row, Rgbe pixel) {
  unsigned shift = 0;
  for (std::size_t x = 0; x < row.size();) {
    if (x > 0 && pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::size_t count = std::size_t{pixel[3]} << shift;
      if (count > row.size() - x || shift > 16) throw std::runtime_error("the HDR data has a bad run length");
      for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
    if (x < row.size()) pixel = bytes.next_pixel();
  }
}

void read_row(Bytes& bytes, std::vector<Rgbe>& row) {
  const Rgbe first = bytes.next_pixel();
  const std::size_t length = std::size_t{first[2]} << 8 | first[3];
  if (first[0] != 2 || first[1] != 2 || first[2] >= 128 || row.size() < 8)
    return read_flat(bytes, row, first);
  if (length != row.size()) throw std::runtime_error("the HDR data has a scanline of another length");
  for (std::size_t component = 0; component < 4; ++component) read_runs(bytes, row, component);
}

}  // namespace

Image decode_hdr(std::string_view file) {
  Bytes bytes(file);
  const Size size = read_header(bytes);
  Image image(size.width, size.height, 4);
  std::vector<Rgbe> row(static_cast<std::size_t>(size.width));
  for (int y = 0; y < size.height; ++y) {
    read_row(bytes, row);
    float* to = image.pixel(0, y);
    for (const Rgbe& pixel : row) {
      const float scale = pixel[3] == 0 ? 0 : std::ldexp(1.0f, pixel[3] - 136);
      for (std::size_t c = 0; c < 3; ++c) *to++ = scale * static_cast<float>(pixel[c]);
      *to++ = 1;
    }
  }
  return image;
}

}  // namespace sundog
