// Parses and prints an animation's frame numbers, and names the frames' files.
#pragma once
#include <string>
#include <vector>

namespace sundog {

/// The frames of a list such as "0..48", "48..0" or "1,4,10..20", each 0..999999, in the given order and
/// without duplicates; takes every `step`-th frame of a range. Throws UsageError.
std::vector<int> parse_frames(const std::string& text, int step);

/// The frames in ascending order, as "3, 7..9".
std::string frames_text(std::vector<int> frames);

/// "out.png" -> "out_0007.png"; the number replaces the first run of # or %02d in the name: "f##.png" ->
/// "f07.png".
std::string frame_file(const std::string& out, int frame);

}  // namespace sundog
