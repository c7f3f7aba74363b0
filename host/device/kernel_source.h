// Expands kernel files to the single text that an OpenCL compiler gets.
#pragma once
#include <filesystem>
#include <string>

#include "device/device.h"

namespace sundog {

/// The text of `entry` after `defines` (as sorted #define lines), with every `#include "path"` (relative to
/// kernels/ or to `folder`, if given; generated files first) expanded, each file once, with #line directives
/// so that logs name file and line. Plain files are converted to lanes (lanes/lanes.h). Leaves `#include
/// <...>` alone. Throws BuildError for a missing file or one that includes itself.
std::string expand_kernel(const std::string& entry, const KernelDefines& defines,
                          const GeneratedFiles& generated = {}, const std::filesystem::path& folder = {});

}  // namespace sundog
