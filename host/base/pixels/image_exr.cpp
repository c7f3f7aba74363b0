// Reads and writes EXR with OpenEXR: colour as R, G, B(, A), each AOV as a layer of 32-bit float channels
// ("depth.Z", "normal.X").
#include <fmt/format.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfFramesPerSecond.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "base/colors/color_space.h"
#include "base/limits.h"
#include "base/pixels/image_codecs.h"

namespace sundog {
namespace {

class MemoryOut : public Imf::OStream {
 public:
  explicit MemoryOut(std::string& bytes) : Imf::OStream("memory"), bytes_(bytes) {}
  void write(const char c[], int n) override {
    const auto size = static_cast<std::size_t>(n);
    if (bytes_.size() < at_ + size) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, c, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = position; }

 private:
  std::string& bytes_;
  std::size_t at_ = 0;
};

class MemoryIn : public Imf::IStream {
 public:
  explicit MemoryIn(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char c[], int n) override {
    const auto size = static_cast<std::size_t>(n);
    if (at_ > bytes_.size() || bytes_.size() - at_ < size)
      throw std::runtime_error("the EXR file is cut short");
    std::memcpy(c, bytes_.data() + at_, size);
    at_ += size;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

using Suffixes = std::vector<std::string>;

/// Whether the AOV is a part of the light (kernels/shared/light_parts.h) or the light of a light group.
bool is_light_part(std::string_view aov) {
  return aov.ends_with("_direct") || aov.ends_with("_indirect") || aov == "emission" || aov == "sky" ||
         aov.starts_with("light_");
}

/// Names of a layer's channels.
Suffixes channel_suffixes(const std::string& aov, int channels) {
  if (channels == 1) return {aov == "depth" ? "Z" : "Y"};
  if (channels == 2) return aov == "motion" ? Suffixes{"X", "Y"} : Suffixes{"U", "V"};
  const bool color = aov == "albedo" || aov == "variance" || channels == 4 || is_light_part(aov);
  const Suffixes all = color ? Suffixes{"R", "G", "B", "A"} : Suffixes{"X", "Y", "Z"};
  return {all.begin(), all.begin() + channels};
}

/// Adds interleaved samples as a channel; `fill` replaces channels missing in a file. The library takes
/// non-const pixels, but writes to them only when reading a file.
template <class Sample>
void add_slice(Imf::FrameBuffer& buffer, const std::string& name, const Sample* samples, const Image& shape,
               float fill = 0) {
  const std::size_t pixel = sizeof(Sample) * static_cast<std::size_t>(shape.channels);
  char* base = reinterpret_cast<char*>(const_cast<Sample*>(samples));
  const auto type = std::is_same_v<Sample, half> ? Imf::HALF : Imf::FLOAT;
  buffer.insert(name,
                Imf::Slice(type, base, pixel, pixel * static_cast<std::size_t>(shape.width), 1, 1, fill));
}

/// Moves the slices so that they begin at the file's `corner`, because the library counts from pixel (0, 0).
void begin_at(Imf::FrameBuffer& buffer, const Imath::V2i& corner) {
  for (auto at = buffer.begin(); at != buffer.end(); ++at)
    at.slice().base -= static_cast<std::ptrdiff_t>(at.slice().xStride) * corner.x +
                       static_cast<std::ptrdiff_t>(at.slice().yStride) * corner.y;
}

Imf::Chromaticities chromaticities(const Primaries& p) {
  const auto v = [](glm::dvec2 c) { return Imath::V2f(static_cast<float>(c.x), static_cast<float>(c.y)); };
  return {v(p.red), v(p.green), v(p.blue), v(p.white)};
}

Primaries primaries(const Imf::Chromaticities& c) {
  const auto v = [](const Imath::V2f& p) { return glm::dvec2(p.x, p.y); };
  return {v(c.red), v(c.green), v(c.blue), v(c.white)};
}

/// Multiplies the first three channels by `matrix`.
void convert(Image& image, const glm::dmat3& matrix) {
  for (std::size_t i = 0; i < image.data.size(); i += static_cast<std::size_t>(image.channels)) {
    float* c = &image.data[i];
    const glm::dvec3 made = matrix * glm::dvec3(c[0], c[1], c[2]);
    for (int k = 0; k < 3; ++k) c[k] = static_cast<float>(made[k]);
  }
}

/// Converts colours of another space to sRGB primaries.
void convert_to_srgb(Image& image, const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return;
  const Imf::Chromaticities found = Imf::chromaticities(header), srgb = chromaticities(srgb_primaries);
  const auto near = [](const Imath::V2f& a, const Imath::V2f& b) { return (a - b).length() < 1e-4f; };
  if (near(found.red, srgb.red) && near(found.green, srgb.green) && near(found.blue, srgb.blue) &&
      near(found.white, srgb.white))
    return;
  const glm::dmat3 matrix = conversion(primaries(found), srgb_primaries);
  for (int i = 0; i < 9; ++i)
    if (!std::isfinite(matrix[i / 3][i % 3]))
      throw std::runtime_error("the EXR file's chromaticities span no space of colours");
  convert(image, matrix);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % 4 < 3) image.data[i] = std::max(image.data[i], 0.0f);
}

std::int64_t width_of(const Imath::Box2i& window) { return std::int64_t{window.max.x} - window.min.x + 1; }
std::int64_t height_of(const Imath::Box2i& window) { return std::int64_t{window.max.y} - window.min.y + 1; }

/// Limit for pixels of the display window outside the data window.
constexpr std::int64_t most_empty_pixels = std::int64_t{1} << 24;

/// Reads the display window: crops what lies outside it and fills pixels outside the data window with 0.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : stream_(bytes), file_(stream_) {
    const Imath::Box2i window = file_.header().dataWindow();
    width_ = static_cast<int>(width_of(window));
    height_ = static_cast<int>(height_of(window));
    origin_ = window.min;
    shown_ = file_.header().displayWindow();
    const std::int64_t columns = width_of(shown_), rows = height_of(shown_);
    if (!is_frame_size(columns, rows) || (columns * rows > most_empty_pixels &&
                                          columns * rows / 2000 > static_cast<std::int64_t>(bytes.size())))
      throw std::runtime_error(fmt::format("the EXR file says a display window of {}x{} pixels in {} bytes",
                                           columns, rows, bytes.size()));
  }

