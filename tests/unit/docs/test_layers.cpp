// The layers of host/README.md and kernels/README.md: no include runs backwards.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "catch.h"

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// The layers that each layer may include besides itself; "shared" are the structs of kernels/shared.
const std::map<std::string, Names> allowed = {
    {"base", {}},
    {"formula", {"base"}},
    {"models", {"base", "shared"}},
    {"scene", {"base", "formula", "models", "shared"}},
    {"compile", {"base", "formula", "models", "scene", "shared"}},
    {"lanes", {"base"}},
    {"device", {"base", "lanes"}},
    {"render", {"base", "scene", "compile", "device", "shared"}},
    {"bench", {"base", "scene", "compile", "device", "render", "shared"}},
    {"api", {"base", "scene", "compile", "device", "render", "shared"}},
    {"mpi", {"render"}},
    {"app",
     {"base", "formula", "models", "scene", "compile", "lanes", "device", "render", "bench", "shared"}},
};

/// The folders of a layer in their order: each includes only itself and those before it. Files of the layer's
/// own folder come after all of them.
const std::map<std::string, std::vector<std::string>> folders = {
    {"host/render", {"values", "film", "plan", "device", "frame", "remote", "session"}},
    {"bench",
     {"plain", "report", "runs", "rays", "roofline", "frames", "quality", "tune", "commands", "peers"}},
    {"host/app", {"process", "options", "job", "render", "bake", "commands", "serve"}},
    {"kernels/lib", {"core", "solids", "sdf", "trace", "path", "shade", "whitted", "pathtracer"}},
};

struct Include {
  std::string file, layer, path;
};

/// The commands of benchmarks belong to the program.
std::string layer_of(const std::string& path) {
  return path.starts_with("bench/commands/") ? "app" : path.substr(0, path.find('/'));
}

/// The includes of all sources below a folder of the project; `layer` is the first folder of `file`.
std::vector<Include> includes_below(const std::string& top) {
  const fs::path host = fs::path(SUNDOG_SOURCE_DIR) / top;
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(host)) {
    const fs::path relative = fs::relative(entry.path(), host);
    if (!entry.is_regular_file() ||
        !std::regex_match(relative.extension().string(), std::regex(R"(\.(cpp|h|hpp|cl))")))
      continue;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);)
      if (std::regex_search(line, match, pattern))
        includes.push_back({relative.string(), relative.begin()->string(), match[1]});
  }
  return includes;
}

/// The includes of all layers.
std::vector<Include> includes_of_layers() {
  std::vector<Include> includes = includes_below("host");
  for (Include& include : includes_below("bench")) {
    include.file = "bench/" + include.file;
    include.layer = layer_of(include.file);
    if (!include.file.starts_with("bench/peers/")) includes.push_back(std::move(include));
  }
  return includes;
}

}  // namespace

TEST_CASE("a layer includes only the layers to its left") {
  const auto includes = includes_of_layers();
  REQUIRE(includes.size() > 50);
  for (const auto& [file, layer, path] : includes) {
    INFO(file << " includes " << path);
    REQUIRE(allowed.count(layer) == 1);
    const std::string target = layer_of(path);
    if (target == path || target == layer) continue;
    if (allowed.count(target) == 1 || target == "shared") CHECK(allowed.at(layer).count(target) == 1);
  }
}

TEST_CASE("OpenCL is spoken in the device layer alone") {
  for (const auto& [file, layer, path] : includes_of_layers())
    if (path.starts_with("CL/")) {
      INFO(file << " includes " << path);
      CHECK(layer == "device");
    }
}

TEST_CASE("the headers of a render and a session hold values: no OpenCL, no JSON, no store of tunings") {
  std::map<std::string, Names> included;
  for (const auto& [file, layer, path] : includes_below("host")) included[file].insert(path);
  for (const char* header : {"render/render.h", "render/session/render_session.h"}) {
    Names all;
    std::vector<std::string> open{header};
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      if (all.insert(next).second) open.insert(open.end(), included[next].begin(), included[next].end());
    }
    CHECK(all.size() > 20);
    for (const std::string& name : all) {
      CAPTURE(header, name);
      CHECK_FALSE((name.starts_with("CL/") || name.starts_with("nlohmann/") || name.starts_with("tbb/")));
      CHECK((name != "device/device.h" && name != "render/device/tuning.h"));
    }
  }
}

TEST_CASE("a folder of a layer includes only the folders before it") {
  for (const auto& [layer, order] : folders) {
    const std::string name = layer.substr(layer.find('/') + 1);
    const auto place = [&](const std::string& folder) {
      return std::find(order.begin(), order.end(), folder) - order.begin();
    };
    for (const auto& [file, folder, path] : includes_below(layer)) {
      if (!path.starts_with(name + "/")) continue;
      INFO(layer << "/" << file << " includes " << path);
      const std::string target =
          path.substr(name.size() + 1, path.find('/', name.size() + 1) - name.size() - 1);
      if (file.find('/') != std::string::npos) REQUIRE(place(folder) < std::ssize(order));
      CHECK(place(file.find('/') == std::string::npos ? "" : folder) >= place(target));
    }
  }
}

TEST_CASE("no folder has more sources than a reader takes in") {
  std::map<std::string, int> count;
  for (const char* top : {"host", "kernels", "bench"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(SUNDOG_SOURCE_DIR) / top)) {
      const std::string kind = entry.path().extension().string();
      if (kind == ".cpp" || kind == ".cl" ||
          (kind == ".h" && !fs::exists(fs::path(entry.path()).replace_extension(".cpp"))))
        ++count[fs::relative(entry.path().parent_path(), SUNDOG_SOURCE_DIR).string()];
    }
  for (const auto& [folder, files] : count) {
    INFO(folder);
    CHECK(files <= 24);
  }
}
