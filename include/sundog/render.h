// Renders one picture of a scene.
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

/// Progress of a render.
struct Progress {
  std::uint64_t pixels_done = 0;   ///< of the frame or of the current pass
  std::uint64_t pixels_total = 0;  ///< of the frame or of the current pass
  double seconds = 0;              ///< since the devices were opened
};

/// The work-group size of the kernels. It does not change a bit of the picture.
struct WorkGroup {
  unsigned x = 0;       ///< work-items in a row; 0: the default, or what `sundog tune` found
  unsigned y = 1;       ///< rows, from 1; x * y may not exceed the device's limit
  bool driver = false;  ///< let the driver choose
};

/// Options of a render. None changes a bit of a finished picture.
struct RenderOptions {
  /// Devices to render on together; empty: the device estimated fastest.
  std::vector<Device> devices{};
  /// Additional images: "depth", "normal", "position", "albedo", "object", "material", "geometric_normal",
  /// "uv", "march_steps", "samples", "variance" (scenes rendered in passes), "crypto_object",
  /// "crypto_material"; with the path integrator, the components that sum to the image: "diffuse_direct",
  /// "diffuse_indirect",
  /// "glossy_direct", "glossy_indirect", "transmission_direct", "transmission_indirect", "volume_direct",
  /// "volume_indirect", "emission", "sky" (docs/guide/aovs.md).
  std::vector<std::string> aovs{};
  WorkGroup work_group{};  ///< work-group size of the kernels
  int tile = 0;            ///< edge in pixels, 0: chosen by measured speed
  double time_limit = 0;   ///< seconds after which render() returns the film so far; 0: none
  std::stop_token stop{};  ///< a stop request from any thread makes render() return the film so far
  /// Called a few times a second by one thread at a time, not always the caller's, and once before the first
  /// tile. An exception that it throws ends the render and leaves render().
  std::function<void(const Progress&)> on_progress{};
  /// Receives the picture so far, every `picture_seconds`; threads and exceptions as for on_progress.
  std::function<void(const Image&)> on_picture{};
  double picture_seconds = 1;  ///< interval between calls of on_picture, at least 0
};

/// One device's part in a render.
struct DeviceFigures {
  std::string label{};       ///< Device::label
  std::uint64_t tiles = 0;   ///< tiles that it rendered
  std::uint64_t pixels = 0;  ///< pixels that it rendered
  double share = 0;          ///< fraction of the picture's pixels, 0..1
  double busy_seconds = 0;   ///< time spent rendering tiles
  double kernel_ms = 0;      ///< time in all kernels, by the device's clock, or the host's if it has none
  bool retired = false;      ///< it failed too often or hangs, and gets no more tiles
  std::vector<std::string> messages{};  ///< its failures and warnings
};

/// Statistics of a render.
struct Figures {
  std::uint64_t primary = 0;             ///< rays from the camera
  std::uint64_t reflection = 0;          ///< reflected rays
  std::uint64_t refraction = 0;          ///< refracted rays
  std::uint64_t shadow = 0;              ///< rays to lights
  std::uint64_t march_steps = 0;         ///< steps along distance fields
  std::uint64_t dropped_samples = 0;     ///< samples that were not finite
  double compile_seconds = 0;            ///< time to compile the scene's tables
  double build_seconds = 0;              ///< time to build kernels
  double render_seconds = 0;             ///< from the first tile to the last
  bool cached = false;                   ///< no kernel had to be compiled
  double efficiency = 1;                 ///< work completed divided by the devices' capacity, 0..1
  std::vector<DeviceFigures> devices{};  ///< one per device
};

/// A finished or stopped render. Immutable; copies share the pixels.
class SUNDOG_API Film {
 public:
  Film();  ///< no pixels

  int width() const noexcept;   ///< in pixels
  int height() const noexcept;  ///< in pixels
  /// False if the render was stopped or ran out of time; missing pixels are 0 in all channels.
  bool complete() const noexcept;
  /// Linear RGBA; alpha is coverage, 0 where only the background shows.
  Image image() const;
  /// The image after the scene's tone curve, exposure and white balance.
  Image shown() const;
  /// Returns one of aovs(), with 1 channel (depth, object, material, march_steps, samples), 2 (uv), 4
  /// (Cryptomatte layers: crypto_object00 and so on) or 3 (others). Throws Error (usage) for unknown names.
  Image aov(const std::string& name) const;
  /// Names that aov() accepts.
  std::vector<std::string> aovs() const;
  /// Statistics; valid as long as the film lives.
  const Figures& figures() const noexcept;
  /// Warnings about the scene, the view and the devices, one line each.
  const std::vector<std::string>& warnings() const noexcept;

  /// Writes the picture as `sundog render -o` does: 8-bit files tone mapped and dithered, an .exr with all
  /// AOVs. Throws Error: usage for an extension that Image::save() does not accept, io.
  void save(const std::filesystem::path& file) const;

  struct Impl;
  explicit Film(std::shared_ptr<const Impl> impl) noexcept;  ///< internal

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Renders and waits. Thread-safe. Throws Error: scene; usage for an unknown AOV or an invalid device; device
/// when every device failed; build when the kernels build on no device; internal for a frame that exceeds the
/// memory. Exceptions of callbacks pass through. A stopped render does not wait for a driver that compiles:
/// the devices own that thread, or the process if no devices were given.
SUNDOG_API Film render(const Scene& scene, const RenderOptions& options = {});

}  // namespace v0
}  // namespace sundog
