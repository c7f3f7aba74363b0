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

const fs::path root = SUNDOG_SOURCE_DIR, host = root / "host";

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
    for (const fs::path& folder : {host, root, root / "kernels"}) {
      if (!fs::exists(folder / next)) continue;
      std::smatch match;
      for (const std::string& line : lines_of(folder / next))
        if (std::regex_search(line, match, pattern)) open.push_back(match[1]);
    }
  }
  return all;
}

const std::vector<std::string> layers_below = {"base",    "formula", "models", "scene",
                                               "compile", "device",  "render", "api"};

/// Calls f(file, line) for each line of code of the layers' sources.
template <class F>
void for_each_line(const std::vector<std::string>& layers, const F& f) {
  int sources = 0;
  for (const std::string& layer : layers)
    for (const auto& entry :
         fs::recursive_directory_iterator(layer == "bench" ? root / layer : host / layer)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".cpp" && extension != ".h") continue;
      ++sources;
      if (entry.path().string().find("/bench/peers/") != std::string::npos) continue;
      const std::string file = fs::relative(entry.path(), host).string();
      for (const std::string& line : lines_of(entry.path())) {
        if (line.find("//") <= line.find_first_not_of(" /") || line.find("virtual") != std::string::npos)
          continue;
        f(file, line.substr(0, line.find("  // ")));
      }
    }
  CHECK(sources > 15);
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
  const std::regex calls(
      R"((^|[^\w.>:])(?:std::|::|fmt::)?(printf|fprintf|print|puts|_exit|exit|quick_exit|abort|terminate|raise|signal|sigaction|setpriority|setrlimit|pthread_sigmask|sigprocmask|atexit|posix_spawn|posix_spawnp|fork|vfork|execv|execve|execvp|system|popen)\()");
  const std::regex streams(R"(std::(cout|cerr|clog)\b)");
  for_each_line(layers_below, [&](const std::string& file, const std::string& line) {
    CAPTURE(file, line);
    CHECK_FALSE(std::regex_search(line, streams));
    // Only the end of the process tells the library that no call of the program's follows.
    if (file == "api/devices.cpp" && line.find("std::atexit(") != std::string::npos) return;
    CHECK_FALSE(std::regex_search(line, calls));
  });
}

TEST_CASE("variables of the process are read by the program, and in one source below it") {
  const std::regex reads(R"(\b(getenv|secure_getenv|environ)\b)");
  std::set<std::string> readers;
  for_each_line(layers_below, [&](const std::string& file, const std::string& line) {
    if (std::regex_search(line, reads)) readers.insert(file);
  });
  CHECK(readers == std::set<std::string>{"base/environment.cpp"});
  for_each_line({"bench"}, [&](const std::string& file, const std::string& line) {
    CAPTURE(file, line);
    CHECK_FALSE(std::regex_search(line, reads));
  });
  // Who asks for it: the program, and the library for the programs that use it.
  std::set<std::string> callers;
  const std::regex asks(R"(\bplain_environment\(|HostEnvironment environment = read_environment\()");
  for_each_line({"base", "formula", "models", "scene", "compile", "device", "render", "api", "bench", "app"},
                [&](const std::string& file, const std::string& line) {
                  if (std::regex_search(line, asks) && !file.starts_with("base/")) callers.insert(file);
                });
  CHECK(callers == std::set<std::string>{"api/devices.cpp", "app/process/environment.cpp"});
}

TEST_CASE("code below the program names no option") {
  const std::regex literal(R"--("([^"\\]|\\.)*")--"), option(R"(["` (]--[a-z])");
  for_each_line(layers_below, [&](const std::string& file, const std::string& line) {
    CAPTURE(file, line);
    for (std::sregex_iterator it(line.begin(), line.end(), literal), end; it != end; ++it)
      CHECK_FALSE(std::regex_search(it->str(), option));
  });
}

TEST_CASE("nothing below the program changes that outlives what it belongs to") {
  const std::regex mutable_state(
      R"(^\s*(static|thread_local|inline)\b(?!.*\b(const|constexpr|namespace)\b)(?![^={]*\()[^;{=]*[;{=]|^(std::atomic|std::mutex|std::vector|std::string|std::optional|int|bool|unsigned|double)\b[^()]*[;{=]|\bonce_flag|\bthread_local\b)");
  for_each_line(layers_below, [&](const std::string& file, const std::string& line) {
    // Readers of files have no owner in common: who wants to know what is read adds a log of its own and
    // takes it away.
    if (file == "base/input.cpp" && line == "    static ReadLogs logs;") return;
    CAPTURE(file, line);
    CHECK_FALSE(std::regex_search(line, mutable_state));
  });
}

TEST_CASE("threads below the program are joined, by their owner or by who takes them over") {
  std::set<std::string> detaching;
  for_each_line(layers_below, [&](const std::string& file, const std::string& line) {
    if (line.find("detach(") != std::string::npos) detaching.insert(file);
  });
  // A driver's that hangs.
  CHECK(detaching == std::set<std::string>{"base/driver_threads.cpp"});
}
