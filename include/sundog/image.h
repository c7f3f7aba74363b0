// Pictures, and their files.
#pragma once
#include <sundog/version.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace sundog {
inline namespace v0 {

/// From linear colours to those of a screen, for files of 8 bits a channel.
struct ToneMap {
  std::string curve = "none";  ///< "none", "reinhard", "aces", "agx"
  double exposure = 0;         ///< in stops, -32..32: each one doubles the brightness
  double white_balance = 0;    ///< kelvin, 1667..25000: light of this temperature becomes white; 0: unchanged
};

/// Linear floats, immutable. A copy shares the pixels: it costs nothing, and any thread may use it.
class SUNDOG_API Image {
 public:
  /// No pixels.
  Image();
  /// A copy of `pixels`: width * height * channels floats, row 0 at the top, channels of a pixel side by
  /// side. Channels: 1, 3 or 4 (the last of four is coverage). Throws Error (usage) for another length.
  Image(int width, int height, int channels, std::span<const float> pixels);

  int width() const noexcept;     ///< in pixels; 0 without any
  int height() const noexcept;    ///< in pixels; 0 without any
  int channels() const noexcept;  ///< floats a pixel: 1, 3 or 4
  /// width() * height() * channels() floats, row 0 at the top. Valid while an Image shares them.
  std::span<const float> pixels() const noexcept;

  /// The picture as a screen shows it, still linear. Throws Error (usage) for values out of range.
  Image tone_mapped(const ToneMap& map) const;

  /// Reads .png, .jpg, .exr, .hdr or .pfm, whatever its name is, as four channels. Throws Error (scene).
  static Image load(const std::filesystem::path& file);
  /// Writes .png, .jpg (8 bits a channel, sRGB), .exr (halves), .hdr or .pfm, by the file's extension; the
  /// file appears whole or not at all. Throws Error: usage for another extension or less than three channels,
  /// io.
  void save(const std::filesystem::path& file) const;
  /// The bytes that save() writes to a file with that extension ("png"). Throws Error (usage).
  std::string encode(const std::string& extension) const;

  struct Impl;
  explicit Image(std::shared_ptr<const Impl> impl) noexcept;  ///< for the library itself
  /// For the library itself.
  const std::shared_ptr<const Impl>& impl() const noexcept { return impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace v0
}  // namespace sundog
