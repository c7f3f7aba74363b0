// A C preprocessor for plain kernels and the headers of kernels/shared: includes (each file once),
// conditions, macros with and without arguments, ##. No strings.
#pragma once
#include <deque>
#include <functional>
#include <map>

#include "lanes/token.h"

namespace sundog::spmd {

/// Returns a kernel file's text; throws if there is none.
using ReadFile = std::function<std::string(const std::string& path)>;

struct Source {
  Tokens tokens;  // the last one is `end`
  std::deque<std::string> files;
};

/// Throws BuildError with the place. Constants that are a single number keep their name if `keeps_names` is
/// true for the path of the file that defines them.
Source preprocess(const std::string& path, const ReadFile& read,
                  const std::function<bool(const std::string&)>& keeps_names);

}  // namespace sundog::spmd
