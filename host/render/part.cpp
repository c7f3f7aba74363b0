// The file: a line of JSON with the sizes, a byte for each pixel that tells whether it is there, the done
// pixels' sums, weights and AOVs, and a checksum of all that in 16 digits.
#include "render/part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/input.h"
#include "render/hash.h"

namespace sundog {
namespace {

using nlohmann::json;

constexpr const char* format_name = "sundog part 1";
constexpr std::size_t checksum_digits = 16;
constexpr int bands_a_part = 8;

template <class T>
void append_done(std::string& bytes, const std::vector<T>& values, const std::vector<std::uint8_t>& done) {
  const std::size_t each = values.size() / std::max<std::size_t>(done.size(), 1);
  for (std::size_t i = 0; i < done.size(); ++i)
    if (done[i]) bytes.append(reinterpret_cast<const char*>(values.data() + each * i), each * sizeof(T));
}

/// Takes what append_done() has put; false when there is too little of it.
template <class T>
bool take_done(const std::string& bytes, std::size_t& at, std::vector<T>& values,
               const std::vector<std::uint8_t>& done) {
  const std::size_t each = values.size() / std::max<std::size_t>(done.size(), 1), size = each * sizeof(T);
  for (std::size_t i = 0; i < done.size(); ++i) {
    if (!done[i]) continue;
    if (at + size > bytes.size()) return false;
    std::memcpy(values.data() + each * i, bytes.data() + at, size);
    at += size;
  }
  return true;
}

std::string checksum(const std::string& bytes) {
  return fmt::format("{:016x}", hash_bytes(bytes.data(), bytes.size()));
}

/// The pixels of a file whose checksum is right, after its line of JSON.
bool read_film(const std::string& bytes, std::size_t at, Film& film) {
  if (at + film.done.size() > bytes.size()) return false;
  std::memcpy(film.done.data(), bytes.data() + at, film.done.size());
  at += film.done.size();
  return take_done(bytes, at, film.sums, film.done) && take_done(bytes, at, film.weights, film.done) &&
         take_done(bytes, at, film.aovs, film.done) && at == bytes.size();
}

}  // namespace

std::vector<RowRange> part_rows(int height, const PartOfFrame& part) {
  if (part.count <= 1) return {{0, height}};
  const int band = std::max(4, height / (part.count * bands_a_part) / 4 * 4);
  std::vector<RowRange> rows;
  for (int first = (part.index - 1) * band; first < height; first += part.count * band)
    rows.push_back({first, std::min(band, height - first)});
  return rows;
}

void write_part(const std::filesystem::path& path, const PartFile& file) {
  const json head = {{"format", format_name},    {"part", file.part.index},    {"parts", file.part.count},
                     {"key", file.key},          {"scene", file.scene},        {"aovs", file.aovs},
                     {"width", file.film.width}, {"height", file.film.height}, {"settings", file.settings}};
  std::string bytes = head.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  bytes.append(reinterpret_cast<const char*>(file.film.done.data()), file.film.done.size());
  append_done(bytes, file.film.sums, file.film.done);
  append_done(bytes, file.film.weights, file.film.done);
  append_done(bytes, file.film.aovs, file.film.done);
  write_file(path, bytes + checksum(bytes));
}

PartFile read_part(const std::filesystem::path& path) {
  std::string bytes = read_input(path);
  const auto refuse = [&](const char* why) { return SceneError(path.string(), "", why); };
  if (!bytes.starts_with('{') || bytes.find(format_name) == std::string::npos)
    throw refuse("is no part of a frame: `sundog render --tiles` writes them");
  const std::string damaged = "is damaged: render this part again";
  if (bytes.size() < checksum_digits) throw refuse(damaged.c_str());
  const std::string sum = bytes.substr(bytes.size() - checksum_digits);
  bytes.resize(bytes.size() - checksum_digits);
  if (sum != checksum(bytes)) throw refuse(damaged.c_str());
  const std::size_t line = bytes.find('\n');
  PartFile file;
  try {
    const json head = json::parse(bytes.substr(0, line));
    file.part = {head.at("part").get<int>(), head.at("parts").get<int>()};
    file.key = head.at("key").get<std::uint64_t>();
    file.scene = head.at("scene").get<std::string>();
    file.aovs = head.at("aovs").get<std::vector<std::string>>();
    file.settings = head.at("settings").get<std::map<std::string, std::string>>();
    file.film = Film(head.at("width").get<int>(), head.at("height").get<int>(), !file.aovs.empty());
  } catch (const json::exception&) {
    throw refuse(damaged.c_str());
  }
  if (!read_film(bytes, line + 1, file.film)) throw refuse(damaged.c_str());
  return file;
}

namespace {

/// "samples 16, the other samples 4": the settings that differ.
std::string settings_difference(const PartFile& a, const PartFile& b) {
  const auto text = [](const PartFile& part, const std::string& name) {
    const auto found = part.settings.find(name);
    return found == part.settings.end() ? "no " + name : name + " " + found->second;
  };
  std::map<std::string, std::string> names = a.settings;
  names.insert(b.settings.begin(), b.settings.end());
  std::vector<std::string> of_a, of_b;
  for (const auto& [name, value] : names) {
    if (text(a, name) == text(b, name)) continue;
    of_a.push_back(text(a, name));
    of_b.push_back(text(b, name));
  }
  return of_a.empty() ? "" : fmt::format("{}, the other {}", fmt::join(of_b, ", "), fmt::join(of_a, ", "));
}

/// Why two parts cannot belong to one frame; empty when they can.
std::string difference(const PartFile& a, const PartFile& b) {
  if (a.part.count != b.part.count)
    return fmt::format("one of {} parts, the other one of {}", b.part.count, a.part.count);
  if (a.film.width != b.film.width || a.film.height != b.film.height)
    return fmt::format("{}x{} pixels, the other {}x{}", b.film.width, b.film.height, a.film.width,
                       a.film.height);
  if (a.aovs != b.aovs)
    return fmt::format("AOVs [{}], the other [{}]", fmt::join(b.aovs, ", "), fmt::join(a.aovs, ", "));
  if (a.key == b.key) return {};
  if (const std::string settings = settings_difference(a, b); !settings.empty())
    return fmt::format("rendered with {}", settings);
  if (a.scene != b.scene) return fmt::format("of {}, the other of {}", b.scene, a.scene);
  return fmt::format("of another state of {}, or of a file that it names (digest {:016x}, the other {:016x})",
                     b.scene, b.key, a.key);
}

void check_complete(const std::string& path, const PartFile& file) {
  for (const RowRange& rows : part_rows(file.film.height, file.part))
    if (!file.film.is_done({0, rows.first, file.film.width, rows.count}))
      throw SceneError(
          path, "",
          fmt::format("part {} of {} is not complete: render it again", file.part.index, file.part.count));
}

void check_all_there(const std::map<int, std::string>& found, int count) {
  std::vector<int> missing;
  for (int i = 1; i <= count; ++i)
    if (!found.contains(i)) missing.push_back(i);
  if (!missing.empty())
    throw SceneError(
        found.begin()->second, "",
        fmt::format("part{0} {1} of {2} {3} missing: render {4} with --tiles {5}/{2} and the options of the "
                    "others",
                    missing.size() > 1 ? "s" : "", fmt::join(missing, ", "), count,
                    missing.size() > 1 ? "are" : "is", missing.size() > 1 ? "each" : "it",
                    missing.size() > 1 ? "I" : std::to_string(missing.front())));
}

/// Copies the pixels that are done.
void add(Film& whole, const Film& part) {
  const std::size_t aovs = whole.aovs.empty() ? 0 : 3;
  for (std::size_t i = 0; i < part.done.size(); ++i) {
    if (!part.done[i]) continue;
    whole.sums[i] = part.sums[i];
    whole.weights[i] = part.weights[i];
    for (std::size_t k = 0; k < aovs; ++k) whole.aovs[3 * i + k] = part.aovs[3 * i + k];
    whole.done[i] = 1;
  }
}

}  // namespace

PartFile merge_parts(const std::vector<std::filesystem::path>& paths) {
  if (paths.empty()) throw UsageError("there are no parts to merge");
  PartFile whole;
  std::map<int, std::string> found;  // part -> its file
  for (const std::filesystem::path& path : paths) {
    PartFile file = read_part(path);
    if (found.empty()) {
      whole = file;
    } else if (const std::string why = difference(whole, file); !why.empty()) {
      throw SceneError(path.string(), "",
                       fmt::format("does not belong to {}: it is {}", found.begin()->second, why));
    }
    const auto [before, fresh] = found.emplace(file.part.index, path.string());
    if (!fresh)
      throw SceneError(
          path.string(), "",
          fmt::format("is part {} of {}, and so is {}", file.part.index, file.part.count, before->second));
    check_complete(path.string(), file);
    add(whole.film, file.film);
  }
  check_all_there(found, whole.part.count);
  whole.part = {};
  return whole;
}

}  // namespace sundog
