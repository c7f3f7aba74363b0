// The frames of an animation: their numbers, their files, and which of them are done.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sundog {

/// Frames first..last, both included.
struct FrameRange {
  int first = 0, last = 0;
};

/// "A..B" or "N", A <= B, each 0..999999. Throws UsageError.
FrameRange parse_frames(const std::string& text);

/// "out.png" -> "out_0007.png"; a run of # in the name takes the number instead: "f##.png" -> "f07.png".
std::string frame_file(const std::string& out, int frame);

/// What tells whether a frame is done.
struct FrameFiles {
  int frame = 0, width = 0, height = 0;
  std::string image, scene, checkpoint;
};

/// Which frames are done, kept in a JSON file beside the checkpoint, so that an interrupted animation
/// continues with the first frame that is not. Empty path: nothing is kept.
class FrameLog {
 public:
  /// Reads the file when it is there. A damaged one is renamed, with a warning; the pictures then tell which
  /// frames are done.
  explicit FrameLog(std::string path);
  /// Whether the frame of this hash is done, and its image is still there.
  bool done(const FrameFiles& files, std::uint64_t hash);
  void add(int frame, std::uint64_t hash);
  void remove();
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static bool has_picture(const FrameFiles& files, std::uint64_t hash);

  std::string path_;
  bool damaged_ = false;
  std::vector<std::string> warnings_;
  std::map<int, std::string> hashes_;
};

}  // namespace sundog
