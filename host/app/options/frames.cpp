// Reads `--frames` lists such as 1,4,10..20, and fills frame numbers into file names.
#include "app/options/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <ranges>
#include <regex>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/numbers.h"

namespace sundog {
namespace fs = std::filesystem;
namespace {

constexpr int most_frame = 999'999;

int frame_number(std::string_view part, const std::string& text) {
  const int number = whole_number<int>(part).value_or(-1);
  if (number < 0 || number > most_frame)
    throw UsageError(fmt::format(
        "--frames {}: wanted frames such as 5, 0..48, 48..0 or 1,4,10..20, whole numbers from 0 to {}", text,
        most_frame));
  return number;
}

}  // namespace

std::vector<int> parse_frames(const std::string& text, int step) {
  std::vector<int> frames;
  std::set<int> known;
  const auto add = [&](int frame) {
    if (known.insert(frame).second) frames.push_back(frame);
  };
  for (const auto range : std::views::split(text, ',')) {
    const std::string_view part(range.begin(), range.end());
    const std::size_t dots = std::min(part.find(".."), part.size());
    const int first = frame_number(part.substr(0, dots), text),
              last = dots == part.size() ? first : frame_number(part.substr(dots + 2), text);
    for (int frame = first; frame <= last; frame += step) add(frame);
    for (int frame = first; frame >= last; frame -= step) add(frame);
  }
  return frames;
}

std::string frames_text(std::vector<int> frames) {
  std::ranges::sort(frames);
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", frames[i]);
    if (end > i + 1) text += fmt::format("{}{}", end > i + 2 ? ".." : ", ", frames[end - 1]);
    i = end;
  }
  return text;
}

std::string frame_file(const std::string& out, int frame) {
  const fs::path path = out;
  const std::string name = path.filename().string();
  static const std::regex place("#+|%0?([0-9]{0,2})d");
  std::smatch found;
  if (!std::regex_search(name, found, place)) {
    const std::string numbered =
        fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string());
    return (path.parent_path() / numbered).string();
  }
  const bool counted = found.str()[0] == '#';
  const int width = counted ? static_cast<int>(found.length()) : std::max(std::atoi(found.str(1).c_str()), 1);
  const std::string numbered =
      fmt::format("{}{:0{}}{}", found.prefix().str(), frame, width, found.suffix().str());
  return (path.parent_path() / numbered).string();
}

}  // namespace sundog