  const Imf::Header& header() const { return file_.header(); }
  const Imf::ChannelList& channels() const { return file_.header().channels(); }
  bool has(const std::string& name) const { return channels().findChannel(name) != nullptr; }

  /// The channels of the picture itself; the others are layers.
  Suffixes color_channels() const {
    Suffixes names;
    for (auto channel = channels().begin(); channel != channels().end(); ++channel)
      names.emplace_back(channel.name());
    return exr_picture_channels(names);
  }

  /// Reads the named channels into one image, in that order; absent channels are filled with `fill`.
  Image read(const Suffixes& names, std::vector<float> fill = {}) {
    fill.resize(names.size());
    Image image(width_, height_, static_cast<int>(names.size()));
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < names.size(); ++c) {
      const Imf::Channel* channel = channels().findChannel(names[c]);
      if (channel && (channel->xSampling != 1 || channel->ySampling != 1))
        throw std::runtime_error("EXR channel " + names[c] + " is subsampled, which is not supported");
      add_slice(buffer, names[c], image.data.data() + c, image, fill[c]);
    }
    begin_at(buffer, origin_);
    file_.setFrameBuffer(buffer);
    file_.readPixels(origin_.y, origin_.y + height_ - 1);
    if (shown_ == file_.header().dataWindow()) return image;
    std::vector<float> outside;
    for (std::size_t c = 0; c < names.size(); ++c) outside.push_back(has(names[c]) ? 0 : fill[c]);
    return show(image, outside);
  }

 private:
  Image show(const Image& data, const std::vector<float>& outside) const {
    Image image(static_cast<int>(width_of(shown_)), static_cast<int>(height_of(shown_)), data.channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = outside[i % outside.size()];
    const int left = std::max(shown_.min.x, origin_.x),
              right = std::min<int>(shown_.max.x, file_.header().dataWindow().max.x);
    for (int y = std::max(shown_.min.y, origin_.y);
         y <= std::min(shown_.max.y, file_.header().dataWindow().max.y) && left <= right; ++y) {
      const auto at = [&](const Imath::V2i& origin, int width) {
        return ((std::ptrdiff_t{y} - origin.y) * width + left - origin.x) * data.channels;
      };
      std::copy_n(data.data.begin() + at(origin_, width_), (std::ptrdiff_t{right} - left + 1) * data.channels,
                  image.data.begin() + at(shown_.min, image.width));
    }
    return image;
  }

  MemoryIn stream_;
  Imf::InputFile file_;
  Imath::V2i origin_;
  Imath::Box2i shown_;
  int width_ = 0, height_ = 0;
};

/// Upper bound of a file's size: incompressible blocks are stored uncompressed.
std::size_t greatest_size(const Imf::Header& header) {
  std::size_t pixel = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
    pixel += channel.channel().type == Imf::HALF ? 2 : 4;
  const Imath::Box2i& window = header.dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x) + 1,
             height = static_cast<std::size_t>(window.max.y) + 1;
  return width * height * pixel + 16 * height + (std::size_t{1} << 16);
}

