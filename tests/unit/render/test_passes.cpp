// Passes over a frame's samples: which pixels come next is arithmetic over the film, without any device.
#include "render/plan/passes.h"

#include <cmath>
#include <set>

#include "base/error.h"
#include "catch.h"
#include "render/film/checkpoint.h"
#include "render/plan/convergence.h"
#include "render/plan/pixel_rules.h"
#include "render/plan/subsample.h"
#include "shared/sampler.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr int width = 33, height = 18;

/// A pixel's sample: its value, the object seen there, and the rays that it takes.
struct MadeUpPixel {
  float value;
  int object;
  u32 rays = 1;
};

/// The film of a frame in passes.
Film growing(bool with_aovs, int high = height) {
  return {width, high, {.shows_surfaces = with_aovs, .grows = true, .keeps_earlier = true}};
}

/// Makes all pixels of a pass by `pixel(x, y, sample)`, as a device would.
template <class Pixel>
Film made(const Film& film, const Pass& pass, const Pixel& pixel) {
  Film result = film_of_pass(film, pass);
  for (std::size_t i = 0; i < result.done.size(); ++i) {
    result.done[i] = 1;
    const std::int64_t p = image_index(film, pass, i);
    if (p < 0) continue;
    const int x = static_cast<int>(p % width), y = static_cast<int>(p / width);
    if (pass.first_sample > 0) {
      result.sums[i] = film.sums[static_cast<std::size_t>(p)];
      result.weights[i] = film.weights[static_cast<std::size_t>(p)];
    }
    for (u32 s = pass.first_sample; s < pass.first_sample + pass.sample_count; ++s) {
      const float value = pixel(x, y, s).value;
      result.sums[i].x += value, result.sums[i].y += value, result.sums[i].z += value;
      result.weights[i] += 1;
      if (pass.costs) result.rays[i] += pixel(x, y, s).rays;
    }
    if (!pass.surfaces) continue;
    const auto object = static_cast<float>(pixel(x, y, 0).object);
    result.aovs[3 * i] = {0, 0, 1, 5};
    result.aovs[3 * i + 1] = {0, 0, 0, object};
    result.aovs[3 * i + 2] = {0.5f, 0.5f, 0.5f, object};
  }
  return result;
}

/// Runs all passes that come after `last`. Returns how many there were.
template <class Pixel>
int run(Film& film, const SamplingPlan& plan, const Pixel& pixel, Pass last = {}) {
  int passes = 0;
  while (const auto pass = next_pass(film, plan, last)) {
    REQUIRE(++passes < 100);
    add_pass(film, *pass, made(film, *pass, pixel), true);
    last = *pass;
  }
  return passes;
}

std::size_t at(int x, int y) { return static_cast<std::size_t>(y * width + x); }

SamplingPlan adaptive_plan(double threshold, u32 samples) {
  SamplingPlan plan;
  plan.settings.threshold = threshold;
  plan.samples = samples;
  return plan;
}

SamplingPlan subsampling_plan(u32 samples) {
  SamplingPlan plan;
  plan.settings.subsample = true;
  plan.samples = samples;
  return plan;
}

}  // namespace

TEST_CASE("a pass over a list holds each of its pixels once, in whole blocks") {
  for (const u32 count : {1u, 15u, 16u, 17u, 594u}) {
    std::vector<u32> listed;
    for (u32 i = 0; i < count; ++i) listed.push_back((i * 7) % width | (i * 5 % height) << 16);
    const Pass pass = list_pass(listed, 4, 4);
    CHECK(pixels_of(pass) == listed);
    CHECK(pass.width % 4 == 0);
    CHECK(pass.height % 4 == 0);
    std::multiset<u32> found;
    for (const u32 pixel : pass.pixels)
      if (pixel != NO_PIXEL) found.insert(pixel);
    CHECK(found == std::multiset<u32>(listed.begin(), listed.end()));
  }
}

