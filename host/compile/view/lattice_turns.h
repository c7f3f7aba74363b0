// Tabulated rotations of a Fibonacci lattice, for sums over microfacets per viewer.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

namespace sundog {

struct LatticeTurn {
  double cosine, sine;
};

/// For a lattice of `places`, each rotated by `step` places from the previous one.
template <int places, int step>
const std::array<LatticeTurn, places>& lattice_turns() {
  static const auto turns = [] {
    std::array<LatticeTurn, places> made;
    for (int i = 0; i < places; ++i) {
      const double turn = 2 * std::numbers::pi * (double(i * step % places) / places);
      made[static_cast<std::size_t>(i)] = {std::cos(turn), std::sin(turn)};
    }
    return made;
  }();
  return turns;
}

}  // namespace sundog
