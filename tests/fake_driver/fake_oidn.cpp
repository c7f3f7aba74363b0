// A denoiser with the C interface of Open Image Denoise, version 1 or 2: the output is color + albedo +
// normal, four times as bright where "hdr" was not set. It fails where color is above 1000, and where its
// memory is not limited.
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
bool hdr = false, failed = false;
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
void* oidnNewFilter(void*, const char*) { return &filter_object; }
void oidnReleaseFilter(void*) {}
void oidnSetSharedFilterImage(void*, const char* name, void* pixels, int, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t stride, std::size_t) {
  const std::string text = name;
  Plane& plane = text == "color" ? color : text == "albedo" ? albedo : text == "normal" ? normal : output;
  plane = {static_cast<char*>(pixels) + offset, width, height, stride ? stride : 12};
}
void oidnSetFilterBool(void*, const char* name, bool value) {
  if (std::strcmp(name, "hdr") == 0) hdr = value;
}
void oidnSetFilterInt(void*, const char* name, int value) {
  if (std::strcmp(name, "maxMemoryMB") == 0) most_memory = value;
}
void oidnCommitFilter(void*) {}
void oidnExecuteFilter(void*) {
  for (std::size_t i = 0; i < color.width * color.height; ++i)
    for (int c = 0; c < 3; ++c) {
      failed = failed || color.at(i)[c] > 1000 || most_memory <= 0;
      output.at(i)[c] = (color.at(i)[c] + albedo.at(i)[c] + normal.at(i)[c]) * (hdr ? 1.0f : 4.0f);
    }
}
}