Imath::M44f row_matrix(const glm::dmat4& m) {
  Imath::M44f rows;
  for (int i = 0; i < 16; ++i) rows[i / 4][i % 4] = static_cast<float>(m[i / 4][i % 4]);
  return rows;
}

/// Adds matrices for row vectors, seconds and metres, as ImfStandardAttributes.h defines them.
void add_shot(Imf::Header& header, const Shot& shot) {
  Imf::addWorldToCamera(header, row_matrix(shot.world_to_camera));
  Imf::addWorldToNDC(header, row_matrix(shot.world_to_ndc));
  header.screenWindowWidth() = static_cast<float>(shot.window_width);
  if (shot.focus) Imf::addFocus(header, static_cast<float>(*shot.focus));
  if (!shot.frame) return;
  header.insert("imageCounter", Imf::IntAttribute(*shot.frame));
  Imf::addFramesPerSecond(header, Imf::guessExactFps(shot.frames_per_second));
  if (shot.exposure_seconds > 0) Imf::addExpTime(header, static_cast<float>(shot.exposure_seconds));
}

/// Converts an image's channels for a file, some rows at a time.
class ChannelRows {
 public:
  ChannelRows(const Image& image, ExrColor color, const std::optional<glm::dmat3>& matrix, Suffixes names,
              int most_rows)
      : image_(image),
        matrix_(matrix),
        names_(std::move(names)),
        rows_(image.width, most_rows, image.channels) {
    if (color == ExrColor::half) halves_.resize(rows_.data.size());
  }

  void declare_in(Imf::Header& header) const {
    for (const std::string& name : names_)
      header.channels().insert(name, Imf::Channel(halves_.empty() ? Imf::FLOAT : Imf::HALF));
  }

  /// Adds `count` rows, starting with row y.
  void add_to(Imf::FrameBuffer& buffer, int y, int count) {
    const std::ptrdiff_t values = std::ptrdiff_t{count} * image_.width * image_.channels;
    std::copy_n(image_.pixel(0, y), values, rows_.data.begin());
    if (matrix_) convert(rows_, *matrix_);
    std::transform(rows_.data.begin(), rows_.data.begin() + (halves_.empty() ? 0 : values), halves_.begin(),
                   [](float v) { return half(std::clamp(v, -greatest_half, greatest_half)); });
    for (std::size_t c = 0; c < names_.size(); ++c)
      if (halves_.empty())
        add_slice(buffer, names_[c], rows_.data.data() + c, rows_);
      else
        add_slice(buffer, names_[c], halves_.data() + c, rows_);
  }

 private:
  const Image& image_;
  std::optional<glm::dmat3> matrix_;
  Suffixes names_;
  Image rows_;
  std::vector<half> halves_;
};

constexpr int rows_of_block = 16;  // a file compresses them together

/// How many blocks of rows to compress at once: one per thread, as long as their copies take at most 64 MiB.
int blocks_at_once(const Image& image, const AovImages& aovs) {
  std::size_t bytes = image.data.size() * sizeof(float);
  for (const auto& [name, layer] : aovs) bytes += layer.data.size() * sizeof(float);
  const std::size_t block = rows_of_block * bytes / static_cast<std::size_t>(image.height) + 1;
  return std::clamp(static_cast<int>((64u << 20) / block), 1, std::max(Imf::globalThreadCount(), 1));
}

}  // namespace

void share_exr_work(unsigned threads) {
  try {
    Imf::setGlobalThreadCount(static_cast<int>(threads));
  } catch (const std::exception&) {
    // the existing threads do the work
  }
}

