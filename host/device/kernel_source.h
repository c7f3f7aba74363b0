// Expands kernel files to the single text that an OpenCL compiler gets.
#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace sundog {

/// `-D` definitions, sorted by name; part of the kernel cache's key.
using KernelDefines = std::map<std::string, std::string>;

/// Kernel files that the host generates (formulas): include path -> text.
using GeneratedFiles = std::map<std::string, std::string>;

/// A kernel file and what it is expanded with.
struct KernelText {
  std::string entry;
  KernelDefines defines = {};
  GeneratedFiles generated = {};
  std::filesystem::path folder = {};

  /// The text of `entry` after `defines` (as sorted #define lines). Each `#include "path"` (relative to
  /// kernels/ or to `folder`, if given; generated files first) is expanded, each file once, with #line
  /// directives so that logs name file and line. Plain files are converted to lanes (lanes/lanes.h).
  /// `#include <...>` stays. Throws BuildError for a missing file or one that includes itself.
  std::string expanded() const;
  /// All that expanded() depends on, but faster: plain files are left as they are.
  std::string identity() const;
};

}  // namespace sundog
