// What the layers below the program leave alone: other programs own the process.
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

const fs::path host = fs::path(SUNDOG_SOURCE_DIR) / "host";

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// The headers that a header brings in, its own and others', each once.
std::set<std::string> included_by(const std::string& header) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::set<std::string> all;
  std::vector<std::string> open{header};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!all.insert(next).second) continue;
    for (const fs::path& folder : {host, fs::path(SUNDOG_SOURCE_DIR) / "kernels"}) {
      if (!fs::exists(folder / next)) continue;
      std::smatch match;
      for (const std::string& line : lines_of(folder / next))
        if (std::regex_search(line, match, pattern)) open.push_back(match[1]);
    }
  }
  return all;
}

}  // namespace

TEST_CASE("the headers of a render and a session hold values: no OpenCL, no JSON, no store of tunings") {
  for (const char* header : {"render/render.h", "render/session/render_session.h"}) {
    const std::set<std::string> all = included_by(header);
    CAPTURE(header);
    CHECK(all.size() > 20);
    for (const std::string& name : all) {
      CAPTURE(name);
      CHECK_FALSE(name.starts_with("CL/"));
      CHECK_FALSE(name.starts_with("nlohmann/"));
      CHECK_FALSE(name.starts_with("tbb/"));
      CHECK(name != "device/device.h");
      CHECK(name != "render/device/tuning.h");
    }
  }
}

TEST_CASE("code below the program neither prints nor ends, starts or steers the process") {
  // What is left, each for the reason beside it.
  const std::map<std::string, std::string> known = {
      {"base/arguments.cpp", "exit"},           // of the command line's options: the program calls it
      {"base/standard_streams.cpp", "signal"},  // the same, of pictures to the standard output
      {"base/spawn_self.cpp", "posix_spawn"},   // workers, which the program alone asks for
      {"device/device.cpp", "abort"},           // a fault on demand
      {"device/pocl_folder.cpp", "atexit"},     // takes PoCL's folder away
      {"render/device/device_server.cpp", "setpriority"},  // of its own thread
  };
  const std::regex calls(
      R"((^|[^\w.>:])(?:std::|::|fmt::)?(printf|fprintf|print|puts|_exit|exit|quick_exit|abort|signal|sigaction|setpriority|setrlimit|pthread_sigmask|sigprocmask|atexit|posix_spawn|fork|system|popen)\()");
  const std::regex streams(R"(std::(cout|cerr|clog)\b)");
  int sources = 0;
  for (const char* layer : {"base", "scene", "compile", "device", "render", "api"})
    for (const auto& entry : fs::recursive_directory_iterator(host / layer)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".cpp" && extension != ".h") continue;
      ++sources;
      const std::string file = fs::relative(entry.path(), host).string();
      const auto exception = known.find(file);
      std::smatch match;
      for (const std::string& line : lines_of(entry.path())) {
        if (line.find("//") < line.find_first_not_of(" /") || line.find("virtual") != std::string::npos)
          continue;
        CAPTURE(file, line);
        CHECK_FALSE(std::regex_search(line, streams));
        if (std::regex_search(line, match, calls))
          CHECK((exception != known.end() && exception->second == match[2]));
      }
    }
  CHECK(sources > 200);
}
