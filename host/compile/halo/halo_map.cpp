// Divides the rays among 16 bands and the kinds of crystals, sums the bands' cells in doubles, and averages
// the map with its mirror image in the sun's vertical plane.
#include "compile/halo/halo_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/values/refraction.h"
#include "scene/spectra/cie.h"

namespace sundog {
namespace {

using glm::dvec3;

using std::numbers::pi;
constexpr double first_wavelength = 390, last_wavelength = 710;  // nanometres
constexpr int band_count = 16;
constexpr u32 rays_a_launch = 1u << 18;

double index_of_ice(double wavelength) {
  static const Dispersion ice = find_substance("ice").value();
  return index_at(ice, 1, wavelength);
}

double edge_of(int band) {
  return first_wavelength + (last_wavelength - first_wavelength) * band / band_count;
}

/// Bands sum to white; the sun's colour comes with its irradiance.
std::vector<dvec3> band_colors() {
  std::vector<dvec3> colors(band_count);
  dvec3 all(0);
  for (int band = 0; band < band_count; ++band) {
    constexpr int steps = 16;
    for (int i = 0; i < steps; ++i)
      colors[std::size_t(band)] += rgb_weight(edge_of(band) + (edge_of(1) - edge_of(0)) * (i + 0.5) / steps);
    all += colors[std::size_t(band)];
  }
  for (dvec3& color : colors) color /= all;
  return colors;
}

/// Divides rays 0 .. count - 1 into launches.
void add_launches(HaloLaunch launch, u32 count, std::vector<HaloLaunch>& launches) {
  for (u32 first = 0; first < count; first += rays_a_launch) {
    launch.first = first;
    launch.count = std::min(rays_a_launch, count - first);
    launches.push_back(launch);
  }
}

HaloLaunch launch_of(const EnvironmentDescription& e, const HaloCrystals& crystals, int band, u32 kind) {
  const double height = e.sun_altitude * pi / 180, half = 2 / std::sqrt(3.0) * crystals.ratio;
  // Upper bound of the sum of face areas times cosines: the length of the vector of areas, because the three
  // pairs of sides show at most twice one side.
  const double basal = 2 * std::sqrt(3.0), side = 4 / std::sqrt(3.0) * half;
  HaloLaunch launch{};
  launch.shape = crystals.shape;
  launch.seed = (static_cast<u32>(band) << 8 | kind) * 0x9e3779b9u + 0x51ed270bu;
  launch.half_height = static_cast<float>(half);
  launch.weight = static_cast<float>(1 / std::hypot(basal, 2 * side));
  launch.tilt = static_cast<float>(crystals.tilt / 360);
  launch.roll = static_cast<float>(crystals.roll / 360);
  const double fixed = e.halo.ior;
  launch.index_low = static_cast<float>(fixed > 0 ? fixed : index_of_ice(edge_of(band)));
  launch.index_high = static_cast<float>(fixed > 0 ? fixed : index_of_ice(edge_of(band + 1)));
  launch.sun_x = static_cast<float>(std::cos(height));
  launch.sun_z = static_cast<float>(std::sin(height));
  launch.sun_radius = static_cast<float>(std::tan(e.sun_size * pi / 360));
  launch.side = static_cast<u32>(e.halo.cells);
  return launch;
}

/// Cells beyond the square's edges are mapped to their place on the sphere: an edge folds about its middle.
std::size_t cell_at(int side, int column, int row) {
  if (column < 0 || column >= side) {
    column = column < 0 ? -1 - column : 2 * side - 1 - column;
    row = side - 1 - row;
  }
  if (row < 0 || row >= side) {
    row = row < 0 ? -1 - row : 2 * side - 1 - row;
    column = side - 1 - column;
  }
  return std::size_t(row) * std::size_t(side) + std::size_t(column);
}

/// As equal_area_cell() in kernels/plain/halo/sky_map.cl: the position in the square, [0, 1].
glm::dvec2 place_of(const dvec3& d) {
  const double x = std::abs(d.x), y = std::abs(d.y), radius = std::sqrt(std::max(1 - std::abs(d.z), 0.0));
  const double v = radius * std::atan2(y, x) * 2 / pi, u = radius - v;
  const glm::dvec2 place = d.z < 0 ? glm::dvec2(1 - v, 1 - u) : glm::dvec2(u, v);
  return 0.5 + 0.5 * place * glm::dvec2(d.x < 0 ? -1 : 1, d.y < 0 ? -1 : 1);
}

double tally(std::span<const u32> tallies, std::size_t which) {
  return (double(tallies[2 * which]) + 0x1p32 * double(tallies[2 * which + 1])) / double(HALO_TALLY_UNITS);
}

}  // namespace

HaloPlan plan_halo(const EnvironmentDescription& e) {
  HaloPlan plan;
  plan.side = e.halo.cells;
  plan.colors = band_colors();
  double shares = 0;
  for (const HaloCrystals& crystals : e.halo.crystals) shares += crystals.share;
  for (int band = 0; band < band_count; ++band) {
    std::vector<HaloLaunch> launches;
    u32 kind = 0;
    for (const HaloCrystals& crystals : e.halo.crystals) {
      const double rays = shares > 0 ? e.halo.rays / double(band_count) * crystals.share / shares : 0;
      add_launches(launch_of(e, crystals, band, kind++), static_cast<u32>(std::lround(rays)), launches);
    }
    for (const HaloLaunch& launch : launches) plan.rays += launch.count;
    plan.bands.push_back(std::move(launches));
  }
  return plan;
}

HaloSum::HaloSum(const HaloPlan& plan)
    : plan_(plan), sums_(std::size_t(plan.side) * std::size_t(plan.side), dvec3(0)) {}

void HaloSum::add(std::size_t band, std::span<const u32> cells, std::span<const u32> tallies) {
  std::uint64_t units = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    units += cells[i];
    if (cells[i] > 0) sums_[i] += double(cells[i]) * plan_.colors[band];
  }
  units_ += static_cast<double>(units);
  for (std::size_t which = 0; which < HALO_TALLIES; ++which) tallies_[which] += tally(tallies, which);
}

