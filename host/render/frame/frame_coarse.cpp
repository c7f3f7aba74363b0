// The coarse passes of an interactive frame, which precede its own.
#include "render/frame/frame.h"

namespace sundog {

void begin_coarse(Frame& frame, int block) {
  frame.coarse.block = block;
  begin_pass(frame, block > 0 ? coarse_pass(frame.film.width, frame.film.height, block)
                              : next_pass(frame.film, frame.plan));
}

std::optional<Pass> finer_pass(Frame& frame) {
  CoarsePasses& coarse = frame.coarse;
  coarse.picture.take(frame.pass, frame.pass_film, frame.film.width, frame.film.height, coarse.block);
  ++coarse.count;
  const double blocks = static_cast<double>(coarse.picture.colors.size());
  coarse.pixel_seconds = expected_pixel_seconds(frame.since_pass.seconds() / blocks, coarse.pixel_seconds);
  coarse.block = next_block(coarse.block, coarse.pixel_seconds, frame.film.pixels());
  if (coarse.block == 0) return std::nullopt;
  return coarse_pass(frame.film.width, frame.film.height, coarse.block);
}

void measure_pixels(Frame& frame) {
  if (frame.film.stage == 0)
    frame.coarse.pixel_seconds = frame.since_pass.seconds() / static_cast<double>(frame.film.pixels());
}

}  // namespace sundog
