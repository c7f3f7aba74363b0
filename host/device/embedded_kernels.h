// The kernel files that the build embedded (cmake/EmbedKernels.cmake), by their path under kernels/.
#pragma once
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

/// The file's text. With SUNDOG_KERNEL_DIR set, files are read from that folder instead, for work on the
/// kernels. Throws MissingKernelFile.
std::string embedded_kernel(const std::string& path);

}  // namespace sundog
