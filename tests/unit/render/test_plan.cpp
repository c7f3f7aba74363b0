// Who gets how much of a frame: the planner, without a device; whole frames in simulated time.
#include "render/plan/plan.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "catch.h"
#include "render/plan/tiles.h"

using namespace sundog;

namespace {

DeviceSpeed measured(double speed, int processor = -1) {
  DeviceSpeed device;
  device.measured = speed;
  device.sample = 1e9;
  device.processor = processor;
  device.working = true;
  return device;
}

/// A device of the simulation: its real speed, and what the planner knows beforehand.
struct Simulated {
  double speed = 0;        // pixels a second; 0: it never comes back from a tile
  double estimate = 0;     // what it seems to be
  double ready = 0;        // seconds until its kernels are built
  double first_delay = 0;  // seconds more for its first tile
  int hangs_in = 0;        // the tile that it never comes back from, from 1; 0: none
  double known = 0;        // speed that the frame before was made with; 0: none
};

struct Outcome {
  double seconds = 0;  // when the last pixel was there
  std::vector<std::uint64_t> kept;
  std::vector<int> tiles;
};

/// A frame in simulated time, as TileQueue runs it: waiting tiles by guided_pixels, then tile_to_repeat.
class Simulation {
 public:
  /// `tile_cost`: seconds of each tile beside its pixels. With `dear_below` the pixels of the lower half take
  /// so many times as long as the others.
  Simulation(int width, int height, std::vector<Simulated> devices, double tile_cost = 0,
             double dear_below = 1)
      : tile_cost_(tile_cost),
        dear_below_(dear_below),
        middle_(height / 2),
        devices_(std::move(devices)),
        waiting_({{0, 0, width, height}}),
        speeds_(devices_.size()),
        jobs_(devices_.size()),
        made_(devices_.size()) {
    outcome_.kept.resize(devices_.size());
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      speeds_[i].estimate = devices_[i].estimate;
      speeds_[i].measured = devices_[i].known;
      speeds_[i].sample = devices_[i].known > 0 ? 1e9 : 0;
    }
    left_ = pixel_count({0, 0, width, height});
  }

  Outcome run() {
    constexpr double end_of_time = 1000;
    const double step = tile_cost_ > 0 ? 1e-5 : 1e-3;
    for (now_ = 0; left_ > 0 && now_ < end_of_time; now_ += step)
      for (std::size_t i = 0; i < devices_.size(); ++i) advance(i);
    outcome_.seconds = left_ > 0 ? std::numeric_limits<double>::infinity() : now_;
    outcome_.tiles = made_;
    return outcome_;
  }

 private:
  struct Job {
    int id = 0;  // 0: none
    Tile tile;
    double begun = 0, done = 0;
  };

  void advance(std::size_t i) {
    if (now_ < devices_[i].ready) return;
    find_stuck();
    if (jobs_[i].id != 0 && jobs_[i].done <= now_) finish(i);
    if (jobs_[i].id == 0) begin(i);
  }

  HeldTile held(std::size_t i) const { return {pixel_count(jobs_[i].tile), {{i, now_ - jobs_[i].begun}}}; }

  void find_stuck() {
    for (std::size_t i = 0; i < devices_.size(); ++i) {
      const HeldTile tile = held(i);
      const bool stuck = jobs_[i].id != 0 && is_stuck(speeds_, tile, tile.holders.front());
      speeds_[i].working = now_ >= devices_[i].ready && !stuck;
    }
  }

  void finish(std::size_t i) {
    const Job job = jobs_[i];
    const double seconds = job.done - job.begun;
    speeds_[i].measured = static_cast<double>(pixel_count(job.tile)) / seconds;
    speeds_[i].sample = static_cast<double>(pixel_count(job.tile));
    made_[i] += 1;
    for (Job& other : jobs_)
      if (other.id == job.id) other.id = 0;
    outcome_.kept[i] += pixel_count(job.tile);
    left_ -= pixel_count(job.tile);
  }

  void begin(std::size_t i) {
    const std::uint64_t wanted = guided_pixels(speeds_, i, waiting_.pixels());
    if (wanted > 0) {
      start(i, ++last_id_, *waiting_.take(wanted));
      return;
    }
    std::vector<HeldTile> tiles;
    std::vector<std::size_t> first;
    for (std::size_t k = 0; k < jobs_.size(); ++k)
      if (jobs_[k].id != 0) {
        tiles.push_back(held(k));
        first.push_back(k);
      }
    if (const auto chosen = tile_to_repeat(speeds_, i, tiles))
      start(i, jobs_[first[*chosen]].id, jobs_[first[*chosen]].tile);
  }

