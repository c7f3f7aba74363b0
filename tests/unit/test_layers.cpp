// The layers of host/README.md: no include runs backwards.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "catch.h"

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// What each layer may include besides itself; "shared" are the structs of kernels/shared.
const std::map<std::string, Names> allowed = {
    {"base", {}},
    {"scene", {"base", "shared"}},
    {"compile", {"base", "scene", "shared"}},
    {"device", {"base"}},
    {"render", {"base", "scene", "compile", "device", "shared"}},
    {"bench", {"base", "scene", "compile", "device", "render", "shared"}},
    {"mpi", {"render"}},
    {"app", {"base", "scene", "compile", "device", "render", "bench", "shared"}},
};

struct Include {
  std::string file, layer, path;
};

std::vector<Include> host_includes() {
  const fs::path host = fs::path(SUNDOG_SOURCE_DIR) / "host";
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(host)) {
    const fs::path relative = fs::relative(entry.path(), host);
    if (!entry.is_regular_file() ||
        !std::regex_match(relative.extension().string(), std::regex(R"(\.(cpp|h|hpp))")))
      continue;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);)
      if (std::regex_search(line, match, pattern))
        includes.push_back({relative.string(), relative.begin()->string(), match[1]});
  }
  return includes;
}

}  // namespace

TEST_CASE("a layer includes only the layers to its left") {
  const auto includes = host_includes();
  REQUIRE(includes.size() > 50);
  for (const auto& [file, layer, path] : includes) {
    INFO(file << " includes " << path);
    REQUIRE(allowed.count(layer) == 1);
    const std::string target = path.substr(0, path.find('/'));
    if (target == path || target == layer) continue;
    if (allowed.count(target) == 1 || target == "shared") CHECK(allowed.at(layer).count(target) == 1);
  }
}

TEST_CASE("OpenCL is spoken in the device layer alone") {
  for (const auto& [file, layer, path] : host_includes())
    if (path.starts_with("CL/")) {
      INFO(file << " includes " << path);
      CHECK(layer == "device");
    }
}
