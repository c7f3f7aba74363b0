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

/// float4 vectors per pixel for AOVs of first surfaces: those that passes request, with a denoiser's
/// features, and all of them (kernels/entry/aov.cl).
constexpr std::size_t few_aov_vectors = 3, feature_aov_vectors = 5, all_aov_vectors = 7;

/// A pixel's AOV vectors (float4): first the surfaces, then sums over the samples (shared/launch.h).
struct AovLayout {
  std::size_t surfaces = few_aov_vectors;
  bool mattes = false, light = false;
  bool groups = false;  // the sums of light are per light group
  std::size_t first_light() const { return surfaces + (mattes ? MATTE_VECTORS : 0); }
  std::size_t sums() const { return (mattes ? MATTE_VECTORS : 0) + (light ? LIGHT_VECTORS : 0); }
  std::size_t vectors() const { return surfaces + sums(); }
  /// Nonzero and different for every layout.
  std::uint32_t code() const {
    return u32(surfaces) | u32(mattes) << 8 | u32(light) << 9 | u32(groups) << 10;
  }
};
constexpr std::size_t most_aov_vectors = all_aov_vectors + MATTE_VECTORS + LIGHT_VECTORS;

struct Color {
  float r = 0, g = 0, b = 0;
};

/// The mean of a pixel's samples from their sum and weight; black without samples.
inline Color mean_of(const float4& sum, float weight) {
  const float share = weight > 0 ? 1 / weight : 1;
  return {sum.x * share, sum.y * share, sum.z * share};
}

/// The light of a colour; errors are divided by its fourth root. Clamped from below, because nobody sees a
/// relative error in near-black.
inline float seen_light(const Color& color) {
  constexpr float darkest = 0.01f;
  return std::max(color.r + color.g + color.b, darkest);
}

/// Copies the pixels of `area` from an image `width` pixels wide with `each` values per pixel.
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

/// Whether every flag is 0 or 1.
inline bool all_flags(const std::vector<std::uint8_t>& flags) {
  return std::ranges::all_of(flags, [](std::uint8_t flag) { return flag <= 1; });
}

/// The state of a pixel. The film's weights say how many samples count.
enum class PixelState : std::uint8_t { empty, looked_at, sampled, interpolated };

/// A pixel's mean colour and the sum of its squares, from which its neighbours' errors are estimated. Missing
/// alpha is added to red and subtracted from green. A vector type, so that neighbours are summed in one
/// operation.
using Seen [[gnu::vector_size(16)]] = float;

/// The arrays that a film needs besides the sum and weight of each pixel's samples.
struct FilmNeeds {
  AovLayout layout = {};
  bool shows_surfaces = false;  // needs AOV vectors
  bool counts_rays = false;
  bool grows = false;          // later passes add samples to earlier ones
  bool keeps_earlier = false;  // a growing film keeps earlier sums for pixel_errors() and the AOV variance
};

/// The samples of a film's or a tile's pixels. Arrays that are not needed are empty.
struct Samples {
  std::vector<float4> sums;    // rgb and coverage
  std::vector<float> weights;  // samples that count
  std::vector<float4> aovs;    // AovLayout::vectors() per pixel
  std::vector<u32> rays;       // rays per pixel
};

/// Calls visit(array of each of `all`) for each array.
template <class Visit, class... SamplesOf>
void visit_samples(const Visit& visit, SamplesOf&... all) {
  visit(all.sums...), visit(all.weights...), visit(all.aovs...), visit(all.rays...);
}

/// width * height pixels, row 0 at the top, of a frame or of one pass. Before the first pass all arrays are
/// empty.
struct Film : FilmNeeds, Samples {
  int width = 0, height = 0;
  std::vector<std::uint8_t> done;  // 1: the pixel has a sample; in a pass, all samples of the pass
  // Only in a growing film:
  std::vector<u32> taken;          // samples per pixel; 0 if interpolated
  std::vector<PixelState> states;  // one per pixel
  std::vector<float4> earlier;     // the sums before a pixel's last pass; w = weight
  std::vector<float> moved;        // mean squared movement over doublings; the last has weight 1/2
  std::vector<u32> block_rays;     // rays per block of 4x4 pixels in a pass with `costs`; empty: not counted
  // Derived from sums, weights, taken and moved:
  std::vector<Seen> seen;
  std::vector<float> moved_by_one;  // `moved`, scaled to one sample; 0 with one sample
  u32 stage = 0;                    // complete passes
  u32 step = 0;                     // the planner's step
  std::uint64_t surfaces_seen = 0;  // pixels that got a ray only to find their surface

  Film() = default;
  /// Without pixels; the first pass brings them.
  Film(int width_, int height_, const FilmNeeds& needs) : FilmNeeds(needs), width(width_), height(height_) {}
  /// With pixels that are not done.
  Film(int width, int height, bool with_aovs, AovLayout layout = {});
  /// With the arrays that these AOVs need.
  static Film with_aovs(int width, int height, const std::vector<std::string>& names);
  /// Adds the missing arrays, with pixels that are not done.
  void allocate();
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool is_done(const Tile& tile) const;
  /// Copies a finished tile into the film, row by row. Returns how many of its pixels were not done before.
  std::uint64_t put(const Tile& tile, const Samples& made);
  /// The pixels of `area`, which lies in the film, as a film that does not grow.
  Film cut(const Tile& area) const;
  /// The mean of the samples; with 4 channels, alpha is coverage. Pixels that are not done are 0.
  Image develop(int channels = 4) const;
  /// The named AOV (one of aov_names()); pixels that are not done are 0. The parts of light sum to
  /// develop()'s colours bit for bit (fit_sum()). Throws UsageError if the film lacks the AOV.
  Image develop_aov(const std::string& name) const;
  /// A pixel's mean with the light of each group (layout.groups) multiplied by its factor: first the light in
  /// no group, then the groups in order. Missing factors are 1.
  Color balanced_mean(std::size_t pixel, std::span<const glm::vec3> factors) const;
};

/// All AOVs that `render` can produce.
const std::vector<std::string>& aov_names();

/// The arrays that a film needs for these AOVs.
FilmNeeds film_needs(const std::vector<std::string>& names);

/// Whether any of these AOVs needs Film::aovs; the others are computed from the samples' sums alone.
bool show_surfaces(const std::vector<std::string>& names);

/// Floats per pixel in an AOV's image.
std::size_t aov_channels(const std::string& name);

/// The layout of a pixel's vectors for these AOVs.
AovLayout aov_layout(const std::vector<std::string>& names);

/// The AOVs that a denoiser takes: albedo and normal averaged over the pixels' samples.
constexpr const char *feature_albedo = "denoise_albedo", *feature_normal = "denoise_normal";

/// Each pixel's motion to the next frame (render/film/motion.h).
constexpr const char* motion_aov = "motion";

/// Whether the denoiser's features are among these AOVs.
bool shows_features(const std::vector<std::string>& names);

/// Whether the AOV is a part of a pixel's light, which only the path tracer separates.
bool is_light(const std::string& aov);

/// Whether any of these AOVs needs ray counts per pixel.
bool counts_rays(const std::vector<std::string>& names);

/// Bytes per pixel of a film with these AOVs.
std::size_t film_bytes(const std::vector<std::string>& names);

}  // namespace sundog
