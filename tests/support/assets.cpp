// Finds the optional test data.
#include "assets.h"

#include <cstdlib>

std::filesystem::path assets_directory() {
  namespace fs = std::filesystem;
  const char* named = std::getenv("SUNDOG_ASSETS");
  const fs::path path = named ? fs::path(named) : fs::path(SUNDOG_SOURCE_DIR) / "../shared/assets";
  return fs::is_directory(path) ? fs::weakly_canonical(path) : fs::path();
}
