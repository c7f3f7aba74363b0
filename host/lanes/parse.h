// Parses plain kernels: OpenCL C 1.2 for one path, without goto, switch, recursion and pointers to pointers,
// plus a few keywords. In: text. Out: a typed tree; unknown constructs are rejected.
//   UNIFORM T x               one value for all lanes; for a parameter or a member
//   EACH_ALIKE(T, x, value) s runs s for each distinct value of `value`, in the lanes that have it
//   any(c)                    whether c holds in some lane
//   if (HAS_X && ...)         features are taken out by the preprocessor; HAVING(HAS_X) T m; for members,
//   HAVING(HAS_X) T f(...) for functions, HAVING(HAS_X); for those of a file from there on
// In interfaces, to what is written by hand:
//   T f(..., HERE, ...)       f takes the mask of the lanes that are there, in that place; calls leave it out
//   CALLED(name) T f(...)     its name there; UNIFORM T f(...): it gives one value for all lanes
//   typedef struct LANES(Rays, join_rays) {...} Ray;  its lane form, and what joins lanes of two
//   LANE_VECTOR(Spectrum, Spectra, spectrum, 4)          a vector of x to w: spectrum_add, spectrum_scale,
//   spectrum_select, ...; the lane form of other structures is made: of a PathState it is PathStates
#pragma once
#include "lanes/preprocess.h"
#include "lanes/tree.h"

namespace sundog::spmd {

/// Throws BuildError with the place. Skips functions of files for which `is_plain` is false, which may be
/// called with uniform arguments.
Program parse(const Source& source, const std::function<bool(const std::string&)>& is_plain);

}  // namespace sundog::spmd
