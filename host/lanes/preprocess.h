// The C preprocessor, as far as plain kernels and the headers of kernels/shared need it: includes (each file
// once), conditions, macros with and without arguments, ##. No strings.
#pragma once
#include <deque>
#include <functional>
#include <map>

#include "lanes/token.h"

namespace sundog::spmd {

/// The text of a kernel file by its path; throws where there is none.
using ReadFile = std::function<std::string(const std::string& path)>;

struct Source {
  Tokens tokens;  // the last one is `end`
  std::deque<std::string> files;
};

/// Throws BuildError with the place. A constant of one number keeps its name where a file that `keeps_names`
/// of a path is true of defines it.
Source preprocess(const std::string& path, const ReadFile& read,
                  const std::function<bool(const std::string&)>& keeps_names);

}  // namespace sundog::spmd
