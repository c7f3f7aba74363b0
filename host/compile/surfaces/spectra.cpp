// See spectra.h.
#include "compile/surfaces/spectra.h"

#include <algorithm>

#include "scene/spectra/upsample.h"

namespace sundog {
namespace {

constexpr std::size_t rows = SPECTRUM_ROWS;

std::vector<float> columns_of_colors() {
  std::vector<float> table(SPECTRUM_COLUMNS * rows);
  for (std::size_t i = 0; i < rows; ++i) {
    for (int c = 0; c < 3; ++c)
      table[(SPECTRUM_RED + static_cast<std::size_t>(c)) * rows + i] =
          static_cast<float>(rgb_weights()[i][c]);
    table[SPECTRUM_OF_RED * rows + i] = static_cast<float>(spectral_basis()[i].x);
    table[SPECTRUM_OF_BLUE * rows + i] = static_cast<float>(spectral_basis()[i].z);
  }
  return table;
}

}  // namespace

u32 SpectraMaker::add(const Dispersion& dispersion) {
  if (!used_ || dispersion.kind == DispersionKind::none) return NO_SPECTRUM;
  const auto found = std::ranges::find(added_, dispersion);
  const auto index = static_cast<std::size_t>(found - added_.begin());
  if (found == added_.end()) {
    if (table_.empty()) table_ = columns_of_colors();
    for (std::size_t i = 0; i < rows; ++i) {
      const double wavelength =
          static_cast<double>(SPECTRUM_FIRST) + static_cast<double>(SPECTRUM_STEP) * static_cast<double>(i);
      table_.push_back(static_cast<float>(index_at(dispersion, 1, wavelength)));
    }
    added_.push_back(dispersion);
  }
  return static_cast<u32>((SPECTRUM_COLUMNS + index) * rows);
}

}  // namespace sundog
