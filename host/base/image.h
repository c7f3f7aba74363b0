// Image: an array of linear float pixels; the result of a render and the input of `compare`.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace sundog {

/// Linear colours, row 0 at the top, `channels` interleaved floats per pixel; size width*height*channels.
struct Image {
  int width = 0, height = 0, channels = 4;
  std::vector<float> data;

  Image() = default;
  Image(int w, int h, int c) : width(w), height(h), channels(c) {
    data.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c));
  }
  float* pixel(int x, int y) { return data.data() + offset(x, y); }
  const float* pixel(int x, int y) const { return data.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

/// An image's place in a larger picture: its upper left corner, and the larger picture's size.
struct Region {
  int x = 0, y = 0, whole_width = 0, whole_height = 0;
};

/// Named extra images of a render (`depth`, `normal`, ...), all of the beauty image's size.
using AovImages = std::map<std::string, Image>;

}  // namespace sundog
