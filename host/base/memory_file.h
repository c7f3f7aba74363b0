// A file that is in memory alone, for another process to read or write.
#pragma once
#include <string>

namespace sundog {

/// A descriptor of a file that holds `text`, read from its start; -1 where there can be none.
int memory_file(const std::string& text);

}  // namespace sundog
