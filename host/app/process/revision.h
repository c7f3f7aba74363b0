// The revision of the sources that the program was built from.
#pragma once

namespace sundog {

/// The git commit, followed by "with changes" if files differed from it; "unknown" outside git.
const char* build_revision();

}  // namespace sundog