TEST_CASE("a progressive frame doubles the samples of all pixels up to the number asked for") {
  SamplingPlan plan;
  plan.settings.progressive = true;
  plan.samples = 11;
  Film film = growing(false);
  const int passes = run(film, plan, [](int, int, u32 sample) { return MadeUpPixel{float(sample), 0}; });
  CHECK(passes == 5);  // 1, 2, 4, 8, 11
  for (std::size_t p = 0; p < film.taken.size(); ++p) {
    REQUIRE(film.taken[p] == 11);
    REQUIRE(film.sums[p].x == 55);
  }
}

TEST_CASE("a picture without noise gets the first samples alone, and an edge all of them") {
  const auto flat = [](int, int, u32) { return MadeUpPixel{0.5f, 1}; };
  Film film = growing(true);
  run(film, adaptive_plan(0.02, 64), flat);
  for (const u32 taken : film.taken) REQUIRE(taken == 1);

  const auto edge = [](int x, int, u32 sample) {  // noise in column 16 that does not go away
    const bool odd = (sample & (sample - 1)) == 0;
    return MadeUpPixel{x == 16 ? (odd ? 40.0f * float(sample) : 0.0f) : 0.5f, 1};
  };
  Film other = growing(true);
  run(other, adaptive_plan(0.02, 64), edge);
  for (int y = 0; y < height; ++y) {
    CHECK(other.taken[at(16, y)] == 64);
    CHECK(other.taken[at(2, y)] == 1);
    CHECK(other.taken[at(30, y)] == 1);
  }
}

TEST_CASE("neighbours with other objects get more samples though they have the same colour") {
  const auto two = [](int x, int, u32) { return MadeUpPixel{0.5f, x < 10 ? 1 : 2}; };
  Film film = growing(true);
  SamplingPlan plan = adaptive_plan(0.02, 64);
  plan.settings.surfaces = true;
  run(film, plan, two);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) CHECK(film.taken[at(x, y)] == (x == 9 || x == 10 ? 2 : 1));
}

TEST_CASE(
    "a pixel whose samples all fell on one side of an edge gets more, as its neighbours tell of the edge") {
  const auto step = [](int x, int, u32) { return MadeUpPixel{x < 10 ? 0.25f : 0.75f, 1}; };
  Film film = growing(false);
  run(film, adaptive_plan(0.02, 64), step);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const u32 taken = film.taken[at(x, y)];
      if (x == 9 || x == 10)
        CHECK(taken >= 8);
      else if (x < 7 || x > 12)
        CHECK(taken == 1);
      CHECK(taken < 64);  // no sample ever moves a pixel
    }
}

TEST_CASE("the expected error is that of the doublings, the last counting half, and falls with the samples") {
  // All pixels are equal: each moves by m1 with its second sample, by m2 with the third and fourth.
  const float m1 = 0.2f, m2 = 0.05f;
  const auto moving = [&](int, int, u32 sample) {
    const float sums[] = {1 - m1 - m2, 1 + m1 - m2, 1 + m2, 1 + m2};
    return MadeUpPixel{sums[sample], 1};
  };
  Film film = growing(false);
  SamplingPlan plan;
  plan.settings.progressive = true;
  plan.samples = 4;
  run(film, plan, moving);
  const auto square = [&](float moved, float at) { return 9 * moved * moved / std::sqrt(3 * at); };
  const float last = square(m2, 1), first = square(m1, 1 - m2);
  const std::vector<float> expected = expected_squares(film, all_pixels(width, height), 4);
  for (const float found : expected)
    CHECK(found == Approx((0.4 + 0.1) * (last + squares_of_doubling * first) / 2).epsilon(1e-4));
}

