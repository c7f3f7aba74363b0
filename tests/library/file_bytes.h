// A file's bytes, without the host's headers.
#pragma once
#include <fstream>
#include <iterator>
#include <string>

#include "catch.h"

inline std::string file_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file.good());
  return {std::istreambuf_iterator<char>(file), {}};
}