std::string encode_exr(const Image& image, const AovImages& aovs, const FileOptions& options) {
  const bool acescg = options.space == ExrSpace::acescg;
  const Primaries& space = acescg ? ap1_primaries : srgb_primaries;
  const auto matrix = acescg ? std::optional(conversion(srgb_primaries, space)) : std::nullopt;
  const Region region = options.region.value_or(Region{0, 0, image.width, image.height});
  const Imath::V2i corner(region.x, region.y);
  Imf::Header header(Imath::Box2i({0, 0}, {region.whole_width - 1, region.whole_height - 1}),
                     Imath::Box2i(corner, corner + Imath::V2i(image.width - 1, image.height - 1)));
  header.compression() = Imf::ZIP_COMPRESSION;
  std::size_t text_bytes = 0;
  Imf::addChromaticities(header, chromaticities(space));
  Imf::addXDensity(header, static_cast<float>(options.dpi));
  if (options.shot) add_shot(header, *options.shot);
  for (const auto& [name, text] : options.texts) {
    if (name == "capDate") Imf::addUtcOffset(header, 0);  // the date is in UTC
    header.insert(name, Imf::StringAttribute(text));
    text_bytes += name.size() + text.size() + 32;
  }
  const int blocks = blocks_at_once(image, aovs), most = std::min(rows_of_block * blocks, image.height);
  const Suffixes names = {"R", "G", "B", "A"};
  std::vector<ChannelRows> all;
  all.emplace_back(image, options.color, matrix, Suffixes(names.begin(), names.begin() + image.channels),
                   most);
  for (const auto& [aov, layer] : aovs) {
    Suffixes suffixes = channel_suffixes(aov, layer.channels);
    for (std::string& suffix : suffixes) suffix.insert(0, aov + ".");
    const bool colors = aov == "albedo" || aov == "denoise_albedo" || is_light_part(aov);
    all.emplace_back(layer, ExrColor::full, colors ? matrix : std::nullopt, std::move(suffixes), most);
  }
  for (const ChannelRows& channels : all) channels.declare_in(header);
  std::string bytes;
  bytes.reserve(greatest_size(header) + text_bytes);  // a growing string would need twice the memory
  MemoryOut out(bytes);
  {
    Imf::OutputFile file(out, header, blocks);
    for (int y = 0, count; y < image.height; y += count) {
      count = std::min(most, image.height - y);
      Imf::FrameBuffer buffer;
      for (ChannelRows& channels : all) channels.add_to(buffer, y, count);
      begin_at(buffer, corner + Imath::V2i(0, y));
      file.setFrameBuffer(buffer);
      file.writePixels(count);
    }
  }
  return bytes;
}

Image decode_exr(std::string_view bytes, bool colors) {
  check_exr_header(bytes);
  Reader reader(bytes);
  const Suffixes names = reader.color_channels();
  if (names.size() == 4) {
    Image image = reader.read(names, {0, 0, 0, 1});
    if (colors) convert_to_srgb(image, reader.header());
    return image;
  }
  const Image grey = reader.read(names, {0, 1});
  Image image(grey.width, grey.height, 4);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = grey.data[i / 4 * 2 + (i % 4 == 3)];
  return image;
}

AovImages decode_exr_aovs(std::string_view bytes) {
  check_exr_header(bytes);
  Reader reader(bytes);
  std::map<std::string, Suffixes> layers;
  for (auto channel = reader.channels().begin(); channel != reader.channels().end(); ++channel) {
    const std::string name = channel.name();
    const bool whole = channel.channel().xSampling == 1 && channel.channel().ySampling == 1;
    if (whole && std::ranges::count(reader.color_channels(), name) == 0)
      layers[name.substr(0, std::max<std::size_t>(name.rfind('.'), 1))].push_back(name);
  }
  constexpr std::string_view order = "RGBAXYZUV";
  AovImages aovs;
  for (auto& [name, channels] : layers) {
    std::ranges::stable_sort(channels, {},
                             [&](const std::string& channel) { return order.find(channel.back()); });
    aovs[name] = reader.read(channels);
  }
  return aovs;
}

ImageTexts decode_exr_texts(std::string_view bytes) {
  check_exr_header(bytes);
  const Reader reader(bytes);
  ImageTexts texts;
  for (auto found = reader.header().begin(); found != reader.header().end(); ++found)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&found.attribute()))
      texts.emplace_back(found.name(), text->value());
  return texts;
}

}  // namespace sundog
