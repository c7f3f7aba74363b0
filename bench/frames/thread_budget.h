// How long `bench threads` will take, and what to leave out where that is too long. Pure arithmetic.
#pragma once
#include <string>
#include <vector>

#include "bench/frames/thread_scaling.h"

namespace sundog {

/// Seconds that one frame of the size takes on so many threads, by what a pixel costs.
double frame_seconds(const ThreadScaling& plan, int size, unsigned threads);
double plain_seconds(const ThreadScaling& plan, int size);

/// Seconds that measure_threads() will take.
double expected_seconds(const ThreadScaling& plan);

/// Makes the plan take `seconds` at most, as far as it can: plain C++ at the smaller sizes only, so that it
/// takes a third of the time at most; then fewer frames, three at least; then fewer sizes, one at least.
/// Returns what was left out, a phrase each.
std::vector<std::string> fit_into(ThreadScaling& plan, double seconds);

}  // namespace sundog
