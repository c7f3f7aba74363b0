// How tiles are cut into launches: every sample once, in any size, and what is asked for after failures.
#include <algorithm>
#include <vector>

#include "catch.h"
#include "render/frame/launch_sizer.h"

using namespace sundog;

namespace {

const Tile odd_tile{8, 16, 45, 27};

LaunchLimits cpu(unsigned tile = 4) { return {DeviceClass::cpu, 6, tile, tile, 256}; }

WorkGroup fixed(std::size_t x, std::size_t y) { return {WorkGroup::Kind::fixed, x, y}; }

/// Runs all launches of a tile, a launch taking `seconds` of each sample. Counts how often each sample of
/// each item is made, item after item, up to the last item that any launch makes.
std::vector<int> run(LaunchSizer& sizer, const Tile& tile, unsigned samples, double seconds) {
  std::vector<int> made;
  sizer.begin(tile, samples);
  while (const auto next = sizer.next()) {
    const Launch& launch = next->launch;
    REQUIRE(launch.sample_count > 0);
    REQUIRE(launch.first_sample + launch.sample_count <= samples);
    REQUIRE((launch.x0 == static_cast<u32>(tile.x) && launch.y0 == static_cast<u32>(tile.y)));
    REQUIRE((launch.width == static_cast<u32>(tile.width) && launch.height == static_cast<u32>(tile.height)));
    made.resize(std::max(made.size(), std::size_t{launch.last_item} * samples));
    for (u32 item = launch.first_item; item < launch.last_item; ++item)
      for (u32 i = 0; i < launch.sample_count; ++i)
        ++made[std::size_t{item} * samples + launch.first_sample + i];
    sizer.note_time(seconds * static_cast<double>(next->samples));
  }
  return made;
}

}  // namespace

TEST_CASE("launches make every sample of every item once") {
  const double seconds = GENERATE(1e-9, 1e-5, 1e-2);
  const unsigned samples = GENERATE(1u, 7u, 300u);
  for (const WorkGroup& group :
       {WorkGroup{}, fixed(16, 1), fixed(8, 2), WorkGroup{WorkGroup::Kind::driver, 0, 0}})
    for (const unsigned tile : {1u, 4u}) {
      INFO(seconds << " s a sample, " << samples << " samples, tile " << tile << ", group " << group.x << "x"
                   << group.y);
      LaunchSizer sizer(cpu(tile), group, {}, false);
      const auto made = run(sizer, odd_tile, samples, seconds);
      const bool blocks = tile == 1 && !(group.kind == WorkGroup::Kind::fixed && group.y > 1);
      const unsigned items = blocks ? 6 * 32 * 7 : tile == 1 ? 45 * 27 : 12 * 7;
      CHECK(made.size() == std::size_t{items} * samples);
      CHECK(std::ranges::count(made, 1) == std::ssize(made));
      CHECK(sizer.finished_rows() == 27);
    }
}

TEST_CASE("a tile that is left early has the rows whose samples are all made") {
  LaunchSizer sizer(cpu(), {}, {}, false);
  sizer.begin(odd_tile, 4);
  CHECK(sizer.finished_rows() == 0);
  const unsigned row_items = 12;
  unsigned last = 0;
  while (const auto next = sizer.next()) {
    const unsigned whole =
        next->launch.first_sample + next->launch.sample_count == 4 ? next->launch.last_item : last;
    CHECK(sizer.finished_rows() == std::min(whole / row_items * 4, 27u));
    last = whole;
    sizer.note_time(0.1);
  }
  CHECK(sizer.finished_rows() == 27);
}

