// Compares files by device and inode and by resolved path. Outputs may share a pipe or device.
#include "app/render/output_files.h"

#include <fmt/format.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "app/options/option_values.h"
#include "app/process/environment.h"
#include "app/process/standard_streams.h"
#include "app/process/warnings.h"
#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

/// The absolute path, with links resolved as far as files exist.
fs::path place(const std::string& name) {
  std::error_code failed;
  const fs::path whole = fs::weakly_canonical(name, failed);
  return failed ? fs::path(name) : whole;
}

/// The identity of the file with that name; none if it does not exist.
std::optional<FileIdentity> identity(const std::string& name) {
  struct stat found{};
  if (name.empty() || ::stat(name.c_str(), &found) != 0) return std::nullopt;
  return FileIdentity{found.st_dev, found.st_ino};
}

constexpr double greatest_depth = 1e30;  // limit of --far

/// Whether the file is a device or pipe, where nothing can be overwritten.
bool holds_nothing(const std::string& name) {
  std::error_code failed;
  return fs::exists(name, failed) && !fs::is_regular_file(name, failed);
}

}  // namespace

std::string format_name(const PictureOptions& picture) {
  return is_standard_stream(picture.out) ? "picture." + picture.format : picture.out;
}

FileOptions file_options(const PictureOptions& picture) {
  return {picture.full_floats ? ExrColor::full : ExrColor::half,
          picture.color_space == "acescg" ? ExrSpace::acescg : ExrSpace::srgb, picture.bits, picture.dpi,
          picture.icc};
}

void end_depth(const PictureOptions& picture, AovImages& aovs) {
  if (picture.far.empty()) return;
  const auto depth = aovs.find("depth");
  if (depth == aovs.end())
    throw UsageError(
        fmt::format("--far {}: is for the AOV depth, which {} does not have: render it with --aov depth",
                    picture.far, picture.out));
  const auto far = static_cast<float>(parse_amount("--far", picture.far, greatest_depth));
  for (float& z : depth->second.data)
    if (std::isinf(z)) z = far;
}

void check_picture(const PictureOptions& picture, bool with_aovs) {
  const std::string name = format_name(picture);
  check_image_path(name, with_aovs);
  if (picture.full_floats && drops_alpha(name))
    throw UsageError(fmt::format("{}: --float is for .exr files", picture.out));
  if (picture.color_space != "srgb" && drops_alpha(name))
    throw UsageError(fmt::format("{}: --color-space is for .exr files", picture.out));
  if (picture.icc && !is_for_screens(name))
    throw UsageError(fmt::format("{}: --icc is for .png and .jpg files", picture.out));
  if (!picture.far.empty()) static_cast<void>(parse_amount("--far", picture.far, greatest_depth));
  if (picture.bits != 8 && !is_png(name))
    throw UsageError(fmt::format("{}: --bits is for .png files", picture.out));
  if (!is_standard_stream(picture.out)) return check_writable(picture.out);
  if (::isatty(STDOUT_FILENO))
    throw UsageError("-o -: the standard output is a terminal: send it to a file or a pipe");
}

void check_output_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  std::vector<ReadFile> read;
  for (const std::string& input : inputs)
    if (const auto found = identity(input); found && !is_standard_stream(input))
      read.push_back({input, *found});
  check_not_read(outputs, read);
  for (const std::string& output : outputs)  // also for files that do not exist yet
    for (const std::string& input : inputs)
      if (!output.empty() && !is_standard_stream(input) && !holds_nothing(output) &&
          place(output) == place(input))
        throw UsageError(
            fmt::format("{}: is read, and would be written over: give the output another name", output));
  for (std::size_t i = 0; i < outputs.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (!outputs[i].empty() && !outputs[k].empty() && !holds_nothing(outputs[i]) &&
          place(outputs[i]) == place(outputs[k]))
        throw UsageError(fmt::format("{}: is the name of two outputs: give each its own", outputs[i]));
}

void check_not_read(const std::vector<std::string>& outputs, const std::vector<ReadFile>& files) {
  for (const std::string& output : outputs) {
    const auto written = identity(output);
    if (!written || holds_nothing(output)) continue;
    const auto found = std::ranges::find(files, *written, &ReadFile::identity);
    if (found == files.end()) continue;
    const std::string name = found->path.lexically_normal().string();
    const bool link = fs::path(output).filename() != found->path.filename();
    throw UsageError(fmt::format("{}: {}is read, and would be written over: give the output another name",
                                 output, link ? "is a link to " + name + ", which " : ""));
  }
}

SceneDescription load_for_command(const std::string& scene, const std::vector<std::string>& overrides,
                                  LoadOptions options, const std::vector<std::string>& outputs) {
  options.environment = program_environment();
  return read_apart_from(outputs, [&] { return load_scene(scene, overrides, options); });
}

void warn_of_halves(const std::filesystem::path& path, const Image& image, const FileOptions& file) {
  if (drops_alpha(path) || file.color == ExrColor::full) return;
  const auto channels = static_cast<std::size_t>(image.channels);
  std::size_t cut = 0;
  for (std::size_t i = 0; i < image.data.size(); i += channels)
    cut +=
        std::any_of(&image.data[i], &image.data[i] + 3, [](float v) { return std::abs(v) > greatest_half; });
  if (cut > 0)
    print_warnings(
        {{fmt::format("{}: {} pixels are brighter than {}, the most that half floats hold, and are "
                      "cut off there: write 32-bit floats with --float",
                      path.string(), cut, greatest_half)}});
}

}  // namespace sundog