TEST_CASE("where blocks of pixels take more rays, more of the error must be at stake for each") {
  const float noise = 0.1f;  // the same everywhere, so that only rays tell pixels apart
  const auto dear_right = [&](int x, int y, u32 sample) {
    return MadeUpPixel{1 + noise * float((x + y + int(sample)) % 2), 1, x < 16 ? 1u : 9u};
  };
  const auto samples = [&](double threshold, bool costs) {
    Film film = growing(false);
    const SamplingPlan plan = adaptive_plan(threshold, 64);
    Pass first = *next_pass(film, plan);
    CHECK(first.costs);
    first.costs = costs;
    add_pass(film, first, made(film, first, dear_right), true);
    run(film, plan, dear_right, first);
    return std::pair(film.taken[at(8, 8)], film.taken[at(24, 8)]);
  };
  for (const double threshold : {0.03, 0.01, 0.003}) {
    const auto [left, right] = samples(threshold, false);
    const auto [cheap, dear] = samples(threshold, true);
    CHECK(left == right);
    CHECK(cheap >= left);
    CHECK(dear <= right);
    CHECK(dear < cheap);
  }
}

TEST_CASE("pixels that have found no rare bright light yet are not left darker than the others") {
  // One sample in sixteen is bright. A pixel that decides by its own change stops while it has seen none.
  const auto lit = [](int x, int y, u32 sample) {
    const u32 chance = hash_u32(sample + 4096 * hash_u32(static_cast<u32>(at(x, y) + 1)));
    return MadeUpPixel{chance % 16 == 0 ? 4.25f : 0.05f, 1};
  };
  const auto light_of = [&](SamplingPlan plan) {
    Film film = growing(false);
    run(film, plan, lit);
    double light = 0;
    for (std::size_t p = 0; p < film.pixels(); ++p) light += color_at(film, p).r;
    return light / static_cast<double>(film.pixels());
  };
  SamplingPlan even = adaptive_plan(0, 256), adaptive = adaptive_plan(0.5, 256);
  even.settings.progressive = true;
  adaptive.settings.first_samples = 4;
  CHECK(light_of(adaptive) < 0.9 * light_of(even));
  adaptive.noisy = true;
  CHECK(light_of(adaptive) == Approx(light_of(even)).epsilon(0.02));
}

TEST_CASE("a budget is kept, and the pixels of the largest errors get it") {
  const auto noisy = [](int x, int, u32 sample) {
    return MadeUpPixel{sample % 2 ? 0.5f : 0.5f + 0.1f * float(x), 1};
  };
  SamplingPlan plan = adaptive_plan(1e-4, 1024);
  plan.settings.budget = 3;
  Film film = growing(true);
  run(film, plan, noisy);
  double sum = 0;
  for (const u32 taken : film.taken) sum += taken;
  CHECK(sum <= 3.0 * width * height);
  CHECK(sum >= 2.9 * width * height);
  CHECK(film.taken[at(32, 5)] > film.taken[at(1, 5)]);
}

TEST_CASE("a frame ends when its mean error is below the noise threshold") {
  SamplingPlan plan;
  plan.settings.progressive = true;
  plan.samples = 65536;
  plan.noise = 0.01;
  const auto noisy = [](int x, int y, u32 sample) {
    return MadeUpPixel{float(hash_u32(sample + hash_u32(static_cast<u32>(at(x, y)))) & 1u), 1};
  };
  Film film = growing(false);
  run(film, plan, noisy);
  CHECK(mean_error(film) < 0.01);
  CHECK(film.taken[0] < 65536);
  CHECK(film.taken[0] > 8);
}

TEST_CASE("subsampling interpolates even surfaces, and looks at each pixel before") {
  const auto ramp = [](int x, int y, u32) { return MadeUpPixel{0.5f + 0.001f * float(x + y), 1}; };
  Film film = growing(true);
  run(film, subsampling_plan(4), ramp);
  int sampled = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t p = at(x, y);
      const bool corner = (x % 2 == 0 || x == width - 1) && (y % 2 == 0 || y == height - 1);
      CHECK(film.states[p] == (corner ? PixelState::sampled : PixelState::interpolated));
      CHECK(film.sums[p].x / film.weights[p] == Approx(ramp(x, y, 0).value).margin(1e-5));
      sampled += corner;
    }
  CHECK(sampled == 17 * 10);
  CHECK(film.surfaces_seen == width * height);
}

