// One picture of a scene.
#pragma once
#include <sundog/devices.h>
#include <sundog/image.h>
#include <sundog/scene.h>

#include <cstdint>
#include <functional>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

namespace sundog {
inline namespace v0 {

/// How far a render is.
struct Progress {
  std::uint64_t pixels_done = 0;   ///< of the frame, or of its pass in hand
  std::uint64_t pixels_total = 0;  ///< that there are to do
  double seconds = 0;              ///< since the devices were opened
};

/// Work-items that a kernel's groups have. None of it changes a bit of the picture.
struct WorkGroup {
  unsigned x = 0;       ///< in a row; 0: the default, or what `sundog tune` found
  unsigned y = 1;       ///< rows, from 1; x * y is at most what the device takes
  bool driver = false;  ///< the driver chooses
};

/// None of these changes a bit of a finished picture.
struct RenderOptions {
  /// Where to render, all at once; empty: the one estimated fastest.
  std::vector<Device> devices{};
  /// Further images: "depth", "normal", "position", "albedo", "object", "material", "geometric_normal", "uv",
  /// "march_steps", "samples", "variance" (of scenes made in passes), "crypto_object", "crypto_material".
  std::vector<std::string> aovs{};
  WorkGroup work_group{};  ///< of the kernels
  int tile = 0;            ///< edge in pixels, 0: chosen by measured speed
  double time_limit = 0;   ///< seconds, after which the film so far is returned; 0: none
  std::stop_token stop{};  ///< a request from any thread: render() returns the film so far
  /// Called by one thread at a time, the caller's or another, some times a second, also before the first
  /// tile is made. What it throws ends the render and is thrown by render().
  std::function<void(const Progress&)> on_progress{};
  /// The picture so far, every `picture_seconds`; as on_progress.
  std::function<void(const Image&)> on_picture{};
  double picture_seconds = 1;  ///< between two calls of on_picture, from 0
};

/// What one device did for a picture.
struct DeviceFigures {
  std::string label{};       ///< Device::label
  std::uint64_t tiles = 0;   ///< that it made
  std::uint64_t pixels = 0;  ///< that it made
  double share = 0;          ///< of the picture's pixels, 0..1
  double busy_seconds = 0;   ///< in which it made tiles
  double kernel_ms = 0;      ///< of all kernels, by the device's clock, or the host's where it has none
  bool retired = false;      ///< it failed too often
  std::vector<std::string> messages{};  ///< its failures, and what it could live with
};

/// What a picture took.
struct Figures {
  std::uint64_t primary = 0;             ///< rays from the camera
  std::uint64_t reflection = 0;          ///< reflected rays
  std::uint64_t refraction = 0;          ///< refracted rays
  std::uint64_t shadow = 0;              ///< rays to lights
  std::uint64_t march_steps = 0;         ///< along distance fields
  std::uint64_t dropped_samples = 0;     ///< that were not finite
  double compile_seconds = 0;            ///< of the scene's tables
  double build_seconds = 0;              ///< of kernels
  double render_seconds = 0;             ///< from the first tile to the last
  bool cached = false;                   ///< no kernel was compiled
  double efficiency = 1;                 ///< work completed divided by the devices' capacity, 0..1
  std::vector<DeviceFigures> devices{};  ///< one a device
};

/// A finished or stopped render. Immutable; copies share the pixels.
class SUNDOG_API Film {
 public:
  Film();  ///< no pixels

  int width() const noexcept;   ///< in pixels
  int height() const noexcept;  ///< in pixels
  /// False: stopped, or out of time; pixels that are missing are 0 in all channels.
  bool complete() const noexcept;
  /// Linear RGBA; alpha is coverage, 0 where only background is seen.
  Image image() const;
  /// The image as `curve`, exposure and white balance of the scene show it.
  Image shown() const;
  /// Of aovs(), with 1 channel (depth, object, material, march_steps, samples), 2 (uv), 4 (the layers
  /// crypto_object00, crypto_object01 and so on of a Cryptomatte) or 3. Throws Error (usage) for another.
  Image aov(const std::string& name) const;
  /// The names that aov() takes.
  std::vector<std::string> aovs() const;
  /// What it took; valid as long as the film.
  const Figures& figures() const noexcept;
  /// What a person would want to know of scene, view and devices, one line each.
  const std::vector<std::string>& warnings() const noexcept;

  /// Writes the picture as `sundog render -o` does: tone mapped and dithered in files of 8 bits, with all
  /// AOVs in an .exr. Throws Error: usage for an extension that is none of Image::save()'s, io.
  void save(const std::filesystem::path& file) const;

  struct Impl;
  explicit Film(std::shared_ptr<const Impl> impl) noexcept;  ///< for the library itself

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Renders and waits. Several threads may render at once. Throws Error: scene; usage for an AOV or device
/// that is none; device when every device failed; build when the kernels build on none; internal for a frame
/// that takes more memory than there is; and what callbacks throw. A stopped render does not wait for a
/// driver that compiles: that thread is owned by the devices, or by the process when none were given.
SUNDOG_API Film render(const Scene& scene, const RenderOptions& options = {});

}  // namespace v0
}  // namespace sundog
