// The folder of the optional test data: real models and malformed files that are not part of the project.
#pragma once
#include <filesystem>

/// SUNDOG_ASSETS, or else ../shared/assets beside the source tree; an empty path if it does not exist.
std::filesystem::path assets_directory();
