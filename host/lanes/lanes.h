// Plain kernels in lanes: OpenCL C of one path (parse.h says what may stand there) becomes functions in the
// words of kernels/lib/core/lanes.h, for any number of lanes. What varies from lane to lane is inferred;
// functions are made anew for each kind of call; masks follow control flow (after M. Pharr and W. Mark,
// "ispc: A SPMD Compiler for High-Performance CPU Programming", 2012, and R. Karrenberg and S. Hack,
// "Whole-Function Vectorization", 2011).
#pragma once
#include <string>

#include "lanes/preprocess.h"

namespace sundog::spmd {

/// Whether a kernel file is plain: those below plain/.
bool is_plain(const std::string& path);

/// The text of the plain file `path` in lanes: its structures and its functions that are marked ENTRY, with
/// all that they call. `lines`: #line directives name the plain file. Throws BuildError "file:line:column:
/// what".
std::string in_lanes(const std::string& path, const ReadFile& read, bool lines);

/// What varies in each function that is made, why, and what the function costs.
std::string explained(const std::string& path, const ReadFile& read);

}  // namespace sundog::spmd
