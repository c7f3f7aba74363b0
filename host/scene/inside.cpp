#include "scene/inside.h"

#include <algorithm>

namespace sundog {
namespace fs = std::filesystem;

bool leads_outside(const fs::path& file, const fs::path& named) {
  if (named.native().find('\0') != std::string::npos) return true;
  std::error_code failed;
  const fs::path folder = fs::canonical(file.has_parent_path() ? file.parent_path() : fs::path("."), failed);
  if (failed) return true;
  // weakly_canonical() does not make the relative path of a missing file absolute.
  const fs::path whole = fs::weakly_canonical(fs::absolute(named, failed), failed);
  if (failed) return true;
  return std::mismatch(folder.begin(), folder.end(), whole.begin(), whole.end()).first != folder.end();
}

}  // namespace sundog
