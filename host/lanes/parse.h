// Plain kernels: OpenCL C 1.2 of one path, without goto, switch, recursion and pointers to pointers, with a
// few words more. From text to a tree with types; what is not understood is refused.
//   UNIFORM T x               one value for all lanes: of a parameter or a member
//   EACH_ALIKE(T, x, value) s does s for each different value of `value`, in the lanes that have it
//   any(c)                    whether c holds in some lane
//   if (HAS_X && ...)         features are taken out by the preprocessor; HAVING(HAS_X) T m; for members
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

/// Throws BuildError with the place. Functions of the files that `is_plain` is false of are not read, but
/// may be called with what is uniform.
Program parse(const Source& source, const std::function<bool(const std::string&)>& is_plain);

}  // namespace sundog::spmd
