// Lists scenes below a folder within limits, and keeps uploads in a temporary folder.
#include "app/serve/folder.h"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/file.h"
#include "models/model.h"

namespace sundog {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_files = 2000, most_entries = 50'000;
constexpr int most_depth = 6;

bool is_scene(const fs::path& file) {
  return is_model_file(file) || (lower_extension(file) == ".json" && file.filename() != "scene.schema.json");
}

bool is_below(const fs::path& folder, const fs::path& file) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end();
}

fs::path private_folder() {
  std::string name = (temporary_folder() / "sundog-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    throw IoError(fmt::format("{}: a folder for uploads cannot be made: {}", name, std::strerror(errno)));
  return name;
}

}  // namespace

std::vector<std::string> list_scenes(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied, failed), end;
  for (std::size_t seen = 0; !failed && entry != end && seen < most_entries && names.size() < most_files;
       ++seen) {
    const std::string name = entry->path().filename().string();
    const bool hidden = name.starts_with(".") || name == "build" || name == "node_modules";
    if (entry->is_directory(failed)) {
      if (hidden || entry.depth() >= most_depth) entry.disable_recursion_pending();
    } else if (!hidden && entry->is_regular_file(failed) && is_scene(entry->path())) {
      names.push_back(entry->path().lexically_relative(folder).string());
    }
    entry.increment(failed);
  }
  std::ranges::sort(names);
  return names;
}

fs::path file_below(const fs::path& folder, const std::string& name) {
  std::error_code failed;
  const fs::path root = fs::canonical(folder, failed);
  if (failed) throw UsageError(fmt::format("{}: {}", folder.string(), failed.message()));
  const fs::path file = fs::canonical(root / name, failed);
  // The message is the same for missing files and files outside, so that pages learn nothing about those.
  if (failed || !is_below(root, file) || !fs::is_regular_file(file, failed))
    throw UsageError(
        fmt::format("{}: there is no such file below the folder that sundog was started in", name));
  if (!is_scene(file))
    throw UsageError(
        fmt::format("{}: wanted a scene (.json) or a model (" SUNDOG_MODEL_EXTENSIONS ")", name));
  return file;
}

std::string safe_file_name(const std::string& name) {
  std::string safe;
  for (const char c : fs::path(name).filename().string())
    safe += (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.') ? c : '_';
  if (safe.size() > 100) safe.resize(100);
  return safe.empty() || safe[0] == '.' ? "scene" + safe : safe;
}

Uploads::~Uploads() { forget_all(); }

void Uploads::forget_all() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
  folder_.clear();
}

fs::path Uploads::keep(const std::string& name, const std::string& bytes) {
  if (folder_.empty()) folder_ = private_folder();
  const fs::path folder = folder_ / std::to_string(++count_);
  std::error_code failed;
  fs::create_directory(folder, failed);
  if (failed) throw IoError(fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
  write_file(folder / name, bytes);
  return folder / name;
}

bool Uploads::hold(const fs::path& file) const { return !folder_.empty() && is_below(folder_, file); }

std::string Uploads::without_folder(std::string text) const {
  if (folder_.empty()) return text;
  const std::string folder = (folder_ / std::to_string(count_) / "").string();
  for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos;) text.erase(at, folder.size());
  return text;
}

void Uploads::forget_others() {
  std::error_code ignored;
  for (; oldest_ < count_; ++oldest_) fs::remove_all(folder_ / std::to_string(oldest_), ignored);
}

void Uploads::forget_newest() {
  std::error_code ignored;
  if (count_ >= oldest_) fs::remove_all(folder_ / std::to_string(count_--), ignored);
}

}  // namespace sundog
