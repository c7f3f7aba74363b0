// Tries a file's name as written, with / for \, and without its folders; then these in any case of letters.
#include "models/beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/input.h"
#include "base/names.h"
#include "models/text.h"

namespace sundog::models {
namespace fs = std::filesystem;
namespace {

std::string_view without_quotes(std::string_view name) {
  const bool quoted =
      name.size() > 2 && (name.front() == '"' || name.front() == '\'') && name.back() == name.front();
  return quoted ? name.substr(1, name.size() - 2) : name;
}

std::string with_slashes(std::string_view name) {
  std::string turned(name);
  std::ranges::replace(turned, '\\', '/');
  return turned;
}

bool may_be_read(const Source& model, const fs::path& path) {
  return model.outside_files || !leads_outside(model.path, path);
}

/// The file `name` below `folder` as the disk spells it, of those that differ in case the first by name.
fs::path in_any_case(const fs::path& folder, const fs::path& name) {
  fs::path path = folder;
  for (const fs::path& part : name) {
    std::error_code ignored;
    fs::path spelled = part;
    if (!fs::exists(path / part, ignored))
      for (const auto& entry : fs::directory_iterator(path.empty() ? "." : path, ignored))
        if (const fs::path found = entry.path().filename();
            lower_case(found.string()) == lower_case(part.string()) && (spelled == part || found < spelled))
          spelled = found;
    path /= spelled;
  }
  return path;
}

}  // namespace

std::optional<fs::path> find_beside(const Source& model, const fs::path& folder, std::string_view name,
                                    std::vector<std::string>& warnings) {
  for (const bool any_case : {false, true})
    for (const std::string_view spelled : {name, before_comment(name)}) {
      const std::string plain(without_quotes(spelled)), turned = with_slashes(plain);
      for (const std::string& each : {plain, turned, turned.substr(turned.rfind('/') + 1)}) {
        if (each.empty() || !may_be_read(model, folder / each)) continue;
        fs::path path = any_case ? in_any_case(folder, each) : folder / each;
        std::error_code ignored;
        if (!may_be_read(model, path) || !fs::is_regular_file(path, ignored)) continue;
        const std::string text = fmt::format(
            "'{}' is read as {}: rename the file for programs that heed upper case", each, path.string());
        if (any_case && std::ranges::count(warnings, text) == 0) warnings.push_back(text);
        return path;
      }
    }
  return std::nullopt;
}

std::string why_not_beside(const Source& model, const fs::path& folder, std::string_view name) {
  const fs::path path = folder / fs::path(with_slashes(without_quotes(name)));
  if (!may_be_read(model, path))
    return fmt::format("{} leads out of the model's folder and is not read: {}", path.string(), outside_hint);
  return fmt::format("{} is missing", path.string());
}

}  // namespace sundog::models
