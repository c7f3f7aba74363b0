// The command line as values: what the user asked for, checked as far as it can be without reading a file.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/options/frames.h"
#include "render/values/options.h"

namespace sundog {

/// A picture that a command writes.
struct PictureOptions {
  std::string out;           // "-": the standard output
  std::string format;        // of image_formats(), for the standard output
  bool full_floats = false;  // an EXR's colours as 32-bit floats
  // As typed; empty: the scene's.
  std::string tone_curve, exposure, white_balance, contrast, vignette, bloom;
  bool no_dither = false;
  int dpi = 72;                      // pixels an inch, for printers
  std::string color_space = "srgb";  // of an EXR: srgb or acescg
  int bits = 8;                      // of a PNG's channels: 8 or 16
  bool icc = false;                  // a PNG or JPEG has an ICC profile
  std::string far;                   // as typed: the depth where nothing is; empty: infinite
  bool transparent = false;          // a PNG keeps alpha
};

/// A time while a frame's shutter is open: its share of the samples and their seed.
struct Moment {
  double frame = 0;
  int samples = 1, seed = 0;
};

struct RenderCommand : PictureOptions {
  std::string scene;
  std::vector<std::string> devices;    // --device SPECs, or those of SUNDOG_DEVICE
  std::vector<std::string> overrides;  // "JSON_POINTER=VALUE", those of --size, --samples... among them
  WorkGroup work_group;
  Split split;
  std::optional<PartOfFrame> part;  // OUT is a part of the frame, not an image
  std::optional<Tile> region;       // of the picture that OUT shows; none: all
  int tile = 0;
  double time_limit = 0, noise = 0, write_every = 0;  // 0: none
  std::vector<int> frames;                            // of an animation; the files are numbered
  std::optional<double> frame;                        // the one of them that is rendered now
  std::optional<Moment> moment;                       // of that frame, where its shutter is open
  bool skip_existing = false;                         // frames whose picture is there are left alone
  std::string stats, resume;                          // files; empty: none
  std::vector<std::string> aovs;
  bool denoise = false;        // the picture, when it is made
  bool metadata = false;       // the file says what it is of, and what made it
  bool isolate = false;        // each device in a process of its own
  bool draft = false;          // by kernels that all scenes share
  bool native_code = false;    // the scene may carry OpenCL C
  bool outside_files = false;  // the scene and its models may name files outside their folders
  bool quiet = false, verbose = false;
};

}  // namespace sundog
