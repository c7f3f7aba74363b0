// The scene that the viewer shows, as a document that pages change: each change is checked by reading the
// scene; what does not read is refused and changes nothing. With undo, redo, and the scene of what is valid
// now. One thread at a time.
#pragma once
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// One value of the document is set, or, without `value`, taken out.
struct Change {
  std::string pointer;  // RFC 6901; "-" appends to an array; objects around it that are missing are made
  std::optional<nlohmann::json> value;
};

class SceneDocument {
 public:
  /// Opens a scene or model file. Throws SceneError; the document stays as it was.
  void open(const std::filesystem::path& file);
  /// Takes a document that a page sends in place of this one; `file` need not be there: names of files count
  /// from its folder.
  void replace(nlohmann::json document, const std::filesystem::path& file);
  /// Applies all changes, or throws (SceneError, UsageError) and applies none. Changes of one `gesture` (not
  /// empty) one after the other are undone together.
  void apply(const std::vector<Change>& changes, const std::string& gesture);
  /// False: there is nothing to undo, or to do again.
  bool undo();
  bool redo();

  const nlohmann::json& now() const { return now_; }
  const nlohmann::json& opened() const { return opened_; }  // as the file had it
  const std::filesystem::path& file() const { return file_; }
  std::shared_ptr<const SceneDescription> scene() const { return scene_; }
  /// Grows with each change.
  std::uint64_t version() const { return version_; }
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }

 private:
  void take(nlohmann::json next);
  void begin(nlohmann::json document, const std::filesystem::path& file);

  nlohmann::json now_, opened_;
  std::filesystem::path file_;
  std::shared_ptr<const SceneDescription> scene_;
  std::deque<nlohmann::json> past_, future_;
  std::string gesture_;
  std::uint64_t version_ = 0;
};

/// Sets or removes one value. Throws UsageError for a pointer that leads nowhere.
void apply_change(nlohmann::json& document, const Change& change);

/// What follows `sundog render` to make the picture of `now` out of the file: --set options where they lead
/// from `opened` to it, else nothing.
std::optional<std::vector<std::string>> settings_between(const nlohmann::json& opened,
                                                         const nlohmann::json& now,
                                                         const std::filesystem::path& file);

}  // namespace sundog
