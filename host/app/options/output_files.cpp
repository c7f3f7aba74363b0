// See output_files.h.
#include "app/options/output_files.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "app/process/save_image.h"
#include "app/process/standard_streams.h"
#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// Links followed as far as there are files.
fs::path place(const std::string& name) {
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(name, failed);
  return failed ? fs::path(name) : whole;
}

/// Devices and pipes: nothing in them is written over.
bool holds_nothing(const std::string& name) {
  std::error_code failed;
  return fs::exists(name, failed) && !fs::is_regular_file(name, failed);
}

}  // namespace

std::string format_name(const PictureOptions& picture) {
  return is_standard_stream(picture.out) ? "picture." + picture.format : picture.out;
}

std::vector<std::string> made_aovs(const RenderCommand& command) {
  std::vector<std::string> aovs = command.aovs;
  if (command.denoise)
    for (const char* wanted : {"albedo", "normal"})
      if (std::ranges::count(aovs, wanted) == 0) aovs.emplace_back(wanted);
  return aovs;
}

void check_picture(const PictureOptions& picture, bool with_aovs) {
  const std::string name = format_name(picture);
  check_image_path(name, with_aovs);
  if (picture.full_floats && drops_alpha(name))
    throw UsageError(fmt::format("{}: --float is for .exr files", picture.out));
  if (!is_standard_stream(picture.out)) return check_writable(picture.out);
  if (::isatty(STDOUT_FILENO))
    throw UsageError("-o -: the standard output is a terminal: send it to a file or a pipe");
}

void check_output_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty() || holds_nothing(outputs[i])) continue;
    for (const std::string& input : inputs)
      if (!is_standard_stream(input) && place(outputs[i]) == place(input))
        throw UsageError(
            fmt::format("{}: is read, and would be written over: give the output another name", outputs[i]));
    for (std::size_t k = 0; k < i; ++k)
      if (!outputs[k].empty() && place(outputs[i]) == place(outputs[k]))
        throw UsageError(fmt::format("{}: is the name of two outputs: give each its own", outputs[i]));
  }
}

}  // namespace sundog
