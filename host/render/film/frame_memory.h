// The memory that a frame takes in the process that has it: its film, and what is made of it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace sundog {

/// A frame's outputs, as far as they take memory.
struct FrameOutput {
  std::string file;  // its extension says what is encoded; ".part": a part of the frame; empty: nothing
  std::vector<std::string> aovs;
  bool checkpoints = false;  // written on the way
  int tile = 0;              // edge of the tiles; 0: they are small beside the frame
  bool passes = false;       // made in passes (render/plan/passes.h)
  bool denoise = false;      // with a denoiser that takes most_denoiser_bytes at most
  int channels = 3;          // of the image
  int bits = 8;              // of a PNG
};

/// The most memory that a denoiser may take, beside its input and output pictures.
constexpr std::uint64_t most_denoiser_bytes = std::uint64_t{1} << 30;

/// Bytes a pixel where most is taken: while a checkpoint is written, or the image; without a denoiser's own.
std::uint64_t bytes_a_pixel(const FrameOutput& output);

/// Throws std::runtime_error with the figures when a frame of that size takes more than there is.
void check_frame_memory(int width, int height, const FrameOutput& output);

}  // namespace sundog
