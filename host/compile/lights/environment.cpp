// Draws gradients, skies and halos as pictures, sums luminance to cumulative shares of rows and cells with
// cutpoints, and adds the sun as a directional light.
#include "compile/lights/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "compile/halo/halo_map.h"
#include "compile/lights/lights.h"
#include "compile/sky/sky.h"
#include "compile/sky/twilight.h"
#include "scene/pack.h"

namespace sundog {
namespace {

using std::numbers::pi;
constexpr u32 most_columns = 2048, most_rows = 1024;  // cells
constexpr int gradient_rows = 256, sky_columns = 512, sky_rows = 256;

/// Columns: right, up and ahead, with the picture's rotation.
glm::dmat3 axes_of(const EnvironmentDescription& e) {
  const dvec3 up = glm::normalize(e.up);
  // Right and ahead stay as close to +x and -z as in an upright picture.
  dvec3 right = glm::cross(dvec3(0, 0, -1), up);
  if (glm::length(right) < 1e-6) right = dvec3(1, 0, 0);
  right = glm::normalize(right);
  const dvec3 ahead = glm::cross(up, right);
  const double angle = e.rotate * pi / 180, c = std::cos(angle), s = std::sin(angle);
  return {c * right + s * ahead, up, c * ahead - s * right};
}

struct Picture {
  u32 width = 0, height = 0;
  std::vector<float4> pixels;
};

Picture picture_of_image(const EnvironmentDescription& e) {
  Picture picture{static_cast<u32>(e.picture.width), static_cast<u32>(e.picture.height), {}};
  const dvec3 factor = e.color * e.intensity;
  for (int y = 0; y < e.picture.height; ++y)
    for (int x = 0; x < e.picture.width; ++x) {
      const float* p = e.picture.pixel(x, y);
      picture.pixels.push_back(pack(glm::max(dvec3(p[0], p[1], p[2]), dvec3(0)) * factor));
    }
  return picture;
}

Picture picture_of_gradient(const EnvironmentDescription& e) {
  Picture picture{1, gradient_rows, {}};
  for (int y = 0; y < gradient_rows; ++y) {
    const double share = 0.5 + 0.5 * std::cos(pi * (y + 0.5) / gradient_rows);
    picture.pixels.push_back(pack(glm::mix(e.bottom, e.top, share) * e.color * e.intensity));
  }
  return picture;
}

/// Direction to the sun in the environment's axes: x right, y up, z ahead.
dvec3 sun_in_axes(const EnvironmentDescription& e) {
  const double height = e.sun_altitude * pi / 180, azimuth = e.sun_azimuth * pi / 180;
  return {std::cos(height) * std::sin(azimuth), std::sin(height), std::cos(height) * std::cos(azimuth)};
}

/// The day's sky; after sunset, the sky at sunset.
Sky sky_of(const EnvironmentDescription& e) {
  return {e.turbidity, std::max(0.0, e.sun_altitude) * pi / 180};
}

/// The fraction of sunlight that crystals transmit to the ground.
double sun_share(const EnvironmentDescription& e) {
  if (e.type != EnvironmentType::halo) return 1;
  return std::exp(-e.halo.optical_depth / std::max(sun_in_axes(e).y, 0.01));
}

/// A picture of `light_along(zenith, azimuth)` above the horizon, and of the ground below. The row below the
/// horizon repeats the row above it, because interpolation with the ground would darken the sky's rim.
template <class Light>
Picture picture_of_day(const EnvironmentDescription& e, int columns, int rows, const Light& light_along) {
  const dvec3 factor = e.color * e.intensity;
  Picture picture{u32(columns), u32(rows), std::vector<float4>(std::size_t(columns) * std::size_t(rows))};
  dvec3 level(0);  // irradiance on horizontal ground, over pi
  for (int y = 0; y < rows / 2; ++y)
    for (int x = 0; x < columns; ++x) {
      const double zenith = pi * (y + 0.5) / rows, azimuth = 2 * pi * (x + 0.5) / columns - pi;
      const dvec3 light = light_along(zenith, azimuth);
      level += light * (std::cos(zenith) * std::sin(zenith) * 2 * pi / (columns * double(rows)));
      picture.pixels[std::size_t(y) * std::size_t(columns) + std::size_t(x)] = pack(light * factor);
    }
  level += sky_of(e).sun_irradiance() * (std::max(0.0, sun_in_axes(e).y) * sun_share(e));
  const auto horizon = picture.pixels.begin() + std::ptrdiff_t{rows / 2} * columns;
  std::copy(horizon - columns, horizon, horizon);
  std::fill(horizon + columns, picture.pixels.end(), pack(level * e.ground * factor));
  return picture;
}

/// The twilight sky and its weight in a low sun's sky, because Preetham's model has no twilight.
struct Dusk {
  Twilight light;
  double share;
};

std::optional<Dusk> dusk_of(const EnvironmentDescription& e) {
  constexpr double day_begins = 4;  // degrees
  if (e.sun_altitude >= day_begins) return {};
  return Dusk{{e.turbidity, e.sun_altitude * pi / 180}, std::min(1.0, 1 - e.sun_altitude / day_begins)};
}

Picture picture_of_sky(const EnvironmentDescription& e) {
  const dvec3 sun = sun_in_axes(e);
  const std::optional<Dusk> dusk = dusk_of(e);
  return picture_of_day(e, sky_columns, sky_rows, [&, sky = sky_of(e)](double zenith, double azimuth) {
    if (dusk && dusk->share == 1) return dusk->light.radiance(zenith, azimuth - e.sun_azimuth * pi / 180);
    const dvec3 d(std::sin(zenith) * std::sin(azimuth), std::cos(zenith),
                  std::sin(zenith) * std::cos(azimuth));
    const dvec3 day = sky.radiance(zenith, std::acos(std::clamp(glm::dot(d, sun), -1.0, 1.0)));
    if (!dusk) return day;
    const dvec3 least(1e-4), late = dusk->light.radiance(zenith, azimuth - e.sun_azimuth * pi / 180);
    return glm::pow(glm::max(day, least), dvec3(1 - dusk->share)) * glm::pow(late, dvec3(dusk->share));
  });
}

/// The sky behind the crystals is smooth, so it is interpolated from a coarse picture.
Picture picture_of_halo(const EnvironmentDescription& e, const HaloMap& map) {
  EnvironmentDescription plain = e;
  plain.color = dvec3(1);
  plain.intensity = 1;
  const Picture behind = picture_of_sky(plain);
  const dvec3 sun = sun_in_axes(e), irradiance = pi * sky_of(e).sun_irradiance();
  const auto sky_along = [&](double zenith, double azimuth) {
    const double across = (azimuth / (2 * pi) + 0.5) * sky_columns - 0.5, left = std::floor(across);
    const double down = std::min(zenith / pi * sky_rows - 0.5, 0.5 * sky_rows - 1), top = std::floor(down);
    dvec3 light(0);
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const int row = std::clamp(int(top) + j, 0, sky_rows / 2 - 1);
        const int column = (int(left) + i + sky_columns) % sky_columns;
        const float4& p = behind.pixels[std::size_t(row) * sky_columns + std::size_t(column)];
        light += (i ? across - left : 1 - across + left) * (j ? down - top : 1 - down + top) *
                 dvec3(p.x, p.y, p.z);
      }
    return light;
  };
  return picture_of_day(e, 2 * e.halo.cells, e.halo.cells, [&](double zenith, double azimuth) {
    const double turn = azimuth - e.sun_azimuth * pi / 180, side = std::sin(zenith), up = std::cos(zenith);
    const dvec3 turned = halo_radiance(map, {side * std::cos(turn), side * std::sin(turn), up});
    return glm::max(
        sky_along(zenith, azimuth) + irradiance * turned * halo_depth(e.halo.optical_depth, sun.y, up),
        dvec3(0));
  });
}

/// The luminance (w) of a pixel; columns wrap around, rows are clamped.
double luminance_at(const Picture& picture, std::ptrdiff_t x, std::ptrdiff_t y) {
  const std::ptrdiff_t width = picture.width, height = picture.height;
  const std::ptrdiff_t row = std::clamp<std::ptrdiff_t>(y, 0, height - 1), column = (x + width) % width;
  return double(picture.pixels[static_cast<std::size_t>(row * width + column)].w);
}

/// Mean luminance of the interpolated picture over a pixel's square.
double light_of_pixel(const Picture& picture, u32 x, u32 y) {
  constexpr std::array share{0.125, 0.75, 0.125};  // weights of a pixel and its neighbours along an axis
  double sum = 0;
  for (u32 j = 0; j < 3; ++j)
    for (u32 i = 0; i < 3; ++i)
      sum +=
          share[i] * share[j] * luminance_at(picture, std::ptrdiff_t{x} + i - 1, std::ptrdiff_t{y} + j - 1);
  return sum;
}

/// Mean luminance over a cell between four pixel centres, of which pixel (x, y) is the lower right.
double light_between_pixels(const Picture& picture, u32 x, u32 y) {
  double sum = 0;
  for (const int j : {-1, 0})
    for (const int i : {-1, 0})
      sum += luminance_at(picture, std::ptrdiff_t{x} + i, std::ptrdiff_t{y} + j) / 4;
  return sum;
}

/// Appends the normalised cumulative sums; uniform ones if there is no light. Returns the total.
double append_shares(std::span<const double> light, std::vector<float>& shares) {
  double whole = 0, sum = 0;
  for (const double value : light) whole += value;
  for (std::size_t i = 0; i < light.size(); ++i) {
    shares.push_back(static_cast<float>(whole > 0 ? sum / whole : double(i) / double(light.size())));
    sum += light[i];
  }
  shares.push_back(1);
  return whole;
}

/// Pixels per cell along an axis.
u32 pixels_a_cell(u32 pixels, u32 most) {
  u32 each = 1;
  while (pixels / each > most || pixels % each != 0) ++each;
  return each;
}

/// Whether sampling cells lie between four pixel centres, where light is interpolated; this matters near a
/// sun of a few pixels. Computed skies are smooth.
bool are_cells_between_pixels(const Picture& picture, EnvironmentType type) {
  const bool dark = std::ranges::all_of(picture.pixels, [](const float4& pixel) { return pixel.w == 0; });
  return type == EnvironmentType::image && !dark && picture.width <= most_columns &&
         picture.height <= most_rows;
}

/// Advances `step` to the last step of cumulative sums that begins at or before u.
void step_to(std::span<const float> sums, double u, std::size_t& step) {
  while (step + 2 < sums.size() && double(sums[step + 1]) <= u) ++step;
}

/// The cutpoint words of cumulative sums (shared/environment.h). A device may round across a word's border,
/// so words reach slightly further.
void append_cutpoints(std::span<const float> sums, std::vector<u32>& cutpoints) {
  const u32 words = CUTPOINTS_OF(static_cast<u32>(sums.size() - 1));
  const double count = words, slack = 1e-6, below_one = 1 - 0x1p-24;
  std::size_t first = 0, last = 0;
  for (double k = 0; k < count; ++k) {
    step_to(sums, k / count * (1 - slack), first);
    step_to(sums, std::min((k + 1) / count * (1 + slack), below_one), last);
    cutpoints.push_back(static_cast<u32>(first | last << CUTPOINT_SHIFT));
  }
}

/// Sampling probabilities of cells, row by row.
struct CellShares {
  std::vector<double> rows;  // light per row
  std::vector<float> sums;   // cumulative sums of each row's cells
  std::vector<u32> words;    // their cutpoints
};

void append_row(std::span<const double> light, CellShares& cells) {
  std::vector<float> sums;
  cells.rows.push_back(append_shares(light, sums));
  append_cutpoints(sums, cells.words);
  cells.sums.insert(cells.sums.end(), sums.begin(), sums.end());
}

/// Cells of whole pixels. `facts`: see shared/environment.h.
CellShares shares_of_pixels(const Picture& picture, Environment& e, std::vector<float>& facts) {
  const u32 across = pixels_a_cell(picture.width, most_columns),
            down = pixels_a_cell(picture.height, most_rows);
  e.columns = picture.width / across;
  e.rows = picture.height / down;
  CellShares cells;
  for (u32 row = 0; row < e.rows; ++row) {
    std::vector<double> light(e.columns);
    for (u32 y = row * down; y < (row + 1) * down; ++y) {
      const double angle = std::cos(pi * y / picture.height) - std::cos(pi * (y + 1) / picture.height);
      for (u32 x = 0; x < picture.width; ++x) light[x / across] += angle * light_of_pixel(picture, x, y);
    }
    append_row(light, cells);
  }
  for (u32 row = 0; row <= e.rows; ++row)
    facts.push_back(static_cast<float>(std::cos(pi * double(row) / double(e.rows))));
  return cells;
}

/// Cells between pixel centres: one more row than the picture; the first and last are half as high.
CellShares shares_between_pixels(const Picture& picture, Environment& e, std::vector<float>& facts) {
  e.columns = picture.width;
  e.rows = picture.height + 1;
  CellShares cells;
  std::vector<double> evenness;  // the solid angle of a row relative to its share of the picture
  double whole = 0;
  for (u32 row = 0; row < e.rows; ++row) {
    const double top = std::max(row - 0.5, 0.0) / picture.height,
                 bottom = std::min((row + 0.5) / picture.height, 1.0);
    const double angle = std::cos(pi * top) - std::cos(pi * bottom);
    std::vector<double> light(e.columns);
    for (u32 x = 0; x < e.columns; ++x) light[x] = angle * light_between_pixels(picture, x, row);
    append_row(light, cells);
    evenness.push_back(angle / (bottom - top));
    whole += cells.rows.back();
  }
  const double cell = 2 * pi * pi / e.columns;  // width times height in the picture
  for (const double even : evenness) facts.push_back(static_cast<float>(even / (cell * whole)));
  facts.push_back(0);
  return cells;
}

void add_shares(const Picture& picture, Environment& e, Lights& out) {
  std::vector<float>& shares = out.environment_shares.edit();
  const CellShares cells = e.up.w == CELLS_BETWEEN_PIXELS ? shares_between_pixels(picture, e, shares)
                                                          : shares_of_pixels(picture, e, shares);
  std::vector<float> sums;
  append_shares(cells.rows, sums);
  shares.insert(shares.end(), sums.begin(), sums.end());
  shares.insert(shares.end(), cells.sums.begin(), cells.sums.end());
  shares.insert(shares.end(), 16, 1);  // kernels read several at once
  std::vector<u32>& cutpoints = out.environment_cutpoints.edit();
  append_cutpoints(sums, cutpoints);
  cutpoints.insert(cutpoints.end(), cells.words.begin(), cells.words.end());
}

void add_sun(const LightInputs& in, const glm::dmat3& axes, Lights& out) {
  const EnvironmentDescription& e = *in.environment;
  if (e.sun_size <= 0 || e.sun_altitude < 0) return;
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = -(axes * sun_in_axes(e));
  sun.color = sky_of(e).sun_irradiance() * e.color * sun_share(e);
  sun.intensity = e.intensity;
  sun.angle = e.sun_size;
  sun.samples = e.samples;
  sun.visible = e.visible;
  sun.hidden = e.hidden;
  add_light(in, sun, "/environment/sun", out);
}

}  // namespace

