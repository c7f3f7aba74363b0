// SceneDocument: the scene that the viewer shows, as a JSON document that pages change, with undo and redo.
// Each change is checked by reading the scene; an invalid change is refused. Its memory is bounded. Use from
// one thread at a time.
#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// Sets a value of the document or, without `value`, removes it.
struct Change {
  std::string pointer;  // RFC 6901; "-" appends to an array; missing parent objects are created
  std::optional<nlohmann::json> value;
};

/// Limit of a document as JSON text. Each page receives two: the current one, and the one from the file.
inline constexpr std::size_t most_document_bytes = std::size_t{16} << 20;

/// Throws SceneError if `bytes` exceeds most_document_bytes.
void check_document_size(std::uintmax_t bytes, const std::filesystem::path& file);

/// A whole document as CBOR, several times smaller than its values in memory.
using DocumentStep = std::vector<std::uint8_t>;

class SceneDocument {
 public:
  /// Opens a scene or model file. Throws SceneError and then keeps the previous document.
  void open(const std::filesystem::path& file);
  /// Replaces the document by one that a page sent. `file` need not exist; file names in the document are
  /// relative to its folder. Throws SceneError.
  void replace(nlohmann::json document, const std::filesystem::path& file);
  /// Applies all changes, or throws (SceneError, UsageError) and applies none. Consecutive changes of the
  /// same `gesture` (not empty) are undone together.
  void apply(const std::vector<Change>& changes, const std::string& gesture);
  /// Return false if there is nothing to undo or redo.
  bool undo();
  bool redo();

  const nlohmann::json& now() const { return now_; }
  const nlohmann::json& opened() const { return opened_; }  // the document as opened
  const std::filesystem::path& file() const { return file_; }
  bool is_file() const { return is_file_; }  // opened() came from file()
  std::shared_ptr<const SceneDescription> scene() const { return scene_; }
  /// Grows with each change.
  std::uint64_t version() const { return version_; }
  /// The version that the last open() or replace() created.
  std::uint64_t opened_version() const { return opened_version_; }
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }

 private:
  void check(const nlohmann::json& next, const SceneDescription& scene) const;
  void take(nlohmann::json next);
  void begin(nlohmann::json document, const std::filesystem::path& file);
  bool step(std::deque<DocumentStep>& from, std::deque<DocumentStep>& to);

  nlohmann::json now_, opened_;
  std::filesystem::path file_;
  bool is_file_ = false;
  std::shared_ptr<const SceneDescription> scene_;
  std::deque<DocumentStep> past_, future_;  // the newest is last
  std::string gesture_;
  std::uint64_t version_ = 0, opened_version_ = 0;
};

/// Sets or removes one value. Throws UsageError for a pointer that leads nowhere.
void apply_change(nlohmann::json& document, const Change& change);

/// The values for `sundog render --set` that turn `opened` into `now`; none if no such options do.
std::optional<std::vector<std::string>> settings_between(const nlohmann::json& opened,
                                                         const nlohmann::json& now,
                                                         const std::filesystem::path& file);

}  // namespace sundog
