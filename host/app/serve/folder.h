// Gives the viewer access to the scenes and models below the folder that it was started in, and to uploaded
// files, but to no other file.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sundog {

/// Scenes and models below `folder`, as sorted relative paths: at most 2000, at most six folders deep,
/// without hidden folders and build folders.
std::vector<std::string> list_scenes(const std::filesystem::path& folder);

/// The file with the path `name` relative to `folder`. Throws UsageError if it is outside (by "..", as an
/// absolute path, or through a link), is no file, or is no scene or model.
std::filesystem::path file_below(const std::filesystem::path& folder, const std::string& name);

/// A safe name for a new file: `name` with characters other than letters, digits, "-", "_" and "." replaced
/// by
/// "_"; never empty, never hidden.
std::string safe_file_name(const std::string& name);

/// Files that users drop on the page, each in its own folder below a folder that only this user may read and
/// that is removed with this object.
class Uploads {
 public:
  Uploads() = default;
  ~Uploads();
  Uploads(const Uploads&) = delete;
  Uploads& operator=(const Uploads&) = delete;

  /// Stores the bytes in a file of this name (safe_file_name()). Returns its path. Throws IoError.
  std::filesystem::path keep(const std::string& name, const std::string& bytes);
  bool hold(const std::filesystem::path& file) const;
  /// `text` without the newest file's folder in paths.
  std::string without_folder(std::string text) const;
  /// Removes all files except the newest; call when the others are no longer in use.
  void forget_others();
  /// Removes all files and the folder.
  void forget_all();
  /// Removes the newest file.
  void forget_newest();

 private:
  std::filesystem::path folder_;  // empty: none yet
  int count_ = 0, oldest_ = 1;
};

}  // namespace sundog
