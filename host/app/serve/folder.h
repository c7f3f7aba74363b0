// The folder that the viewer was started in: the scenes and models below it, and no file outside.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace sundog {

/// Scenes and models below `folder`, as paths from it, sorted; hidden folders and build folders left out, at
/// most 2000, at most six folders deep.
std::vector<std::string> list_scenes(const std::filesystem::path& folder);

/// The file that `name`, a path from `folder`, means. Throws UsageError where it leads outside (by "..", as
/// an absolute path, through a link), is no file, or is no scene or model.
std::filesystem::path file_below(const std::filesystem::path& folder, const std::string& name);

/// A name for a new file: letters, digits, "-", "_" and "." of `name`, never empty, never hidden.
std::string safe_file_name(const std::string& name);

/// Files that are dropped on the page, each in a folder of its own, which this process alone may read and
/// which goes with it.
class Uploads {
 public:
  Uploads() = default;
  ~Uploads();
  Uploads(const Uploads&) = delete;
  Uploads& operator=(const Uploads&) = delete;

  /// Keeps the bytes under a name (safe_file_name()); the file's place. Throws IoError.
  std::filesystem::path keep(const std::string& name, const std::string& bytes);
  bool hold(const std::filesystem::path& file) const;
  /// `text` with the newest file's folder taken out of the paths in it.
  std::string without_folder(std::string text) const;
  /// Removes all but the newest: nobody has the others open.
  void forget_others();
  /// Removes all, and the folder.
  void forget_all();
  /// Removes the newest.
  void forget_newest();

 private:
  std::filesystem::path folder_;  // empty: none yet
  int count_ = 0, oldest_ = 1;
};

}  // namespace sundog
