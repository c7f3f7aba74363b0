// Estimates the memory that a frame takes in its process, for its film and outputs, and refuses frames that
// do not fit.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace sundog {

/// The outputs of a frame that take memory.
struct FrameOutput {
  std::string file;  // its extension selects the encoder; ".part": a part of the frame; empty: none
  std::vector<std::string> aovs;
  bool checkpoints = false;  // checkpoints are written
  int tile = 0;              // edge of the tiles; 0: small compared with the frame
  bool passes = false;       // rendered in passes (render/plan/passes.h)
  bool denoise = false;      // a denoiser runs, with at most most_denoiser_bytes
  int channels = 3;          // channels of the image
  int bits = 8;              // bits of a PNG's channel
};

/// The most memory that a denoiser may take, besides its input and output images.
constexpr std::uint64_t most_denoiser_bytes = std::uint64_t{1} << 30;

/// Peak bytes per pixel, while a checkpoint or the image is written; excludes the denoiser's own memory.
std::uint64_t bytes_a_pixel(const FrameOutput& output);

/// Throws std::runtime_error with the figures if a frame of this size needs more memory than is available.
void check_frame_memory(int width, int height, const FrameOutput& output);

}  // namespace sundog