void add_environment(const LightInputs& in, Lights& out) {
  if (!in.environment || in.environment->type == EnvironmentType::none) return;
  const EnvironmentDescription& e = *in.environment;
  const HaloMap* halo = in.halo.value ? in.halo->get() : nullptr;
  Picture picture = e.type == EnvironmentType::image          ? picture_of_image(e)
                    : e.type == EnvironmentType::gradient     ? picture_of_gradient(e)
                    : e.type == EnvironmentType::halo && halo ? picture_of_halo(e, *halo)
                                                              : picture_of_sky(e);
  const glm::dmat3 axes = axes_of(e);
  Environment packed{};
  packed.right = pack(axes[0]);
  packed.up = pack(axes[1]);
  packed.ahead = pack(axes[2]);
  packed.width = picture.width;
  packed.height = picture.height;
  for (float4& pixel : picture.pixels) pixel.w = static_cast<float>(luminance(pixel));
  packed.up.w = are_cells_between_pixels(picture, e.type) ? CELLS_BETWEEN_PIXELS : CELLS_ARE_PIXELS;
  add_shares(picture, packed, out);
  out.environments.push_back(packed);
  out.environment = std::move(picture.pixels);
  out.sees_environment = e.hidden ? SEEN_BY_NONE : e.visible ? SEEN_BY_ALL : SEEN_OFF_CAMERA;
  out.features.environment = out.features.area_lights = true;
  out.features.sky |= !e.hidden;
  Light light{};
  light.kind = LIGHT_ENVIRONMENT;
  for (u32 ray = 0; ray < static_cast<u32>(e.samples); ++ray)
    out.light_rays.push_back({static_cast<u32>(out.lights.size()), ray, static_cast<u32>(e.samples), 0});
  out.lights.push_back(light);
  if (e.type == EnvironmentType::sky || e.type == EnvironmentType::halo) add_sun(in, axes, out);
}

}  // namespace sundog