HaloMap HaloSum::map() const {
  HaloMap map;
  map.side = plan_.side;
  map.cells.assign(3 * sums_.size(), 0.0f);
  // Mirror images in the sun's vertical plane are equally likely; their mean halves the variance.
  const double scale =
      units_ > 0 ? 0.5 * double(sums_.size()) / (4 * pi) * double(plan_.bands.size()) / units_ : 0;
  const auto side = static_cast<std::size_t>(map.side);
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column) {
      const dvec3 both = sums_[row * side + column] + sums_[(side - 1 - row) * side + column];
      for (int c = 0; c < 3; ++c)
        map.cells[3 * (row * side + column) + std::size_t(c)] = static_cast<float>(both[c] * scale);
    }
  const double sent = std::max(tallies_[HALO_SENT], 1e-30);
  map.passed = tallies_[HALO_PASSED] / sent;
  map.turned = tallies_[HALO_TURNED] / sent;
  map.kept = tallies_[HALO_KEPT] / sent;
  return map;
}

dvec3 halo_radiance(const HaloMap& map, const dvec3& d) {
  const glm::dvec2 place = place_of(d) * double(map.side) - 0.5, low = glm::floor(place), part = place - low;
  dvec3 sum(0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const float* cell = &map.cells[3 * cell_at(map.side, int(low.x) + i, int(low.y) + j)];
      const double share = (i ? part.x : 1 - part.x) * (j ? part.y : 1 - part.y);
      sum += share * dvec3(cell[0], cell[1], cell[2]);
    }
  return sum;
}

double halo_depth(double optical_depth, double sun, double direction) {
  const double lowest = 0.01, a = std::max(sun, lowest), b = std::max(direction, lowest);
  if (std::abs(a - b) < 1e-4 * a) return optical_depth / a * std::exp(-optical_depth / a);
  return a / (a - b) * (std::exp(-optical_depth / a) - std::exp(-optical_depth / b));
}

}  // namespace sundog
