// Converts kernels/plain/halo to lanes, which host/compile/halo compiles as C++. Arguments: the folder of
// kernels, the file to write. The build runs it.
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "lanes/lanes.h"

int main(int argc, char** argv) try {
  if (argc != 3) return 1;
  const auto read = [&](const std::string& path) {
    std::ifstream file(std::string(argv[1]) + "/" + path);
    if (!file) throw std::runtime_error("no file " + path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  std::ofstream out(argv[2]);
  out << sundog::spmd::Lanes(read).text("plain/halo/trace.cl", false);
  return out.flush() ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
