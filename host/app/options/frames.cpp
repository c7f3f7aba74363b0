#include "app/options/frames.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "render/film/film.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int most_frame = 999'999;

[[noreturn]] void refuse(const std::string& text) {
  throw UsageError(
      fmt::format("--frames {}: wanted A..B or N, whole numbers from 0 to {} with A <= B", text, most_frame));
}

int frame_number(std::string_view part, const std::string& text) {
  int number = -1;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
  if (error != std::errc() || end != part.data() + part.size() || number < 0 || number > most_frame)
    refuse(text);
  return number;
}

}  // namespace

FrameRange parse_frames(const std::string& text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) {
    const int only = frame_number(text, text);
    return {only, only};
  }
  const std::string_view all = text;
  const FrameRange range{frame_number(all.substr(0, dots), text), frame_number(all.substr(dots + 2), text)};
  if (range.first > range.last) refuse(text);
  return range;
}

std::string frame_file(const std::string& out, int frame) {
  const fs::path path = out;
  std::string name = path.filename().string();
  const std::size_t first = name.find('#');
  if (first == std::string::npos) {
    const std::string numbered =
        fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string());
    return (path.parent_path() / numbered).string();
  }
  const std::size_t last = std::min(name.find_first_not_of('#', first), name.size());
  name.replace(first, last - first, fmt::format("{:0{}}", frame, last - first));
  return (path.parent_path() / name).string();
}

namespace {

/// The hashes of the frames that a list holds; none where it is no such list, or damaged.
std::optional<std::map<int, std::string>> read_list(const std::string& text) {
  const json document = json::parse(text, nullptr, false);
  if (!document.is_object() || !document.contains("frames")) return std::nullopt;
  const json &schema = document.value("schema", json()), &done = document["frames"];
  if (schema != 1 || !done.is_object()) return std::nullopt;
  std::map<int, std::string> hashes;
  for (const auto& [name, hash] : done.items()) {
    int frame = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), frame);
    if (error != std::errc() || end != name.data() + name.size() || frame < 0 || frame > most_frame ||
        !hash.is_string())
      return std::nullopt;
    hashes[frame] = hash.get<std::string>();
  }
  return hashes;
}

bool is_picture(const std::string& file, int width, int height) {
  try {
    const Image image = read_image(file);
    return image.width == width && image.height == height;
  } catch (const SceneError&) {
    return false;
  }
}

}  // namespace

FrameLog::FrameLog(std::string path) : path_(std::move(path)) {
  if (path_.empty() || !is_there(path_)) return;
  if (auto hashes = read_list(read_file(path_))) {
    hashes_ = std::move(*hashes);
    return;
  }
  damaged_ = true;
  const std::string aside = path_ + ".damaged";
  std::error_code stays;  // then it is written over
  fs::rename(path_, aside, stays);
  warnings_.push_back(fmt::format(
      "{}: is no list of an animation's frames, or is damaged: it is now {}; frames whose pictures "
      "are there, whole and newer than the scene, count as done",
      path_, aside));
}

bool FrameLog::done(const FrameFiles& files, std::uint64_t hash) {
  if (const auto found = hashes_.find(files.frame); found != hashes_.end())
    return found->second == fmt::format("{:016x}", hash) && is_there(files.image);
  if (!damaged_ || !has_picture(files, hash)) return false;
  add(files.frame, hash);
  return true;
}

bool FrameLog::has_picture(const FrameFiles& files, std::uint64_t hash) {
  std::error_code failed;
  const auto drawn = fs::last_write_time(files.image, failed);
  if (failed || drawn < fs::last_write_time(files.scene, failed) || failed) return false;
  if (checkpoint_key(files.checkpoint) == hash) return false;  // the picture holds a part of the frame
  return is_picture(files.image, files.width, files.height);
}

void FrameLog::add(int frame, std::uint64_t hash) {
  if (path_.empty()) return;
  hashes_[frame] = fmt::format("{:016x}", hash);
  json frames = json::object();
  for (const auto& [number, value] : hashes_) frames[std::to_string(number)] = value;
  write_file(path_, json{{"schema", 1}, {"frames", frames}}.dump(1) + "\n");
}

void FrameLog::remove() {
  std::error_code stays;
  if (!path_.empty()) fs::remove(path_, stays);
}

}  // namespace sundog
