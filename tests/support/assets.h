// Where the optional test data lies: real models and malformed files that are no part of the project.
#pragma once
#include <filesystem>

/// SUNDOG_ASSETS, else ../shared/assets beside the source tree; an empty path when there is none.
std::filesystem::path assets_directory();
