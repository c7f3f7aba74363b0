// Appends a line of JSON per frame. Locks on single bytes far beyond the file's end represent the frames, and
// one more the right to append.
#include "app/render/frame_log.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::int64_t first_lock = std::int64_t{1} << 40, append_lock = first_lock - 1;

/// Locks or unlocks a byte. Returns false if another process holds the lock; true without support for locks.
bool set_lock(int file, int command, short type, std::int64_t byte) {
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  int failed = 0;
  do failed = ::fcntl(file, command, &lock);
  while (failed != 0 && errno == EINTR);
  return failed == 0 || (errno != EAGAIN && errno != EACCES);
}

FrameLock take_lock(int file, int command, std::int64_t byte) {
  if (!set_lock(file, command, F_WRLCK, byte)) return nullptr;
  return FrameLock(new const std::int64_t(byte), [file](const std::int64_t* locked) {
    set_lock(file, F_OFD_SETLK, F_UNLCK, *locked);
    delete locked;
  });
}

bool is_picture(const FramePicture& picture) {
  try {
    const Image image = read_image(picture.file);
    return image.width == picture.width && image.height == picture.height;
  } catch (const SceneError&) {
    return false;
  }
}

std::uintmax_t bytes_in(const std::string& file) {
  std::error_code failed;
  const std::uintmax_t bytes = fs::file_size(file, failed);
  return failed ? 0 : bytes;
}

std::string name_of(const FramePicture& picture) { return fs::path(picture.file).filename().string(); }

}  // namespace

bool holds_bytes(const std::string& file) { return bytes_in(file) > 0; }

FrameLog::FrameLog(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  const std::size_t damaged = holds_bytes(path_) ? read() : 0;
  if (damaged > 0 && entries_.empty()) {
    const std::string aside = path_ + ".damaged";
    std::error_code stays;  // if renaming fails, lines are appended to the file
    fs::rename(path_, aside, stays);
    warnings_.push_back(
        fmt::format("{}: is no list of an animation's frames: it is now {}, and all frames are rendered "
                    "(--skip-existing keeps the pictures that are there)",
                    path_, aside));
  } else if (damaged > 0) {
    warnings_.push_back(fmt::format("{}: {} of its lines {} damaged: the frames of these are rendered again",
                                    path_, damaged, damaged == 1 ? "is" : "are"));
  }
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) throw IoError(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

FrameLog::~FrameLog() {
  if (file_ >= 0) ::close(file_);
}

std::size_t FrameLog::read() {
  const std::string text = read_file(path_);
  std::size_t damaged = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (line.empty()) continue;
    try {
      const json entry = json::parse(line);
      entries_[entry.at("picture").get<std::string>()] = {entry.at("key").get<std::string>(),
                                                          entry.at("bytes").get<std::uintmax_t>()};
    } catch (const json::exception&) {
      ++damaged;
    }
  }
  return damaged;
}

FrameLock FrameLog::lock(int frame) const {
  if (file_ < 0) return std::make_shared<const std::int64_t>(frame);
  return take_lock(file_, F_OFD_SETLK, first_lock + frame);
}

bool FrameLog::done(const FramePicture& picture) {
  if (file_ < 0) return false;
  read();  // another process may have finished the frame meanwhile
  const auto found = entries_.find(name_of(picture));
  if (found == entries_.end() || found->second.key != picture.key || !holds_bytes(picture.file)) return false;
  return bytes_in(picture.file) == found->second.bytes || is_picture(picture);
}

void FrameLog::begin(int frame, const FramePicture& picture) {
  if (entries_.contains(name_of(picture))) add(frame, {picture.file, "", picture.width, picture.height});
}

void FrameLog::add(int frame, const FramePicture& picture) {
  if (file_ < 0) return;
  const FrameLock alone = take_lock(file_, F_OFD_SETLKW, append_lock);
  std::string line = json{{"frame", frame},
                          {"picture", name_of(picture)},
                          {"key", picture.key},
                          {"bytes", bytes_in(picture.file)}}
                         .dump(-1, ' ', false, json::error_handler_t::replace) +
                     "\n";
  char last = '\n';
  struct stat now = {};
  if (::fstat(file_, &now) == 0 && now.st_size > 0 && ::pread(file_, &last, 1, now.st_size - 1) == 1 &&
      last != '\n')
    line.insert(0, "\n");  // a full disk has cut the last line short
  const ssize_t written = ::write(file_, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size()))
    throw IoError(fmt::format("{}: cannot be written: {}", path_, write_error(written < 0 ? errno : ENOSPC)));
}

}  // namespace sundog
