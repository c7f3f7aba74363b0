// From kernel files to the one text that an OpenCL compiler gets.
#pragma once
#include <filesystem>
#include <string>

#include "device/device.h"

namespace sundog {

/// The text of `entry` after `defines` (as sorted #define lines), with every `#include "path"` (paths are
/// from kernels/ or, where it is given, from `folder`; generated files first) replaced by the file, each file
/// once, and #line directives so that logs name file and line.
/// Plain files come in lanes (lanes/lanes.h). `#include <...>` is left alone. Throws BuildError for a file
/// that is missing or includes itself.
std::string expand_kernel(const std::string& entry, const KernelDefines& defines,
                          const GeneratedFiles& generated = {}, const std::filesystem::path& folder = {});

}  // namespace sundog
