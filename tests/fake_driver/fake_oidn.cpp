// A denoiser with the C interface of Open Image Denoise, version 1.4 or 2: the output is color + albedo +
// normal, four times as bright where "hdr" or "cleanAux" was not set; without color, twice albedo or normal.
// It fails where color is above 1000, and where its memory is not limited.
#include <cstddef>
#include <cstring>
#include <string>

namespace {

struct Plane {
  char* pixels = nullptr;
  std::size_t width = 0, height = 0, stride = 0;
  float* at(std::size_t i) const { return reinterpret_cast<float*>(pixels + i * stride); }
};

Plane color, albedo, normal, output;
bool hdr = false, clean_features = false, failed = false;
int most_memory = 0;  // MiB
int device_object = 0, filter_object = 0;

}  // namespace

extern "C" {
void* oidnNewDevice(int) { return &device_object; }
void oidnCommitDevice(void*) {}
void oidnReleaseDevice(void*) {}
int oidnGetDeviceError(void*, const char** message) {
  if (!failed) return 0;
  *message = "the fake denoiser fails";
  return 1;
}
void* oidnNewFilter(void*, const char*) {
  color = albedo = normal = output = {};
  hdr = clean_features = false;
  return &filter_object;
}
void oidnReleaseFilter(void*) {}
void oidnSetSharedFilterImage(void*, const char* name, void* pixels, int, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t stride, std::size_t) {
  const std::string text = name;
  Plane& plane = text == "color" ? color : text == "albedo" ? albedo : text == "normal" ? normal : output;
  plane = {static_cast<char*>(pixels) + offset, width, height, stride ? stride : 12};
}
void oidnSetFilterBool(void*, const char* name, bool value) {
  if (std::strcmp(name, "hdr") == 0) hdr = value;
  if (std::strcmp(name, "cleanAux") == 0) clean_features = value;
}
void oidnSetFilterInt(void*, const char* name, int value) {
  if (std::strcmp(name, "maxMemoryMB") == 0) most_memory = value;
}
void oidnCommitFilter(void*) {}
void oidnExecuteFilter(void*) {
  const auto value = [](const Plane& plane, std::size_t i, int c) {
    return plane.pixels ? plane.at(i)[c] : 0;
  };
  const float times = !color.pixels ? 2.0f : hdr && clean_features ? 1.0f : 4.0f;
  for (std::size_t i = 0; i < output.width * output.height; ++i)
    for (int c = 0; c < 3; ++c) {
      failed = failed || value(color, i, c) > 1000 || most_memory <= 0;
      output.at(i)[c] = (value(color, i, c) + value(albedo, i, c) + value(normal, i, c)) * times;
    }
}
}
