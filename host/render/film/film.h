// Film: the sums of a frame's samples in linear RGBA, and which pixels are finished.
#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/image.h"
#include "render/values/tile.h"
#include "shared/launch.h"
#include "shared/light_parts.h"
#include "shared/types.h"

namespace sundog {

/// float4 a pixel that hold AOVs of first surfaces: what passes ask for, these with a denoiser's features,
/// and all that there are (kernels/entry/aov.cl).
constexpr std::size_t few_aov_vectors = 3, feature_aov_vectors = 5, all_aov_vectors = 7;

/// The float4 of a pixel's AOVs: first those of surfaces, then sums over the samples (shared/launch.h).
struct AovLayout {
  std::size_t surfaces = few_aov_vectors;
  bool mattes = false, light = false;
  bool groups = false;  // the sums of light are those of groups of lights
  std::size_t first_light() const { return surfaces + (mattes ? MATTE_VECTORS : 0); }
  std::size_t sums() const { return (mattes ? MATTE_VECTORS : 0) + (light ? LIGHT_VECTORS : 0); }
  std::size_t vectors() const { return surfaces + sums(); }
  /// Not 0, and another for every layout.
  std::uint32_t code() const {
    return u32(surfaces) | u32(mattes) << 8 | u32(light) << 9 | u32(groups) << 10;
  }
};
constexpr std::size_t most_aov_vectors = all_aov_vectors + MATTE_VECTORS + LIGHT_VECTORS;

struct Color {
  float r = 0, g = 0, b = 0;
};

/// The mean of a pixel's samples, of which their sum and their weight are given; black without samples.
inline Color mean_of(const float4& sum, float weight) {
  const float share = weight > 0 ? 1 / weight : 1;
  return {sum.x * share, sum.y * share, sum.z * share};
}

/// A colour's light, by whose fourth root errors are divided; what is darker counts as nearly black, where
/// nobody sees a relative error.
inline float seen_light(const Color& color) {
  constexpr float darkest = 0.01f;
  return std::max(color.r + color.g + color.b, darkest);
}

/// The values of the pixels of `area`, of a picture that is `width` wide; `each` a pixel.
template <class T>
std::vector<T> cut_pixels(const std::vector<T>& values, int width, const Tile& area, std::size_t each = 1) {
  std::vector<T> cut;
  if (values.empty()) return cut;
  cut.reserve(static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height) * each);
  for (int y = area.y; y < area.y + area.height; ++y) {
    const auto row = values.begin() + (std::ptrdiff_t{y} * width + area.x) * std::ptrdiff_t(each);
    cut.insert(cut.end(), row, row + area.width * std::ptrdiff_t(each));
  }
  return cut;
}

/// Whether each is 0 or 1.
inline bool all_flags(const std::vector<std::uint8_t>& flags) {
  return std::ranges::all_of(flags, [](std::uint8_t flag) { return flag <= 1; });
}

/// The state of a pixel. The film's weights say how many samples count.
enum class PixelState : std::uint8_t { empty, looked_at, sampled, interpolated };

/// A pixel's mean colour and the sum of its squares, for the expected errors of its neighbours. Missing alpha
/// is added to red and taken from green. A vector type, so that neighbours are summed in one operation.
using Seen [[gnu::vector_size(16)]] = float;

/// The arrays that a film needs besides the sum and the weight of each pixel's samples.
struct FilmNeeds {
  AovLayout layout = {};
  bool shows_surfaces = false;  // the layout's vectors
  bool counts_rays = false;
  bool grows = false;          // later passes add samples to earlier ones
  bool keeps_earlier = false;  // of a film that grows: for pixel_errors() and the AOV variance
};

