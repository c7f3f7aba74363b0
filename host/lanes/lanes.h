// Vectorises plain kernels: converts OpenCL C for one path (parser.h defines the dialect) to functions in the
// vocabulary of kernels/lib/core/lanes.h, for any number of lanes. Infers which values vary between lanes,
// specialises functions for each kind of call, and turns control flow into masks (after M. Pharr and W. Mark,
// "ispc: A SPMD Compiler for High-Performance CPU Programming", 2012, and R. Karrenberg and S. Hack,
// "Whole-Function Vectorization", 2011).
#pragma once
#include <functional>
#include <string>

#include "lanes/parser.h"
#include "lanes/specialisation.h"

namespace sundog::spmd {

/// Whether a kernel file is plain, i.e. below plain/.
bool is_plain(const std::string& path);

/// Whether a program still lacks the function or structure `name` in lanes.
using IsWanted = std::function<bool(const std::string& name)>;

/// The plain files of a program. Methods throw BuildError "file:line:column: what".
class Lanes {
 public:
  /// `shows_helpers`: in files without ENTRY functions, all functions count as ENTRY functions, for authors.
  explicit Lanes(ReadFile read, bool shows_helpers = false);

  /// Converts the plain file `path` to lanes: its structures, its ENTRY functions and their callees, as far
  /// as they are wanted. `lines`: #line directives name the plain file.
  std::string text(
      const std::string& path, bool lines,
      const IsWanted& is_wanted = [](const std::string&) { return true; });

  /// Reports which variables vary in each generated function, why, and the function's cost.
  std::string explained(const std::string& path);

 private:
  /// Analyses files not read before. Returns the ENTRY functions and their callees, callees first.
  std::vector<Specialisation*> specialised(const std::string& path);

  Preprocessor preprocessor_;
  Parser parser_;
  Specialisations specialisations_;
  bool shows_helpers_;
};

/// The revision of this folder's sources: equal revisions generate equal text from equal files.
const char* revision();

}  // namespace sundog::spmd