  void start(std::size_t i, int id, const Tile& tile) {
    const Simulated& device = devices_[i];
    const bool hangs = device.speed <= 0 || device.hangs_in == made_[i] + 1;
    const int below = std::clamp(tile.y + tile.height - middle_, 0, tile.height);
    const double work = tile.width * (tile.height - below + below * dear_below_);
    const double seconds = hangs ? 1e9 : tile_cost_ + work / device.speed;
    jobs_[i] = {id, tile, now_, now_ + seconds + (made_[i] == 0 ? device.first_delay : 0)};
  }

  double tile_cost_, dear_below_;
  int middle_;
  std::vector<Simulated> devices_;
  WaitingTiles waiting_;
  std::vector<DeviceSpeed> speeds_;
  std::vector<Job> jobs_;
  std::vector<int> made_;
  std::uint64_t left_ = 0;
  int last_id_ = 0;
  double now_ = 0;
  Outcome outcome_;
};

double seconds_of(std::vector<Simulated> devices, int width = 640, int height = 480) {
  return Simulation(width, height, std::move(devices)).run().seconds;
}

}  // namespace

TEST_CASE("equal devices make a frame in half the time") {
  const Simulated device{100'000, 1};
  const double alone = seconds_of({device}), both = seconds_of({device, device});
  CHECK(both == Approx(alone / 2).epsilon(0.03));
  const Outcome outcome = Simulation(640, 480, {device, device}).run();
  CHECK(static_cast<double>(outcome.kept[0]) / static_cast<double>(outcome.kept[1]) ==
        Approx(1.0).epsilon(0.05));
}

TEST_CASE("a frame of 30 ms has several tiles a device, and a second one never costs") {
  constexpr int width = 320, height = 240;
  constexpr double tile_cost = 2e-4;
  for (const double seconds : {0.01, 0.03, 0.1, 0.5})
    for (const double dear : {1.0, 4.0})
      for (const double slower : {1.0, 3.0, 10.0}) {
        CAPTURE(seconds, dear, slower);
        const double speed = width * height * 0.5 * (1 + dear) / seconds, mean = width * height / seconds;
        Simulated fast{speed, 1}, slow{speed / slower, 1};
        fast.known = mean;
        slow.known = mean / slower;
        const double alone = Simulation(width, height, {fast}, tile_cost, dear).run().seconds;
        const Outcome both = Simulation(width, height, {fast, slow}, tile_cost, dear).run();
        // A tenth of 10 ms is as long as a tile's own cost.
        CHECK(both.seconds < (seconds > 0.01 || slower < 10 ? 1.0 : 1.1) * alone);
        // The ideal time of both, with an allowance for tiles.
        if (seconds >= 0.03) CHECK(both.seconds < alone / (1 + 1 / slower) / 0.8);
        if (seconds >= 0.5) CHECK(both.seconds < alone / (1 + 1 / slower) / 0.95);
        if (seconds >= 0.03 && slower < 2)
          for (const int tiles : both.tiles) CHECK(tiles >= 4);
      }
}

TEST_CASE(
    "two equal devices halve a short frame, though one is ready later and half of the picture is dear") {
  constexpr int width = 640, height = 480;
  for (const double seconds : {0.1, 0.5})
    for (const double dear : {1.0, 4.0, 8.0})
      for (const double ready : {0.0, 2e-4}) {
        CAPTURE(seconds, dear, ready);
        const double speed = width * height * 0.5 * (1 + dear) / seconds;
        Simulated device{speed, 1}, late = device;
        device.known = late.known = width * height / seconds;
        late.ready = ready;
        CHECK(Simulation(width, height, {device, late}, 1e-4, dear).run().seconds < seconds / 1.8);
      }
}

TEST_CASE("devices share a frame by their speeds, whatever the estimates said") {
  const Simulated fast{300'000, 1}, slow{100'000, 50};
  const Outcome outcome = Simulation(1280, 960, {slow, fast}).run();
  CHECK(outcome.seconds == Approx(1280 * 960 / 400'000.0).epsilon(0.05));
  CHECK(static_cast<double>(outcome.kept[1]) > 2.5 * static_cast<double>(outcome.kept[0]));
}

TEST_CASE("a device a thousand times slower does not hold a frame up by more than a twentieth") {
  const Simulated fast{200'000, 1000};
  const double alone = seconds_of({fast});
  for (const double estimate : {1.0, 1000.0, 1e6, 0.0}) {  // modest, as fast, boasting, unknown
    CAPTURE(estimate);
    Simulated slow{200, estimate};
    CHECK(seconds_of({slow, fast}) < 1.05 * alone);
    CHECK(seconds_of({fast, slow}) < 1.05 * alone);
    slow.first_delay = 20;
    CHECK(seconds_of({slow, fast}) < 1.05 * alone);
    slow.ready = 0.5 * alone;
    CHECK(seconds_of({slow, fast}) < 1.05 * alone);
  }
}

TEST_CASE("a device that never comes back holds up neither one other device nor two") {
  const Simulated fast{200'000, 1}, dead{0, 1};
  CHECK(seconds_of({dead, fast}) < 1.05 * seconds_of({fast}));
  CHECK(seconds_of({fast, dead, fast}) < 1.08 * seconds_of({fast, fast}));
}

TEST_CASE("a device that hangs leaves the frame to one that rested, however much slower that is") {
  for (const double times : {4.0, 20.0, 100.0, 1000.0})
    for (const int tile : {1, 2, 5}) {
      CAPTURE(times, tile);
      Simulated fast{200'000, times};
      const Simulated slow{200'000 / times, 1};
      fast.hangs_in = tile;
      // The slow one alone, and what passes until the other is given up.
      const double alone = seconds_of({slow}, 160, 120);
      CHECK(seconds_of({fast, slow}, 160, 120) < 1.05 * alone + 3);
      CHECK(seconds_of({slow, fast}, 160, 120) < 1.05 * alone + 3);
    }
}

TEST_CASE("a tile whose holder is stuck is made by an idle device even if that takes it longer") {
  const std::vector devices{measured(100'000), measured(10)};
  const HeldTile late{10'000, {{0, 0.3}}}, stuck{10'000, {{0, 1.1}}};
  CHECK_FALSE(is_stuck(devices, late, late.holders[0]));
  CHECK(is_stuck(devices, stuck, stuck.holders[0]));
  CHECK_FALSE(tile_to_repeat(devices, 1, std::vector{late}).has_value());
  CHECK(tile_to_repeat(devices, 1, std::vector{stuck}) == std::size_t{0});
  CHECK_FALSE(tile_to_repeat(devices, 0, std::vector{stuck}).has_value());
}

TEST_CASE("a frame is finished whatever its size, with more devices than there are tiles") {
  for (const int height : {1, 2, 4, 5, 64})
    for (const int width : {1, 3, 17, 64})
      for (const std::size_t count : {1u, 2u, 7u}) {
        CAPTURE(width, height, count);
        const double seconds = seconds_of(std::vector<Simulated>(count, {1000, 1}), width, height);
        CHECK(seconds <= 1.1 * width * height / 1000.0 + 0.005);
      }
}

TEST_CASE("a device that is ready late takes its part of the rest") {
  const Simulated first{100'000, 1};
  Simulated late{100'000, 1};
  late.ready = 1;
  CHECK(seconds_of({first, late}, 640, 625) == Approx(1 + 1.5).epsilon(0.03));  // 4 s of work for one
}

TEST_CASE("a first tile is small, and the first times are not trusted with a large one") {
  DeviceSpeed unknown;
  unknown.working = true;
  const std::uint64_t probe = guided_pixels(std::vector{unknown}, 0, 1'000'000);
  CHECK(probe >= 256);
  CHECK(probe <= 10'000);
  DeviceSpeed lucky = measured(1e12);  // a tile in no time
  lucky.sample = 4096;
  CHECK(guided_pixels(std::vector{lucky}, 0, 1'000'000'000) <= 5 * 4096);
}

TEST_CASE("tiles shrink towards the end, and none takes long") {
  const std::vector devices{measured(100'000), measured(100'000)};
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  for (std::uint64_t left = 10'000'000; left > 100; left /= 2) {
    const std::uint64_t pixels = guided_pixels(devices, 0, left);
    CHECK(pixels <= last);
    CHECK(pixels <= 50'000);         // half a second
    CHECK(2 * pixels <= left + 16);  // the other can have as much
    last = pixels;
  }
}

TEST_CASE("a device is given tiles of the length that was found best for it") {
  std::vector devices{measured(100'000)};
  const std::uint64_t usual = guided_pixels(devices, 0, 10'000'000);
  devices[0].tile_seconds = 0.01;
  CHECK(guided_pixels(devices, 0, 10'000'000) == 1000);
  devices[0].tile_seconds = 1;
  CHECK(guided_pixels(devices, 0, 10'000'000) == 100'000);
  CHECK(usual < 100'000);
}

TEST_CASE("nothing is left over for a device that would last longer than all the others") {
  const std::vector devices{measured(1'000'000), measured(1)};
  CHECK(guided_pixels(devices, 1, 100'000) == 0);
  CHECK(guided_pixels(devices, 0, 100'000) > 0);
  CHECK(guided_pixels(devices, 1, 1'000'000'000) > 0);
}

TEST_CASE("the fastest device at work never rests, so that a frame always advances") {
  for (const double a : {0.0, 1.0, 1000.0})
    for (const double b : {0.0, 1.0, 1000.0})
      for (const std::uint64_t left : {1u, 15u, 16u, 1000u}) {
        const std::vector devices{measured(a, 0), measured(b, 0), measured(b, 0)};
        std::uint64_t given = 0;
        for (std::size_t i = 0; i < devices.size(); ++i) given += guided_pixels(devices, i, left);
        CHECK(given > 0);
      }
}

TEST_CASE("a device rests where it takes the cores of one many times faster, until that one fails") {
  std::vector devices{measured(1'000'000, 0), measured(10'000, 0)};
  CHECK(guided_pixels(devices, 1, 100'000'000) == 0);
  devices[1].processor = 1;  // another machine's
  CHECK(guided_pixels(devices, 1, 100'000'000) > 0);
  devices[1].processor = 0;
  devices[0].working = false;
  CHECK(guided_pixels(devices, 1, 100'000'000) > 0);
}

TEST_CASE("a device that cannot help is not started, until the one that it would hinder has failed") {
  std::vector<DeviceSpeed> devices(2);
  devices[0].estimate = 1000;
  devices[1].estimate = 10;
  devices[0].processor = devices[1].processor = 0;
  CHECK(is_spared(devices, 1));
  CHECK_FALSE(is_spared(devices, 0));
  devices[0].failed = true;
  CHECK_FALSE(is_spared(devices, 1));
  devices[0].failed = false;
  devices[1].estimate = 100;  // worth a try
  CHECK_FALSE(is_spared(devices, 1));
  devices[1].estimate = 10;
  devices[1].processor = -1;  // hardware of its own
  CHECK_FALSE(is_spared(devices, 1));
}

TEST_CASE("no time, no pixels and no devices are no trouble") {
  CHECK(guided_pixels(std::vector{measured(100)}, 0, 0) == 0);
  CHECK(efficiency({}) == 1);
  CHECK(efficiency(std::vector{DeviceWork{}}) == 1);
  CHECK_FALSE(tile_to_repeat(std::vector{measured(100)}, 0, {}).has_value());
  const HeldTile at_once{100, {{0, 0.0}}};
  CHECK(seconds_left(std::vector{measured(100)}, at_once) == Approx(1));
}

TEST_CASE("a tile is repeated where that is clearly sooner, and never by its holder") {
  const std::vector devices{measured(1000), measured(100'000)};
  const std::vector<HeldTile> tiles{{1000, {{0, 0.1}}}, {5000, {{0, 0.1}}}};
  CHECK(tile_to_repeat(devices, 1, tiles) == std::size_t{1});  // the one that would last longest
  CHECK_FALSE(tile_to_repeat(devices, 0, tiles).has_value());
  const std::vector<HeldTile> nearly_done{{1000, {{0, 0.995}}}};
  CHECK_FALSE(tile_to_repeat(devices, 1, nearly_done).has_value());
  const std::vector<HeldTile> overdue{{1000, {{0, 9.0}}}};
  CHECK(tile_to_repeat(devices, 1, overdue) == std::size_t{0});
  const std::vector<HeldTile> twice{{100'000, {{0, 0.0}, {1, 0.5}}}};  // already in good hands
  CHECK_FALSE(
      tile_to_repeat(std::vector{measured(1000), measured(100'000), measured(90'000)}, 2, twice).has_value());
}

TEST_CASE("speeds nobody has measured follow the estimates of those that are") {
  std::vector<DeviceSpeed> devices{measured(1000), DeviceSpeed{}};
  devices[0].estimate = 10;
  devices[1].estimate = 20;
  CHECK(expected_speed(devices, 1) == Approx(2000));
  devices[0].measured = 0;
  CHECK(expected_speed(devices, 1) == 0);
}

TEST_CASE("efficiency is what was kept over what could have been made") {
  CHECK(efficiency(std::vector{DeviceWork{1000, 1000, 2, 2}}) == Approx(1));
  CHECK(efficiency(std::vector{DeviceWork{1000, 1000, 2, 4}}) == Approx(0.5));  // waited half of the time
  CHECK(efficiency(std::vector{DeviceWork{1000, 500, 2, 2}}) == Approx(0.5));   // half was made in vain
  CHECK(efficiency(std::vector{DeviceWork{9000, 9000, 1, 1}, DeviceWork{500, 500, 0.5, 1}}) ==
        Approx(9.5 / 10));
}
