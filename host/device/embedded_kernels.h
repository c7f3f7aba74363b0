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
  std::string_view path, text;  // "lib/rng.cl"
};

/// All files, sorted by path.
std::span<const EmbeddedKernel> embedded_kernels();

/// A file's text, read from `folder` if given, for kernel development. Of a folder, whose path ends in a
/// slash, a line that includes each of its .cl files. Throws MissingKernelFile.
std::string embedded_kernel(const std::string& path, const std::filesystem::path& folder = {});

}  // namespace sundog
