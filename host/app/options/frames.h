// The frames of an animation: their numbers and the names of their files.
#pragma once
#include <string>
#include <vector>

namespace sundog {

/// The frames of a list such as "0..48", "48..0" or "1,4,10..20", each from 0 to 999999, in its order and
/// each once; of a range every `step`-th. Throws UsageError.
std::vector<int> parse_frames(const std::string& text, int step);

/// "3, 7..9": the frames by rising number.
std::string frames_text(std::vector<int> frames);

/// "out.png" -> "out_0007.png"; a run of # in the name, or %02d, takes the number instead: "f##.png" ->
/// "f07.png".
std::string frame_file(const std::string& out, int frame);

}  // namespace sundog
