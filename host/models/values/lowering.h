// Types and functions with which the host computes kernels/plain/shade/lowering.h in double precision.
#pragma once
#include <algorithm>
#include <cmath>

namespace sundog::lowering {

using std::fabs, std::fma;
using LOWERED = double;
inline double real_min(double a, double b) { return std::min(a, b); }
inline double real_clamp(double x, double low, double high) { return std::clamp(x, low, high); }
inline double real_exp(double x) { return std::exp(x); }
inline double real_sqrt(double x) { return std::sqrt(x); }

#include "plain/shade/lowering.h"

}  // namespace sundog::lowering
