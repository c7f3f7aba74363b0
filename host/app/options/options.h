// The options of commands as values, checked as far as possible without reading files.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/options/frames.h"
#include "render/values/options.h"

namespace sundog {

/// A picture that a command writes.
struct PictureOptions {
  std::string out;                          // "-": the standard output
  std::string format;                       // for the standard output, one of image_formats()
  bool full_floats = false;                 // an EXR's colours as 32-bit floats
  std::map<std::string, std::string> tone;  // keys of /image/tone_map, as typed; empty: the scene's setting
  bool no_dither = false;
  int dpi = 72;                      // pixels per inch, for printers
  std::string color_space = "srgb";  // EXR: srgb or acescg
  int bits = 8;                      // PNG: bits per channel, 8 or 16
  bool icc = false;                  // PNG, JPEG: with an ICC profile
  std::string far;                   // as typed: the depth where nothing is hit; empty: infinite
  bool transparent = false;          // a PNG keeps alpha
};

/// A moment while a frame's shutter is open, with its share of the samples and their seed.
struct Moment {
  double frame = 0;
  int samples = 1, seed = 0;
};

struct RenderCommand : PictureOptions {
  std::string scene;
  std::vector<std::string> devices;    // SPECs from --device, else from SUNDOG_DEVICE
  std::vector<std::string> overrides;  // "JSON_POINTER=VALUE", including those from --size, --samples...
  WorkGroup work_group;
  Split split;
  std::optional<PartOfFrame> part;  // OUT is a part of the frame, not an image
  std::optional<Tile> region;       // part of the picture that OUT shows; none: all
  int tile = 0;
  double time_limit = 0, noise = 0, write_every = 0;  // 0: none
  std::vector<int> frames;                            // an animation's frames, with numbered files
  std::optional<double> frame;                        // the frame that is being rendered
  std::optional<Moment> moment;                       // that frame's moment, with motion blur
  bool skip_existing = false;                         // skip frames whose picture exists
  std::string stats, resume;                          // files; empty: none
  std::vector<std::string> aovs;
  bool denoise = false;        // denoise the finished picture
  bool metadata = false;       // write scene, settings, devices and program into the file
  bool isolate = false;        // run each device in its own process
  bool draft = false;          // use the kernels that all scenes share
  bool native_code = false;    // the scene may contain OpenCL C
  bool outside_files = false;  // the scene and its models may name files outside their folders
  bool quiet = false, verbose = false;
};

}  // namespace sundog
