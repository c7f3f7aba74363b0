// The revision of the sources that the program was built from.
#pragma once

namespace sundog {

/// The git commit, "... with changes" where files differed from it; "unknown" outside git.
const char* build_revision();

}  // namespace sundog
