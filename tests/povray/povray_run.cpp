// Starts POV-Ray on a scene's text and parses the figures that it prints.
#include "povray_run.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <regex>
#include <stdexcept>

#include "base/file.h"
#include "base/image_io.h"

namespace sundog::povray {

namespace {

// The first group of `pattern` in `text` as a number; 0 when it does not occur.
double figure(const std::string& text, const char* pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? std::stod(match[1]) : 0;
}

}  // namespace

std::string installed_version() {
  const auto close = [](std::FILE* file) { pclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> pipe(popen("povray --version 2>&1", "r"), close);
  std::string out;
  std::array<char, 256> part;
  while (pipe && std::fgets(part.data(), part.size(), pipe.get())) out += part.data();
  std::smatch match;
  return std::regex_search(out, match, std::regex("POV-Ray ([0-9][0-9.]*)")) ? match[1].str() : "";
}

Run run(const std::string& scene, int width, int height, int threads, const std::filesystem::path& folder,
        const std::string& name) {
  std::filesystem::create_directories(folder);
  const auto file = [&](const char* extension) { return (folder / (name + extension)).string(); };
  write_file(file(".pov"), scene);
  const std::string command =
      fmt::format("povray '+I{}' '+O{}' +W{} +H{} +WT{} -D -A +FN16 File_Gamma=1.0 > '{}' 2>&1", file(".pov"),
                  file(".png"), width, height, threads, file(".log"));
  const int status = std::system(command.c_str());
  const std::string log = read_file(file(".log"));
  if (status != 0)
    throw std::runtime_error("POV-Ray failed on " + file(".pov") + ":\n" +
                             log.substr(log.size() - std::min<std::size_t>(log.size(), 1500)));
  Run result;
  result.image = read_image(file(".png"));  // the file says that it is linear
  const std::string time = R"([^(]*\(([0-9.]+) seconds\))";
  result.seconds = figure(log, ("Trace Time:" + time).c_str());
  result.parse_seconds = figure(log, ("Parse Time:" + time).c_str());
  result.cpu_seconds =
      figure(log, R"(Trace Time:[^(]*\([0-9.]+ seconds\)\s+using \d+ thread\(s\) with ([0-9.]+) CPU)");
  result.rays = static_cast<std::uint64_t>(figure(log, R"(\nRays:\s+(\d+))"));
  result.shadow_tests = static_cast<std::uint64_t>(figure(log, R"(Shadow Ray Tests:\s+(\d+))"));
  return result;
}

}  // namespace sundog::povray
