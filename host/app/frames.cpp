#include "app/frames.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

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

FrameLog::FrameLog(std::string path) : path_(std::move(path)) {
  if (path_.empty() || !fs::exists(path_)) return;
  const json document = json::parse(read_file(path_), nullptr, false);
  const auto done = document.find("frames");
  if (document.value("schema", 0) != 1 || done == document.end() || !done->is_object())
    throw IoError(fmt::format("{}: not the list of an animation's frames; remove it to begin anew", path_));
  for (const auto& [frame, hash] : done->items())
    hashes_[frame_number(frame, frame)] = hash.is_string() ? hash.get<std::string>() : "";
}

bool FrameLog::done(int frame, std::uint64_t hash, const std::string& image) const {
  const auto found = hashes_.find(frame);
  return found != hashes_.end() && found->second == fmt::format("{:016x}", hash) && fs::exists(image);
}

void FrameLog::add(int frame, std::uint64_t hash) {
  if (path_.empty()) return;
  hashes_[frame] = fmt::format("{:016x}", hash);
  json frames = json::object();
  for (const auto& [number, value] : hashes_) frames[std::to_string(number)] = value;
  write_file(path_, json{{"schema", 1}, {"frames", frames}}.dump(1) + "\n");
}

void FrameLog::remove() {
  if (!path_.empty()) fs::remove(path_);
}

}  // namespace sundog
