// Leaves out plain C++ at large sizes, then frames, then sizes, until the plan fits.
#include "bench/frames/thread_budget.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace sundog {
namespace {

constexpr double opening_seconds = 0.3;  // of a device, with its kernels from the cache
constexpr double most_of_plain = 1.0 / 3;
constexpr int warm_ups = 2, least_repeat = 3;

double pixels(int size) { return static_cast<double>(size) * size; }

double plain_total(const ThreadScaling& plan) {
  double sum = 0;
  for (const int size : plan.sizes) sum += plain_seconds(plan, size);
  return sum;
}

}  // namespace

double frame_seconds(const ThreadScaling& plan, int size, unsigned threads) {
  return pixels(size) * plan.cost.device / std::min(threads, std::max(plan.cores, 1u));
}

double plain_seconds(const ThreadScaling& plan, int size) {
  return plan.plain && size <= plan.greatest_plain_size ? pixels(size) * plan.cost.plain : 0;
}

double expected_seconds(const ThreadScaling& plan) {
  double sum = plain_total(plan);
  for (const int size : plan.sizes)
    for (const unsigned count : plan.counts)
      sum += opening_seconds + (warm_ups + plan.repeat) * frame_seconds(plan, size, count);
  return sum;
}

std::vector<std::string> fit_into(ThreadScaling& plan, double seconds) {
  std::vector<std::string> left_out;
  const std::vector<int> all = plan.sizes;
  const int repeat = plan.repeat;
  const bool too_long = expected_seconds(plan) > seconds;
  for (auto size = all.rbegin();
       too_long && size != all.rend() && plain_total(plan) > most_of_plain * seconds; ++size)
    plan.greatest_plain_size = *size - 1;
  while (expected_seconds(plan) > seconds && plan.repeat > least_repeat) --plan.repeat;
  while (expected_seconds(plan) > seconds && plan.sizes.size() > 1) plan.sizes.pop_back();
  const auto dropped =
      std::vector<int>(all.begin() + static_cast<std::ptrdiff_t>(plan.sizes.size()), all.end());
  if (!dropped.empty())
    left_out.push_back(fmt::format("images of {} pixels a side", fmt::join(dropped, ", ")));
  if (const int most = plan.greatest_plain_size; plan.plain && most < plan.sizes.back())
    left_out.push_back(most < plan.sizes.front() ? std::string("plain C++")
                                                 : fmt::format("plain C++ above {} pixels a side", most));
  if (plan.repeat < repeat) left_out.push_back(fmt::format("{} of {} frames", repeat - plan.repeat, repeat));
  return left_out;
}

}  // namespace sundog
