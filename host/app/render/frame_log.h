// Which frames of an animation are done, in a file that several processes may share.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sundog {

/// A picture that a frame has made, and what it was made of.
struct FramePicture {
  std::string file, key;
  int width = 0, height = 0;
};

/// The right to render a frame, given back when it ends, also with its process.
using FrameLock = std::shared_ptr<const std::int64_t>;

/// A line of JSON for each finished frame, appended; the last line of a picture counts. Without a path
/// nothing is kept.
class FrameLog {
 public:
  /// Throws IoError. A file that is no such list is renamed, with a warning.
  explicit FrameLog(std::string path);
  ~FrameLog();
  FrameLog(const FrameLog&) = delete;
  FrameLog& operator=(const FrameLog&) = delete;

  /// Whether there is a path.
  bool keeps() const { return file_ >= 0; }
  /// Null while another process has the frame.
  FrameLock lock(int frame) const;
  /// Whether the frame was finished with that key, and its picture is still there and whole.
  bool done(const FramePicture& picture);
  /// Before the frame is rendered anew: until it is finished its file may hold a part.
  void begin(int frame, const FramePicture& picture);
  void add(int frame, const FramePicture& picture);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Entry {
    std::string key;
    std::uintmax_t bytes = 0;
  };
  /// Returns the number of lines that are none of a list.
  std::size_t read();

  std::string path_;
  int file_ = -1;
  std::vector<std::string> warnings_;
  std::map<std::string, Entry> entries_;  // by the picture's name
};

/// Whether something is in that file.
bool holds_bytes(const std::string& file);

}  // namespace sundog
