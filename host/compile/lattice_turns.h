// The turns of a Fibonacci lattice, as tables that sum over facets need them for each viewer.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

namespace sundog {

struct LatticeTurn {
  double cosine, sine;
};

/// Of a lattice of `places`, each of which is `step` places further around than the last.
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
