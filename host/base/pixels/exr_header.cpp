// Validates an EXR header before OpenEXR reads it, because OpenEXR allocates the memory that a header
// requests, however short the file; chooses the picture among a file's channels. Layout (OpenEXR's
// documentation): attributes of a name, a type, a size of 4 bytes, and the value.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <set>
#include <stdexcept>

#include "base/limits.h"
#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

// Upper bound over EXR's compression methods.
constexpr std::uint64_t pixels_a_byte = 2000;

// A block of lines or a tile may request this much in any file.
constexpr std::uint64_t block_bytes = std::uint64_t{256} << 20, tile_pixels = std::uint64_t{1} << 22;

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error("the EXR file " + what); }

/// A bounds-checked byte reader; throws at the end of input.
class Walk {
 public:
  explicit Walk(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) refuse("is cut short");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  std::string_view text() {
    const std::size_t end = rest_.find('\0');
    if (end == std::string_view::npos) refuse("is cut short");
    const std::string_view found = take(end);
    take(1);
    return found;
  }
  template <class Number>
  Number number() {
    const std::string_view bytes = take(sizeof(Number));
    Number value;
    std::memcpy(&value, bytes.data(), bytes.size());
    return value;
  }
  std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

struct Shape {
  std::int64_t width = 0, height = 0;
  std::uint64_t pixel_bytes = 0;  // over all channels
  bool alpha = false;
  std::uint64_t lines = 1;  // lines compressed together
  std::uint64_t tile_pixels = 0;
};

/// A thumbnail; its size must match its pixels.
void check_preview(Walk value) {
  const std::uint64_t width = value.number<std::uint32_t>(), height = value.number<std::uint32_t>();
  if (4 * width * height != value.left())
    refuse(fmt::format("says a preview of {}x{} pixels in {} bytes", width, height, value.left()));
}

void check_strings(Walk value) {
  while (value.left() > 0) value.take(value.number<std::uint32_t>());
}

/// An idmanifest attribute: object names, zlib-packed after their size.
void check_manifest(Walk value) {
  constexpr std::uint64_t most_ratio = 1100;  // zlib's maximum
  const auto unpacked = value.number<std::uint64_t>();
  if (unpacked / most_ratio > value.left())
    refuse(fmt::format("says an idmanifest of {} bytes in {}", unpacked, value.left()));
}

void read_channels(Walk value, Shape& shape) {
  shape.pixel_bytes = 0;
  for (std::string_view name = value.text(); !name.empty(); name = value.text()) {
    shape.alpha |= name == "A";
    shape.pixel_bytes += value.number<std::int32_t>() == 1 ? 2 : 4;  // half, or float and unsigned
    value.take(12);                                                  // linearity flag, sampling
  }
}

std::uint64_t lines_of(Walk value) {
  constexpr std::array<std::uint64_t, 10> lines = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  const auto compression = value.number<std::uint8_t>();
  return compression < lines.size() ? lines[compression] : lines.back();
}

void read_window(Walk value, Shape& shape) {
  const std::int64_t left = value.number<std::int32_t>(), top = value.number<std::int32_t>();
  shape.width = value.number<std::int32_t>() - left + 1;
  shape.height = value.number<std::int32_t>() - top + 1;
}

void read_attribute(std::string_view name, std::string_view type, Walk value, Shape& shape) {
  if (type == "preview") check_preview(value);
  if (type == "stringvector") check_strings(value);
  if (type == "idmanifest") check_manifest(value);
  if (name == "dataWindow") read_window(value, shape);
  if (name == "channels") read_channels(value, shape);
  if (name == "compression") shape.lines = lines_of(value);
  if (name == "tiles")
    shape.tile_pixels = std::uint64_t{value.number<std::uint32_t>()} * value.number<std::uint32_t>();
}

Shape read_shape(std::string_view bytes) {
  Walk walk(bytes);
  walk.take(8);  // magic and version
  Shape shape;
  for (std::string_view name = walk.text(); !name.empty(); name = walk.text()) {
    const std::string_view type = walk.text();
    const auto size = walk.number<std::uint32_t>();
    if (size > walk.left())
      refuse(fmt::format("says {} bytes of \"{:.40}\", and has {}", size, name, walk.left()));
    read_attribute(name, type, Walk(walk.take(size)), shape);
  }
  return shape;
}

}  // namespace

bool exr_has_alpha(std::string_view bytes) { return read_shape(bytes).alpha; }

void check_exr_header(std::string_view bytes) {
  const unsigned flags = bytes.size() > 5 ? static_cast<unsigned char>(bytes[5]) : 0;
  if (flags & 0x08) throw std::runtime_error("a deep EXR file; wanted one sample a pixel");
  if (flags & 0x10) throw std::runtime_error("an EXR file of several parts; wanted one image");
  const Shape shape = read_shape(bytes);
  const std::uint64_t most_pixels_here = pixels_a_byte * bytes.size();
  if (!is_frame_size(shape.width, shape.height) ||
      static_cast<std::uint64_t>(shape.width * shape.height) / pixels_a_byte > bytes.size())
    refuse(fmt::format("says {}x{} pixels in {} bytes", shape.width, shape.height, bytes.size()));
  const std::uint64_t block = static_cast<std::uint64_t>(shape.width) * shape.pixel_bytes * shape.lines;
  if (block > block_bytes + most_pixels_here)
    refuse(fmt::format("says {} MiB for each {} lines in {} bytes", block >> 20, shape.lines, bytes.size()));
  if (shape.tile_pixels > std::max(tile_pixels, most_pixels_here))
    refuse(fmt::format("says tiles of {} pixels in {} bytes", shape.tile_pixels, bytes.size()));
}

std::vector<std::string> exr_picture_channels(const std::vector<std::string>& names) {
  const auto has = [&](const std::string& name) { return std::ranges::count(names, name) > 0; };
  std::set<std::string> layers{""};  // those that may hold a picture, each with its dot
  for (const std::string& name : names)
    if (const std::size_t dot = name.rfind('.'); dot != name.npos) layers.insert(name.substr(0, dot + 1));
  std::vector<std::vector<std::string>> pictures;
  for (const std::string& layer : layers) {
    const std::string red = layer + "R", green = layer + "G", blue = layer + "B", grey = layer + "Y";
    if (has(red) || has(green) || has(blue))
      pictures.push_back({red, green, blue, layer + "A"});
    else if (has(grey))
      pictures.push_back({grey, layer + "A"});
    if (layer.empty() && !pictures.empty()) return pictures[0];
  }
  if (pictures.size() == 1) return pictures[0];
  if (names.size() == 1) return {names[0], "A"};
  throw std::runtime_error(fmt::format(
      "the EXR file has no channels R, G, B or Y, and not one layer alone of these, but {}: write "
      "the picture's channels without a layer's name",
      fmt::join(names, ", ")));
}

}  // namespace sundog
