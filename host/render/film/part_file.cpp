// A part's file: a line of JSON, a byte per pixel that says whether the pixel is done, the done pixels' sums,
// weights, AOVs and rays, and a checksum of it all in 16 digits.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/file.h"
#include "base/input.h"
#include "base/json_memory.h"
#include "base/json_text.h"
#include "base/limits.h"
#include "base/memory.h"
#include "render/film/group_names.h"
#include "render/film/hash.h"
#include "render/film/part.h"

namespace sundog {
namespace {

using nlohmann::json;

constexpr const char *any_format = "\"sundog part ", *format_name = "sundog part 3";
constexpr std::size_t checksum_digits = 16;

template <class T>
void append_done(std::string& bytes, const std::vector<T>& values, const std::vector<std::uint8_t>& done) {
  const std::size_t each = values.size() / std::max<std::size_t>(done.size(), 1);
  for (std::size_t i = 0; i < done.size(); ++i)
    if (done[i]) bytes.append(reinterpret_cast<const char*>(values.data() + each * i), each * sizeof(T));
}

/// Reads values that append_done() wrote; false if the file is too short.
template <class T>
bool take_done(const std::string& bytes, std::size_t& at, std::vector<T>& values,
               const std::vector<std::uint8_t>& done) {
  const std::size_t each = values.size() / std::max<std::size_t>(done.size(), 1), size = each * sizeof(T);
  if (size == 0) return true;
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

/// An integer of the header; nothing unless it lies within the bounds.
std::optional<int> whole(const json& head, const char* key, int least, int most) {
  const json& value = head.at(key);
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number < static_cast<std::uint64_t>(least) || number > static_cast<std::uint64_t>(most))
    return std::nullopt;
  return static_cast<int>(number);
}

/// Whether the values are distinct names of AOVs.
bool are_aovs(const std::vector<std::string>& names) {
  return std::ranges::all_of(names, is_aov) &&
         std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

json matrix_json(const glm::dmat4& m) {
  json numbers;
  for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
  return numbers;
}

glm::dmat4 read_matrix(const json& numbers) {
  glm::dmat4 m;
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers.at(static_cast<std::size_t>(i)).get<double>();
  return m;
}

json next_json(const std::optional<NextShot>& next) {
  if (!next) return {};
  json moves = json::array();
  for (const auto& [object, matrix] : next->moves) moves.push_back({object, matrix_json(matrix)});
  json faces = json::array();  // an object's index, and 18 numbers per face
  for (const auto& [object, moving] : next->faces) {
    json numbers = json::array();
    for (const MovingFace& face : moving)
      for (const auto* corners : {&face.now, &face.next})
        for (const glm::vec3& p : *corners)
          for (int c = 0; c < 3; ++c) numbers.push_back(p[c]);
    faces.push_back({object, std::move(numbers)});
  }
  return {{"ndc", matrix_json(next->world_to_ndc)}, {"moves", moves}, {"faces", faces}};
}

std::optional<NextShot> read_next(const json& value) {
  if (value.is_null()) return std::nullopt;
  NextShot next{read_matrix(value.at("ndc")), {}, {}};
  for (const json& move : value.at("moves")) next.moves[move.at(0).get<int>()] = read_matrix(move.at(1));
  for (const json& object : value.at("faces")) {
    const json& numbers = object.at(1);
    std::vector<MovingFace>& faces = next.faces[object.at(0).get<int>()];
    faces.resize(numbers.size() / 18);
    std::size_t at = 0;
    for (MovingFace& face : faces)
      for (auto* corners : {&face.now, &face.next})
        for (glm::vec3& p : *corners)
          for (int c = 0; c < 3; ++c) p[c] = numbers.at(at++).get<float>();
  }
  return next;
}

json shot_json(const Shot& shot) {
  return {{"camera", matrix_json(shot.world_to_camera)},
          {"ndc", matrix_json(shot.world_to_ndc)},
          {"window", shot.window_width},
          {"focus", shot.focus ? json(*shot.focus) : json()},
          {"frame", shot.frame ? json(*shot.frame) : json()},
          {"rate", shot.frames_per_second},
          {"exposure", shot.exposure_seconds},
          {"next", next_json(shot.next)}};
}

Shot read_shot(const json& value) {
  Shot shot;
  shot.world_to_camera = read_matrix(value.at("camera"));
  shot.world_to_ndc = read_matrix(value.at("ndc"));
  shot.window_width = value.at("window").get<double>();
  if (!value.at("focus").is_null()) shot.focus = value["focus"].get<double>();
  shot.frame = whole(value, "frame", 0, 999999);
  shot.frames_per_second = value.at("rate").get<double>();
  shot.exposure_seconds = value.at("exposure").get<double>();
  shot.next = read_next(value.at("next"));
  return shot;
}

/// Reads the header, with an empty film of its size; nothing if the values are impossible. Throws json
/// exceptions.
std::optional<PartFile> read_header(const json& head) {
  const auto count = whole(head, "parts", 1, most_parts);
  const auto index = whole(head, "part", 1, count.value_or(0));
  const auto width = whole(head, "width", 1, most_edge), height = whole(head, "height", 1, most_edge);
  if (!index || !width || !height || !is_frame_size(*width, *height)) return std::nullopt;
  if (!head.at("key").is_number_unsigned()) return std::nullopt;
  PartFile file;
  file.part = {*index, *count};
  file.key = head.at("key").get<std::uint64_t>();
  file.scene = head.at("scene").get<std::string>();
  file.aovs = head.at("aovs").get<std::vector<std::string>>();
  file.settings = head.at("settings").get<std::map<std::string, std::string>>();
  file.shot = read_shot(head.at("shot"));
  file.names.objects = head.at("objects").get<std::vector<std::string>>();
  file.names.materials = head.at("materials").get<std::vector<std::string>>();
  file.film.width = *width;
  file.film.height = *height;
  if (!are_aovs(file.aovs)) return std::nullopt;
  if (std::ranges::count(file.aovs, motion_aov) > 0 && !file.shot.next) return std::nullopt;
  return file;
}

/// A nearly empty part is a small file for a large frame, so memory is checked before the film is allocated.
void check_memory(const std::filesystem::path& path, const PartFile& file) {
  const auto pixels =
      static_cast<std::uint64_t>(file.film.width) * static_cast<std::uint64_t>(file.film.height);
  const std::uint64_t wanted = pixels * film_bytes(file.aovs), there = available_memory().value_or(wanted);
  if (wanted > there)
    throw SceneError(
        path.string(), "",
        fmt::format("its frame of {}x{} pixels takes {:.1f} GiB of memory, and {:.1f} GiB are available",
                    file.film.width, file.film.height, static_cast<double>(wanted) / (1 << 30),
                    static_cast<double>(there) / (1 << 30)));
}

/// Reads the film behind the header; the checksum has been verified. Allocates only if the file has a flag
/// for each pixel.
bool read_film(const std::string& bytes, std::size_t at, const std::vector<std::string>& aovs, Film& film) {
  const auto pixels = static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
  if (pixels > bytes.size() - at) return false;
  film = Film::with_aovs(film.width, film.height, aovs);
  std::memcpy(film.done.data(), bytes.data() + at, pixels);
  at += pixels;
  if (!all_flags(film.done)) return false;
  bool whole = true;
  visit_samples([&](auto& array) { whole = whole && take_done(bytes, at, array, film.done); }, film);
  return whole && at == bytes.size();
}

}  // namespace

void write_part(const std::filesystem::path& path, const PartHeader& header, const Film& film,
                const std::shared_ptr<Faults>& faults) {
  const json head = {{"format", format_name},
                     {"part", header.part.index},
                     {"parts", header.part.count},
                     {"key", header.key},
                     {"scene", header.scene},
                     {"aovs", header.aovs},
                     {"width", film.width},
                     {"height", film.height},
                     {"settings", header.settings},
                     {"shot", shot_json(header.shot)},
                     {"objects", header.names.objects},
                     {"materials", header.names.materials}};
  std::string bytes = json_text(head) + "\n";
  const auto done = static_cast<std::size_t>(std::ranges::count(film.done, std::uint8_t{1}));
  bytes.reserve(bytes.size() + film.done.size() +
                done * (20 + (film.aovs.empty() ? 0 : 16 * film.layout.vectors())) + checksum_digits);
  bytes.append(reinterpret_cast<const char*>(film.done.data()), film.done.size());
  visit_samples([&](const auto& array) { append_done(bytes, array, film.done); }, film);
  bytes += checksum(bytes);
  write_file(path, bytes, faults);
}

PartFile read_part(const std::filesystem::path& path) {
  std::string bytes = read_input(path, most_frame_bytes);
  const auto refuse = [&](const char* why) { return SceneError(path.string(), "", why); };
  const auto is_of = [&](const char* name) {
    const std::string_view format = std::string_view(bytes).substr(0, bytes.find('\n'));
    return format.starts_with('{') && format.find(name) != std::string_view::npos;
  };
  if (!is_of(any_format))
    throw SceneError(path.string(), "", "is no part of a frame: a render of one part writes them",
                     Remedy::part);
  if (!is_of(format_name))
    throw refuse("is a part of another version of sundog: merge with that version, or render the part again");
  const std::string damaged = "is damaged: render this part again";
  if (bytes.size() < checksum_digits) throw refuse(damaged.c_str());
  const std::string sum = bytes.substr(bytes.size() - checksum_digits);
  bytes.resize(bytes.size() - checksum_digits);
  if (sum != checksum(bytes)) throw refuse(damaged.c_str());
  const std::size_t line = std::min(bytes.find('\n'), bytes.size() - 1);
  const std::string_view head = std::string_view(bytes).substr(0, line);
  check_json_memory(head, path);
  std::optional<PartFile> file;
  try {
    file = read_header(json::parse(head));
  } catch (const json::exception&) {
    throw refuse(damaged.c_str());
  }
  if (file) check_memory(path, *file);
  if (!file || !read_film(bytes, line + 1, file->aovs, file->film)) throw refuse(damaged.c_str());
  return std::move(*file);
}

}  // namespace sundog
