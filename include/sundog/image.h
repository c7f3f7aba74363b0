// Images in memory, and reading and writing image files.
#pragma once
#include <sundog/version.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace sundog {
inline namespace v0 {

/// Maps linear colours to display colours, for files of 8 bits per channel.
struct ToneMap {
  std::string curve = "none";  ///< "none", "reinhard", "aces", "agx"
  double exposure = 0;         ///< in stops, -32..32: each stop doubles the brightness
  double white_balance = 0;    ///< kelvin, 1667..25000: light of this temperature turns white; 0: unchanged
};

/// Linear floats, immutable. Copies share the pixels, so copying is cheap and thread-safe.
class SUNDOG_API Image {
 public:
  /// An empty image.
  Image();
  /// Copies `pixels`: width * height * channels floats, row 0 at the top, the channels of a pixel adjacent.
  /// Channels: 1, 3 or 4 (the fourth is coverage). Throws Error (usage) if the length differs.
  Image(int width, int height, int channels, std::span<const float> pixels);

  int width() const noexcept;     ///< in pixels; 0: empty
  int height() const noexcept;    ///< in pixels; 0: empty
  int channels() const noexcept;  ///< floats per pixel: 1, 3 or 4
  /// width() * height() * channels() floats, row 0 at the top. Valid while any Image shares them.
  std::span<const float> pixels() const noexcept;

  /// Returns the tone-mapped image, still linear. Throws Error (usage) for values out of range.
  Image tone_mapped(const ToneMap& map) const;

  /// Reads .png, .jpg, .exr, .hdr or .pfm, recognised by content, as four channels. Throws Error (scene).
  static Image load(const std::filesystem::path& file);
  /// Writes .png, .jpg (8 bits per channel, sRGB), .exr (half floats), .hdr or .pfm, by the file's extension.
  /// The write is atomic. Throws Error: usage for another extension or fewer than three channels, io.
  void save(const std::filesystem::path& file) const;
  /// Returns the bytes that save() writes for this extension ("png"). Throws Error (usage).
  std::string encode(const std::string& extension) const;

  struct Impl;
  explicit Image(std::shared_ptr<const Impl> impl) noexcept;  ///< internal
  /// Internal.
  const std::shared_ptr<const Impl>& impl() const noexcept { return impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace v0
}  // namespace sundog