/// width * height pixels, row 0 at the top: those of a frame, or of one pass. An array that is not needed is
/// empty; so are all before the first pass.
struct Film : FilmNeeds {
  int width = 0, height = 0;
  std::vector<float4> sums;        // rgb and coverage
  std::vector<float> weights;      // samples that count
  std::vector<float4> aovs;        // the layout's vectors a pixel
  std::vector<u32> rays;           // of each pixel
  std::vector<std::uint8_t> done;  // 1: the pixel has a sample or more; in a pass, all of the pass
  // Only in a film that grows:
  std::vector<u32> taken;          // samples of each pixel; 0 where it is interpolated
  std::vector<PixelState> states;  // of each pixel
  std::vector<float4> earlier;     // the sums before a pixel's last pass; w = weight
  std::vector<float> moved;        // squares of how far doublings moved it, the last for half
  std::vector<u32> block_rays;     // of each block of 4x4 pixels in a pass with `costs`; empty: not counted
  // Follow from sums, weights, taken and moved:
  std::vector<Seen> seen;
  std::vector<float> moved_by_one;  // `moved`, scaled to one sample; 0 with one
  u32 stage = 0;                    // passes that are complete
  u32 step = 0;                     // of the planner
  std::uint64_t surfaces_seen = 0;  // pixels looked at by a ray of their own, for the surface alone

  Film() = default;
  /// Without pixels, which its first pass brings.
  Film(int width_, int height_, const FilmNeeds& needs) : FilmNeeds(needs), width(width_), height(height_) {}
  /// With pixels that are not done.
  Film(int width, int height, bool with_aovs, AovLayout layout = {});
  /// One that holds what these AOVs want.
  static Film with_aovs(int width, int height, const std::vector<std::string>& names);
  /// Adds pixels that are not done, where it has none.
  void allocate();
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool is_done(const Tile& tile) const;
  /// Puts a finished tile's pixels, row by row, in their places. Spans as long as the tile (aovs: the
  /// layout's vectors times; they and the rays may be empty). Returns how many of them were not done before.
  std::uint64_t put(const Tile& tile, std::span<const float4> tile_sums, std::span<const float> tile_weights,
                    std::span<const float4> tile_aovs, std::span<const u32> tile_rays = {});
  /// A part of the film, which `area` lies in. It does not grow.
  Film cut(const Tile& area) const;
  /// The mean of the samples; alpha, if there are 4 channels, is coverage; pixels that are not done are 0.
  Image develop(int channels = 4) const;
  /// The named AOV (one of aov_names()); pixels that are not done are 0. Parts of light sum to develop()'s
  /// colours, to the bit (fit_sum()).
  Image develop_aov(const std::string& name) const;
  /// A pixel's mean with the light of each group (layout.groups) multiplied by its factor: first that of no
  /// group, then the groups in order; those left out by 1.
  Color balanced_mean(std::size_t pixel, std::span<const glm::vec3> factors) const;
};

/// The AOVs `render` can make.
const std::vector<std::string>& aov_names();

/// The arrays that a film needs for these AOVs.
FilmNeeds film_needs(const std::vector<std::string>& names);

/// Whether they need `aovs` of a film. The others come of the samples' sums alone.
bool show_surfaces(const std::vector<std::string>& names);

/// Floats of a pixel of an AOV's image.
std::size_t aov_channels(const std::string& name);

/// The layout of a pixel's vectors for these AOVs.
AovLayout aov_layout(const std::vector<std::string>& names);

/// The AOVs that a denoiser takes: albedo and normal as the pixels' samples see them.
constexpr const char *feature_albedo = "denoise_albedo", *feature_normal = "denoise_normal";

/// The pixels' ways to the next frame (render/film/motion.h).
constexpr const char* motion_aov = "motion";

/// Whether they are among these AOVs.
bool shows_features(const std::vector<std::string>& names);

/// Whether it is a part of a pixel's light, which only the path tracer keeps apart.
bool is_light(const std::string& aov);

/// Whether they want the rays of each pixel to be counted.
bool counts_rays(const std::vector<std::string>& names);

/// Bytes of a pixel of a film with these AOVs.
std::size_t film_bytes(const std::vector<std::string>& names);

}  // namespace sundog
