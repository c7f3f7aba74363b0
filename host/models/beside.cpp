// Tries a file's name as written, with / for \, and without its folders.
#include "models/beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/input.h"
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

}  // namespace

std::optional<fs::path> find_beside(const Source& model, const fs::path& folder, std::string_view name) {
  for (const std::string_view spelled : {name, before_comment(name)}) {
    const std::string plain(without_quotes(spelled)), turned = with_slashes(plain);
    for (const std::string& each : {plain, turned, turned.substr(turned.rfind('/') + 1)}) {
      const fs::path path = folder / fs::path(each);
      std::error_code ignored;
      if (!each.empty() && may_be_read(model, path) && fs::is_regular_file(path, ignored)) return path;
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
