// Parses plain kernels: OpenCL C 1.2 for one path, without goto, switch, recursion and pointers to pointers,
// plus a few keywords. In: text. Out: a typed tree; unknown constructs are rejected.
//   UNIFORM T x               one value for all lanes; for a parameter or a member
//   EACH_ALIKE(T, x, value) s runs s for each distinct value of `value`, in the lanes that have it
//   any(c)                    whether c holds in some lane
//   if (HAS_X && ...)         features are resolved by the preprocessor; HAVING(HAS_X) T m; for members
// Interfaces to hand-written code:
//   T f(..., HERE, ...)       f takes the mask of active lanes at this position; calls omit it
//   CALLED(name) T f(...)     its hand-written name; UNIFORM T f(...): returns one value for all lanes
//   typedef struct LANES(Rays, join_rays) {...} Ray;  its lane form, and the function that joins lanes of two
//   LANE_VECTOR(Spectrum, Spectra, spectrum)             a vector: spectrum_add, spectrum_scale,
//   spectrum_select, ...
#pragma once
#include "lanes/preprocess.h"
#include "lanes/tree.h"

namespace sundog::spmd {

/// Throws BuildError with the place. Skips functions of files for which `is_plain` is false, which may be
/// called with uniform arguments.
Program parse(const Source& source, const std::function<bool(const std::string&)>& is_plain);

}  // namespace sundog::spmd
