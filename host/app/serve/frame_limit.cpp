#include "app/serve/frame_limit.h"

#include <fmt/format.h>

#include "base/error.h"

namespace sundog {
namespace {

constexpr int most_shown_edge = 65500;  // of a JPEG

/// Bytes of a session's frame per pixel: film, picture, and the copy that is sent to pages. Measured from
/// 2048x2048 to 4096x4096.
constexpr std::uint64_t bytes_a_shown_pixel = 130;

double gigabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e9; }

}  // namespace

void check_frame(const SceneDescription& scene, std::int64_t shown, std::optional<std::uint64_t> available) {
  const int width = scene.image.width, height = scene.image.height;
  const auto refuse = [&](bool wide, const std::string& why) {
    throw SceneError(scene.file.string(), wide ? "/image/width" : "/image/height",
                     fmt::format("{}; `sundog render` renders it", why));
  };
  if (width > most_shown_edge || height > most_shown_edge)
    refuse(width > most_shown_edge, fmt::format("the viewer shows at most {} pixels an edge, found {}",
                                                most_shown_edge, std::max(width, height)));
  const std::int64_t pixels = std::int64_t{width} * height;
  const std::uint64_t bytes = bytes_a_shown_pixel * static_cast<std::uint64_t>(pixels);
  if (pixels > shown && available && bytes > *available / 4)
    refuse(
        width >= height,
        fmt::format(
            "{}x{} pixels take {:.1f} GB in the viewer, more than a quarter of the {:.1f} GB that are free",
            width, height, gigabytes(bytes), gigabytes(*available)));
}

}  // namespace sundog
