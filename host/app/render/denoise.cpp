// Loads the library's C interface with dlopen(); versions 1.4 and 2 differ in two names. Denoises albedo and
// normal first, then the colours with their help, and alpha like a colour.
#include "app/render/denoise.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/film/frame_memory.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

constexpr const char* file_names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1"};
constexpr int cpu_device = 1, three_floats = 3;  // OIDN_DEVICE_TYPE_CPU, OIDN_FORMAT_FLOAT3

/// Possible paths of the library, best first.
std::vector<std::string> candidates() {
  const char* named = std::getenv("SUNDOG_OIDN");
  if (!named || !*named) return {std::begin(file_names), std::end(file_names)};
  std::error_code none;
  if (!fs::is_directory(named, none)) return {named};
  std::vector<std::string> files;
  for (const char* file : file_names) files.push_back((fs::path(named) / file).string());
  return files;
}

void* load_library() {
  std::string why;
  for (const std::string& file : candidates()) {
    if (void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
    why = why.empty() ? ::dlerror() : why;
  }
  throw UsageError(
      fmt::format("--denoise needs Intel's Open Image Denoise: {}. Get it from "
                  "https://www.openimagedenoise.org, or with `pip install --target FOLDER pyoidn`, and set "
                  "SUNDOG_OIDN to the folder of libOpenImageDenoise.so.2 (FOLDER/pyoidn/oidn/lib)",
                  why));
}

}  // namespace

struct Denoiser::Calls {
  using Device = void*;
  using Filter = void*;
  Device (*new_device)(int type);
  void (*commit_device)(Device);
  int (*get_error)(Device, const char** message);
  void (*release_device)(Device);
  Filter (*new_filter)(Device, const char* type);
  void (*set_image)(Filter, const char* name, void* pixels, int format, std::size_t width, std::size_t height,
                    std::size_t offset, std::size_t pixel_stride, std::size_t row_stride);
  void (*set_bool)(Filter, const char* name, bool value);
  void (*set_int)(Filter, const char* name, int value);
  void (*commit_filter)(Filter);
  void (*execute_filter)(Filter);
  void (*release_filter)(Filter);

  /// Throws the error that the library reports, if any.
  void check(Device device) const {
    const char* message = nullptr;
    if (get_error(device, &message) != 0)
      throw std::runtime_error(fmt::format("Open Image Denoise: {}", message ? message : "unknown error"));
  }
};

namespace {

template <class Function>
void find(void* library, const char* name, Function*& function, const char* other_name = nullptr) {
  void* symbol = ::dlsym(library, name);
  if (!symbol && other_name) symbol = ::dlsym(library, other_name);
  if (!symbol)
    throw UsageError(fmt::format(
        "--denoise: the library that was loaded is no Open Image Denoise of version 1 or 2: it has no {}",
        name));
  function = reinterpret_cast<Function*>(symbol);
}

}  // namespace

Denoiser::Denoiser() {
  void* library = load_library();
  auto calls = std::make_shared<Calls>();
  find(library, "oidnNewDevice", calls->new_device);
  find(library, "oidnCommitDevice", calls->commit_device);
  find(library, "oidnGetDeviceError", calls->get_error);
  find(library, "oidnReleaseDevice", calls->release_device);
  find(library, "oidnNewFilter", calls->new_filter);
  find(library, "oidnSetSharedFilterImage", calls->set_image);
  find(library, "oidnSetFilterBool", calls->set_bool, "oidnSetFilter1b");
  find(library, "oidnSetFilterInt", calls->set_int, "oidnSetFilter1i");
  find(library, "oidnCommitFilter", calls->commit_filter);
  find(library, "oidnExecuteFilter", calls->execute_filter);
  find(library, "oidnReleaseFilter", calls->release_filter);
  calls_ = std::move(calls);
}

Image Denoiser::clean(std::initializer_list<Input> inputs, std::initializer_list<const char*> flags) const {
  const Calls& call = *calls_;
  const std::shared_ptr<void> device(call.new_device(cpu_device), call.release_device);
  if (!device) call.check(nullptr);
  call.commit_device(device.get());
  call.check(device.get());
  const std::shared_ptr<void> filter(call.new_filter(device.get(), "RT"), call.release_filter);
  const Image& first = inputs.begin()->image;
  const auto width = static_cast<std::size_t>(first.width), height = static_cast<std::size_t>(first.height);
  Image clean(first.width, first.height, 3);
  const auto give = [&](const char* name, const Image& from) {  // only "output" is written to
    call.set_image(filter.get(), name, const_cast<float*>(from.data.data()), three_floats, width, height, 0,
                   sizeof(float) * static_cast<std::size_t>(from.channels), 0);
  };
  for (const Input& input : inputs) give(input.name, input.image);
  give("output", clean);
  for (const char* flag : flags) call.set_bool(filter.get(), flag, true);
  call.set_int(filter.get(), "maxMemoryMB", static_cast<int>(most_denoiser_bytes >> 20));
  call.commit_filter(filter.get());
  call.execute_filter(filter.get());
  call.check(device.get());
  return clean;
}

// Albedo and normal are noisy behind glass, so they are denoised first; their noise would stay otherwise.
void Denoiser::denoise(Image& image, const Image& albedo, const Image& normal) const {
  const auto channels = static_cast<std::size_t>(image.channels);
  const Image clean_albedo = clean({{"albedo", albedo}}, {}), clean_normal = clean({{"normal", normal}}, {});
  const auto clean_color = [&](const Image& color) {
    return clean({{"color", color}, {"albedo", clean_albedo}, {"normal", clean_normal}}, {"hdr", "cleanAux"});
  };
  const Image colors = clean_color(image);
  if (channels == 4) {
    Image alpha(image.width, image.height, 3);
    for (std::size_t i = 0; i < alpha.data.size(); ++i) alpha.data[i] = image.data[i / 3 * 4 + 3];
    if (std::ranges::any_of(alpha.data, [&](float a) { return a != alpha.data[0]; }))
      alpha = clean_color(alpha);
    for (std::size_t pixel = 0; pixel < alpha.data.size() / 3; ++pixel)
      image.data[4 * pixel + 3] = std::clamp(alpha.data[3 * pixel], 0.0f, 1.0f);
  }
  for (std::size_t i = 0; i < colors.data.size(); ++i) image.data[i / 3 * channels + i % 3] = colors.data[i];
}

}  // namespace sundog