TEST_CASE("launches grow to the wanted time and shrink where they take longer") {
  LaunchSizer sizer(cpu(), {}, {}, false);
  const Tile tile{0, 0, 4096, 4096};
  sizer.begin(tile, 16);
  std::size_t size = 0;
  for (int i = 0; i < 12; ++i) {
    size = sizer.next()->samples;
    sizer.note_time(1e-6 * static_cast<double>(size));
  }
  CHECK(size == Approx(50'000).epsilon(0.1));
  sizer.next();
  sizer.note_time(5);
  std::optional<SizedLaunch> next;
  do next = sizer.next();  // the items in hand first get the rest of their samples
  while (next->launch.first_sample > 0);
  CHECK(next->samples < size / 10);
  LaunchSizer fields(cpu(), {}, {}, true);
  fields.begin(tile, 16);
  CHECK(fields.next()->samples <= 512);
}

TEST_CASE("on a CPU launches among fields stay short enough for what is behind a quick sky") {
  LaunchSizer sizer(cpu(), {}, {}, true);
  sizer.begin({0, 0, 4096, 4096}, 16);
  std::size_t most = 0;
  for (int i = 0; i < 12; ++i) {
    most = std::max(most, sizer.next()->samples);
    sizer.note_time(1e-9);
  }
  CHECK(most > 40'000);  // whole rounds of samples of whole items
  CHECK(most <= 65'536);
}

TEST_CASE("work-items take runs of items where each unit has enough work-items left") {
  LaunchLimits limits = cpu();
  limits.most_run = 8;
  LaunchSizer sizer(limits, {}, {}, false);
  sizer.begin({0, 0, 2048, 2048}, 1);
  unsigned longest = 0, shortest = 8;
  while (const auto next = sizer.next()) {
    const unsigned run = next->launch.run, items = next->launch.last_item - next->launch.first_item;
    const auto work_items = static_cast<unsigned>(next->size.x);
    REQUIRE((run >= 1 && run <= 8));
    REQUIRE(work_items * run >= items);
    REQUIRE((work_items - 1) * run < items);
    CHECK((run == 1 || work_items >= 16 * limits.compute_units));
    longest = std::max(longest, run);
    shortest = std::min(shortest, run);
    sizer.note_time(1e-6 * static_cast<double>(next->samples));
  }
  CHECK(longest == 8);
  CHECK(shortest <= 2);
  sizer.begin({0, 0, 2048, 2048}, 1);
  REQUIRE(sizer.next());
  CHECK(sizer.ask_less(LaunchFailure::loops_cut_short, "why"));
  sizer.begin({0, 0, 2048, 2048}, 1);
  CHECK(sizer.next()->launch.run == 1);
}

TEST_CASE("failures are answered by less, until there is nothing less") {
  LaunchSizer sizer(cpu(), {}, {}, false);
  const Tile tile{0, 0, 512, 512};
  SECTION("a group that is too large is halved down to one") {
    LaunchSizer wide({DeviceClass::gpu, 16, 1, 1, 1024}, fixed(256, 1), {}, false);
    for (std::size_t group = 256; group > 1; group /= 2) {
      wide.begin(tile, 1);
      CHECK(wide.next()->size.local_x == group);
      CHECK(wide.ask_less(LaunchFailure::group_too_large, "why"));
      CHECK(wide.most_group() == group / 2);
    }
    wide.begin(tile, 1);
    CHECK(wide.next()->size.local_x == 1);
    CHECK_FALSE(wide.ask_less(LaunchFailure::group_too_large, "why"));
  }
  SECTION("resources that run out make launches smaller") {
    std::size_t before = ~std::size_t{0};
    int asked = 0;
    while (true) {
      sizer.begin(tile, 8);
      const std::size_t size = sizer.next()->samples;
      CHECK(size <= before);
      before = size;
      const auto note = sizer.ask_less(LaunchFailure::out_of_resources, "why");
      if (!note) break;
      CHECK(note->rfind("why: ", 0) == 0);
      REQUIRE(++asked < 40);
    }
    CHECK(before <= 6 * 16);
    CHECK(asked > 3);
  }
  SECTION("loops that are cut short make fewer samples at a time, at last groups of one") {
    LaunchSizer single(cpu(1), {}, {}, false);
    const Tile small{0, 0, 16, 16};
    run(single, small, 64, 1e-8);  // launches have grown to many samples
    single.begin(small, 64);
    REQUIRE(single.next()->launch.sample_count > 2);
    unsigned samples = single.tile_samples();
    while (samples > 1) {
      REQUIRE(single.ask_less(LaunchFailure::loops_cut_short, "why"));
      single.begin(small, 64);
      REQUIRE(single.next()->launch.sample_count <= samples / 2);
      samples = single.tile_samples();
    }
    REQUIRE(single.ask_less(LaunchFailure::loops_cut_short, "why"));
    single.begin(small, 64);
    CHECK(single.next()->size.local_x == 1);
    CHECK_FALSE(single.ask_less(LaunchFailure::loops_cut_short, "why"));
  }
}

TEST_CASE("with many pixels a work-item, a processor's kernels are launched in groups of one size") {
  for (const int side : {1, 16, 100, 4096}) {
    LaunchSizer sizer(cpu(), {}, {}, false);
    sizer.begin({0, 0, side, side}, 1);
    CHECK(sizer.next()->size.local_x == 1);
    CHECK_FALSE(sizer.ask_less(LaunchFailure::loops_cut_short, "why"));
  }
}

TEST_CASE("a tuned group that the kernels cannot have is left for the default") {
  Tuning tuning;
  tuning.work_group = fixed(512, 1);
  tuning.surfaces_group = fixed(512, 1);
  LaunchSizer sizer(cpu(), {}, tuning, false);
  sizer.begin({0, 0, 1024, 1024}, 1);
  CHECK(sizer.next()->size.local_x <= 4);
  CHECK(sizer.surfaces(1 << 20).local_x == 16);
}
