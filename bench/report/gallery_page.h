// Writes a gallery as one page: pictures with the commands that made them. Plain values in, HTML out.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sundog {

struct GalleryPicture {
  std::string name;     // the scene's, without folder and extension
  std::string file;     // of the picture; relative to the page
  std::string command;  // that makes it
  int width = 0, height = 0, samples = 0;
  double seconds = 0;  // of the frame, without loading and building kernels
  std::vector<std::pair<std::string, std::uint64_t>> rays;  // by kind
};

struct Gallery {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // device, machine, version...
  std::vector<GalleryPicture> pictures;
};

/// An HTML page without scripts; it needs no files other than the pictures.
std::string gallery_html(const Gallery& gallery);

}  // namespace sundog
