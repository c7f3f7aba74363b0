// Kernel files embedded by the build (cmake/EmbedFiles.cmake), by path under kernels/.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"

namespace sundog {

/// A requested kernel file does not exist.
struct MissingKernelFile : BuildError {
  using BuildError::BuildError;
};

struct EmbeddedKernel {
  std::string_view path, text;  // path: "lib/rng.cl"
};

/// All files, sorted by path.
std::span<const EmbeddedKernel> embedded_kernels();

/// A file's text, read from `folder` if given, for kernel development. For a folder (a path that ends in a
/// slash): an #include line for each .cl file in it. Throws MissingKernelFile.
std::string embedded_kernel(const std::string& path, const std::filesystem::path& folder = {});

}  // namespace sundog
