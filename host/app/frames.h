// The frames of an animation: their numbers, their files, and which of them are done.
#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace sundog {

/// Frames first..last, both included.
struct FrameRange {
  int first = 0, last = 0;
};

/// "A..B" or "N", A <= B, each 0..999999. Throws UsageError.
FrameRange parse_frames(const std::string& text);

/// "out.png" -> "out_0007.png"; a run of # in the name takes the number instead: "f##.png" -> "f07.png".
std::string frame_file(const std::string& out, int frame);

/// Which frames are done, kept in a JSON file beside the checkpoint, so that an interrupted animation goes on
/// with the first frame that is not. Empty path: nothing is kept.
class FrameLog {
 public:
  /// Reads the file when it is there. Throws IoError for a file that is none of these.
  explicit FrameLog(std::string path);
  /// Whether the frame of this hash is done, and its image is still there.
  bool done(int frame, std::uint64_t hash, const std::string& image) const;
  void add(int frame, std::uint64_t hash);
  void remove();

 private:
  std::string path_;
  std::map<int, std::string> hashes_;
};

}  // namespace sundog
