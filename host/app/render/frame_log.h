// Records which frames of an animation are done, in a file that several processes may share.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sundog {

/// A frame's picture, and a hash of its inputs (`key`).
struct FramePicture {
  std::string file, key;
  int width = 0, height = 0;
};

/// The exclusive right to render a frame; released by its destruction or the end of the process.
using FrameLock = std::shared_ptr<const std::int64_t>;

/// Appends a line of JSON for each finished frame; a picture's last line counts. No path: records nothing.
class FrameLog {
 public:
  /// Opens or creates the file; renames a file that is no such list, with a warning. Throws IoError.
  explicit FrameLog(std::string path);
  ~FrameLog();
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;

  /// Whether there is a file.
  bool keeps() const { return file_ >= 0; }
  /// Locks a frame; null if another process has it.
  FrameLock lock(int frame) const;
  /// Whether the frame was finished with this key, and its picture still exists and is complete.
  bool done(const FramePicture& picture);
  /// Call before rendering a frame again: marks it as unfinished, because its file may become incomplete.
  void begin(int frame, const FramePicture& picture);
  void add(int frame, const FramePicture& picture);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Entry {
    std::string key;
    std::uintmax_t bytes = 0;
  };
  /// Reads the file and returns the number of damaged lines.
  std::size_t read();

  std::string path_;
  int file_ = -1;
  std::vector<std::string> warnings_;
  std::map<std::string, Entry> entries_;  // by the picture's file name
};

/// Whether the file exists and is not empty.
bool holds_bytes(const std::string& file);

}  // namespace sundog
