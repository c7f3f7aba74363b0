// `render --denoise`: Intel Open Image Denoise, loaded when it is asked for; sundog is not linked with it.
#pragma once
#include <initializer_list>
#include <memory>

#include "base/image.h"

namespace sundog {

/// The library, open until the end of the process.
class Denoiser {
 public:
  /// Loads the file or folder that SUNDOG_OIDN names, else the system's library, of version 2 or 1.4. Throws
  /// UsageError that says where to get it.
  Denoiser();

  /// Takes the noise from colours and alpha of `image` (3 or 4 channels, linear), by the first surfaces'
  /// albedo and normal (3 channels, of the same size). Throws std::runtime_error with the library's words.
  void denoise(Image& image, const Image& albedo, const Image& normal) const;

 private:
  struct Calls;
  struct Input {
    const char* name;
    const Image& image;
  };
  /// Returns the three channels of the first input without noise.
  Image clean(std::initializer_list<Input> inputs, std::initializer_list<const char*> flags) const;
  std::shared_ptr<const Calls> calls_;
};

}  // namespace sundog