TEST_CASE("a thing one pixel wide between the corners is found by its surface") {
  const auto wire = [](int x, int y, u32) {
    const bool on = x == 7 || y == 9;
    return MadeUpPixel{on ? 0.51f : 0.5f, on ? 2 : 1};
  };
  Film film = growing(true);
  run(film, subsampling_plan(1), wire);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      CHECK(film.sums[at(x, y)].x / film.weights[at(x, y)] == Approx(wire(x, y, 0).value));
}

TEST_CASE("a shadow one pixel wide is followed from where a corner lies in it") {
  // It falls mostly between the corners, and is one only here and there.
  const auto shadow = [](int x, int y, u32) { return MadeUpPixel{x == (y < 4 ? 8 : 7) ? 0.1f : 0.5f, 1}; };
  Film film = growing(true);
  run(film, subsampling_plan(1), shadow);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      CHECK(film.sums[at(x, y)].x / film.weights[at(x, y)] == Approx(shadow(x, y, 0).value));
}

TEST_CASE("a frame in passes continues from its checkpoint, and takes no other's") {
  const TemporaryFolder folder;
  const auto noisy = [](int x, int y, u32 sample) {
    return MadeUpPixel{float((x * 7 + y * 3 + int(sample) * 5) % 11) / 11, (x / 5) % 3};
  };
  const SamplingPlan plan = adaptive_plan(0.05, 32);
  Film whole = growing(true);
  run(whole, plan, noisy);

  Film film = growing(true);
  Pass pass = *next_pass(film, plan);
  for (int passes = 0; passes < 3; ++passes) {
    add_pass(film, pass, made(film, pass, noisy), true);
    const auto next = next_pass(film, plan, pass);
    REQUIRE(next);
    pass = *next;
  }
  Film half = made(film, pass, noisy);
  for (std::size_t i = 0; i < half.done.size() / 2; ++i) half.done[i] = 0;
  const auto file = folder / "state";
  write_checkpoint(file, film, pass, half, 42);

  Film back = growing(true);
  Pass same;
  Film part;
  CHECK_THROWS_AS(read_checkpoint(file, back, same, part, 43), UsageError);
  read_checkpoint(file, back, same, part, 42);
  CHECK(same.pixels == pass.pixels);
  CHECK(part.done == half.done);
  add_pass(back, same, made(back, same, noisy), true);
  run(back, plan, noisy, same);
  CHECK(back.taken == whole.taken);
  for (std::size_t p = 0; p < back.taken.size(); ++p) REQUIRE(back.sums[p] == whole.sums[p]);

  Film smaller = growing(true, height - 1);
  CHECK_THROWS_AS(read_checkpoint(file, smaller, same, part, 42), UsageError);
  std::filesystem::resize_file(file, 500);
  CHECK_THROWS_AS(read_checkpoint(file, back, same, part, 42), SceneError);
}

TEST_CASE("the variance of pixels with one sample is that of the colours around") {
  const auto step = [](int x, int, u32) { return MadeUpPixel{x < 10 ? 0.25f : 0.75f, 1}; };
  Film film = growing(false);
  SamplingPlan plan = adaptive_plan(100, 64);
  run(film, plan, step);
  const Image variance = develop_variance(film);
  CHECK(film.taken[at(10, 4)] == 1);
  CHECK(variance.pixel(3, 4)[0] == 0);
  CHECK(variance.pixel(10, 4)[0] == Approx(0.5 * 0.5 * 3 * 6 / 9.0 / 8));  // three of nine on the other side
  CHECK(variance.pixel(10, 0)[2] == Approx(0.5 * 0.5 * 2 * 4 / 6.0 / 5));
}
