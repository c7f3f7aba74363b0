// Anonymous files in memory that another process can read or write.
#pragma once
#include <string>

namespace sundog {

/// Returns a descriptor of a file that holds `text`, positioned at its start; -1 if that fails.
int memory_file(const std::string& text);

}  // namespace sundog
