// Expands a kernel file and its includes to the single text for an OpenCL compiler.
#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace sundog {

/// Macro definitions, sorted by name; part of the kernel cache's key.
using KernelDefines = std::map<std::string, std::string>;

/// Kernel files that the host generates (formulas): include path -> text.
using GeneratedFiles = std::map<std::string, std::string>;

/// A kernel file with the definitions and files to expand it with.
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
  /// A text that differs whenever expanded() does, but is faster to make: plain files stay unconverted.
  std::string identity() const;
};

}  // namespace sundog
