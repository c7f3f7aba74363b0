// The kernel files that the build embedded (cmake/EmbedFiles.cmake), by their path under kernels/.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"

namespace sundog {

/// A kernel file was asked for that is not there.
struct MissingKernelFile : BuildError {
  using BuildError::BuildError;
};

struct EmbeddedKernel {
  std::string_view path, text;  // "lib/rng.cl"
};

/// All of them, sorted by path.
std::span<const EmbeddedKernel> embedded_kernels();

/// The file's text, from `folder` instead where there is one, for work on the kernels. Throws
/// MissingKernelFile.
std::string embedded_kernel(const std::string& path, const std::filesystem::path& folder = {});

}  // namespace sundog
