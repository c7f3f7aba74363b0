// Sums the bytes per pixel of film, AOVs, passes, denoiser and encoders.
#include "render/film/frame_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/file.h"
#include "base/image_io.h"
#include "base/memory.h"
#include "render/film/film.h"

namespace sundog {
namespace {

// Sums, weight and done flag; the AOV vectors that passes request.
constexpr std::uint64_t own_bytes = 16 + 4 + 1, film_aov_bytes = 48;

/// Bytes per pixel of the film's AOVs.
std::uint64_t film_aovs(const FrameOutput& output) { return film_bytes(output.aovs) - film_bytes({}); }

/// Bytes per pixel that an encoder allocates besides the image: converted samples, and the file, assumed to
/// be incompressible noise. A growing buffer counts twice.
std::uint64_t encoder_bytes(const FrameOutput& output, std::uint64_t aovs) {
  const std::string extension = lower_extension(output.file);
  if (output.file.empty()) return 0;
  if (!drops_alpha(output.file)) return 16 + aovs;
  if (is_png(output.file)) return static_cast<std::uint64_t>(output.channels * output.bits / 8 + 1);
  if (extension == ".hdr") return 12 + 2 * 4;
  return extension == ".pfm" ? 12 : 3 + 2 * 3;
}

// Further bytes per pixel of a frame in passes: the film of all passes, surfaces, states, colours; between
// passes the expected errors and the list of pixels that get more samples.
constexpr std::uint64_t passes_bytes = own_bytes + film_aov_bytes + 4 + 1 + 16 + 4 + 20 + 8 + 8;

// Bytes per pixel of tiles in flight, on the device and off it, including memory that the allocator retains.
// Measured with frames that are drawn so fast that tiles are large.
constexpr std::uint64_t tile_bytes = 10;

// Bytes per pixel of the denoised colours, albedo and normal; of alpha as its own picture, with its denoised
// copy.
constexpr std::uint64_t denoised_bytes = 36, denoised_alpha_bytes = 24;

// Bytes per pixel that Open Image Denoise 2.5 needs for its network's layers with a small picture.
constexpr std::uint64_t denoiser_bytes = 600;

}  // namespace

std::uint64_t bytes_a_pixel(const FrameOutput& output) {
  const std::uint64_t film = own_bytes + film_aovs(output);
  std::uint64_t aovs = 0;
  for (const std::string& name : output.aovs) aovs += 4 * aov_channels(name);
  const auto channels = static_cast<std::uint64_t>(output.channels), image = 4 * channels;
  const bool part = lower_extension(output.file) == ".part";
  const std::uint64_t encoder = encoder_bytes(output, aovs);
  const std::uint64_t at_end =
      film + (part ? film
                   : image + aovs + encoder +
                         (output.denoise ? denoised_bytes + (channels == 4 ? denoised_alpha_bytes : 0) : 0));
  return tile_bytes + (output.passes ? passes_bytes + film_aovs(output) : 0) +
         (output.checkpoints ? std::max(3 * film, at_end) : at_end);
}

void check_frame_memory(int width, int height, const FrameOutput& output) {
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const auto edge = [&](int whole) { return static_cast<std::uint64_t>(std::min(output.tile, whole)); };
  const std::uint64_t film = own_bytes + film_aovs(output);
  const std::uint64_t wanted = pixels * bytes_a_pixel(output) + 2 * film * edge(width) * edge(height) +
                               (output.denoise ? std::min(denoiser_bytes * pixels, most_denoiser_bytes) : 0);
  const auto there = available_memory();
  if (!there || wanted <= *there) return;
  throw std::runtime_error(fmt::format(
      "a frame of {}x{} pixels takes {:.1f} GiB of memory ({} bytes a pixel), and {:.1f} GiB are available: "
      "make it smaller, or render it on a machine with more",
      width, height, static_cast<double>(wanted) / (1 << 30), bytes_a_pixel(output),
      static_cast<double>(*there) / (1 << 30)));
}

}  // namespace sundog
