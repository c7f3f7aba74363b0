// The scene that the viewer shows, as a document that pages change: each change is checked by reading the
// scene; what does not read is refused and changes nothing. With undo, redo, and the scene of what is valid
// now. What it holds is bounded. One thread at a time.
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

/// One value of the document is set, or, without `value`, taken out.
struct Change {
  std::string pointer;  // RFC 6901; "-" appends to an array; objects around it that are missing are made
  std::optional<nlohmann::json> value;
};

/// As JSON text. Each page gets it whole, twice: as it is, and as the file has it.
inline constexpr std::size_t most_document_bytes = std::size_t{16} << 20;

/// Throws SceneError for more than that.
void check_document_size(std::uintmax_t bytes, const std::filesystem::path& file);

/// A whole document as CBOR: several times smaller than its values in memory.
using DocumentStep = std::vector<std::uint8_t>;

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
  bool is_file() const { return is_file_; }  // opened() is what the file holds
  std::shared_ptr<const SceneDescription> scene() const { return scene_; }
  /// Grows with each change.
  std::uint64_t version() const { return version_; }
  /// The version that open() or replace() made.
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
  std::deque<DocumentStep> past_, future_;  // the newest last
  std::string gesture_;
  std::uint64_t version_ = 0, opened_version_ = 0;
};

/// Sets or removes one value. Throws UsageError for a pointer that leads nowhere.
void apply_change(nlohmann::json& document, const Change& change);

/// Arguments of `sundog render` that make the picture of `now` from the file: --set options that turn
/// `opened` into `now`. Nothing if no --set options do.
std::optional<std::vector<std::string>> settings_between(const nlohmann::json& opened,
                                                         const nlohmann::json& now,
                                                         const std::filesystem::path& file);

}  // namespace sundog
