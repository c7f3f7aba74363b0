#include "base/input.h"

#include "base/error.h"
#include "base/file.h"

namespace sundog {

std::string read_input(const std::filesystem::path& path) {
  try {
    return read_file(path);
  } catch (const IoError& error) {  // its message opens with the path, as SceneError's does
    throw SceneError(path.string(), "", std::string(error.what()).substr(path.string().size() + 2));
  }
}

}  // namespace sundog
