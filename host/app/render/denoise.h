// Denoises pictures for `render --denoise` with Intel Open Image Denoise, which is loaded on demand; sundog
// does not link to it.
#pragma once
#include <initializer_list>
#include <memory>

#include "base/image.h"

namespace sundog {

/// The library; it stays loaded until the process ends.
class Denoiser {
 public:
  /// Loads version 2 or 1.4 from the file or folder that SUNDOG_OIDN names, else from the system. Throws a
  /// UsageError that says where to get the library.
  Denoiser();

  /// Denoises the colours and alpha of `image` (3 or 4 channels, linear), guided by the first surfaces'
  /// albedo and normal (3 channels, same size). Throws std::runtime_error with the library's message.
  void denoise(Image& image, const Image& albedo, const Image& normal) const;

 private:
  struct Calls;
  struct Input {
    const char* name;
    const Image& image;
  };
  /// Returns the first three channels of the first input, denoised.
  Image clean(std::initializer_list<Input> inputs, std::initializer_list<const char*> flags) const;
  std::shared_ptr<const Calls> calls_;
};

}  // namespace sundog
