// Reduces the quotient to |t| <= tan(pi / 8) and sums its series by Estrin's scheme, in a loop without
// branches that compilers vectorise.
#include "models/angles.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace sundog::models {
namespace {

// atan(t) / t in powers of t^2 for |t| <= tan(pi / 8), by a Chebyshev fit; its error is below 2e-18.
constexpr double powers[] = {0.99999999999999999874,   -0.33333333333333121163,  0.19999999999940891462,
                             -0.14285714279250244942,  0.11111110744919658237,   -0.090908968090640270761,
                             0.076920453309022249514,  -0.066629518136291900805, 0.058468782973308724636,
                             -0.050351024566015515855, 0.037965257453865929619,  -0.017805397205419437895};

}  // namespace

void angles_of(std::span<const double> sines, std::span<const double> cosines, std::span<double> angles) {
  constexpr double pi = std::numbers::pi, tan_pi_8 = std::numbers::sqrt2 - 1;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double sine = sines[i], cosine = std::abs(cosines[i]);
    const double low = sine < cosine ? sine : cosine, high = sine < cosine ? cosine : sine;
    const bool far = low > tan_pi_8 * high;  // measure from pi / 4
    const double t = (far ? low - high : low) / (far ? low + high : high), z = t * t, zz = z * z;
    // Estrin's scheme shortens dependency chains.
    const double p01 = powers[0] + z * powers[1], p23 = powers[2] + z * powers[3],
                 p45 = powers[4] + z * powers[5];
    const double p67 = powers[6] + z * powers[7], p89 = powers[8] + z * powers[9],
                 pab = powers[10] + z * powers[11];
    const double p03 = p01 + zz * p23, p47 = p45 + zz * p67, p8b = p89 + zz * pab, z4 = zz * zz;
    const double near = (far ? pi / 4 : 0) + t * (p03 + z4 * (p47 + z4 * p8b));
    const double first = sine < cosine ? near : pi / 2 - near;
    angles[i] = cosines[i] < 0 ? pi - first : first;
  }
}

}  // namespace sundog::models
