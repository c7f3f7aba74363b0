// A gallery as one page: pictures with how they were made. Plain values in, text out.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sundog {

struct GalleryPicture {
  std::string name;     // the scene's, without folder and extension
  std::string file;     // of the picture, relative to the page
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

/// A page of HTML without scripts, which needs the pictures beside it and nothing else.
std::string gallery_html(const Gallery& gallery);

}  // namespace sundog
