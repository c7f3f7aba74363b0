// The frame's tiles between several threads, without a device: fixed parts, and who may make a tile twice.
#include "render/frame/tile_queue.h"

#include <thread>

#include "catch.h"

using namespace sundog;

namespace {

/// Two devices with a part of 16 rows each, in whole tiles of 8 rows, both ready.
std::unique_ptr<TileQueue> two_parts(bool exact) {
  TilePlan plan;
  plan.whole = true;
  plan.exact = exact;
  plan.lists.emplace_back(std::vector<Tile>{{0, 0, 64, 8}, {0, 8, 64, 8}});
  plan.lists.emplace_back(std::vector<Tile>{{0, 16, 64, 8}, {0, 24, 64, 8}});
  DeviceSpeed speed;
  speed.estimate = 1;
  auto queue = std::make_unique<TileQueue>(std::move(plan), std::vector{speed, speed});
  queue->ready(0);
  queue->ready(1);
  return queue;
}

/// The first device sits on its tile number `held`, from 1, while the second makes all of its part at once.
/// Returns the second's next tile; if it gets none for a while, the queue is closed.
std::optional<TileJob> next_of_second(TileQueue& queue, int held) {
  for (int i = 1; i < held; ++i) {
    const auto job = queue.take(0);
    REQUIRE(job.has_value());
    CHECK(queue.finished(0, *job, 0.001));
  }
  REQUIRE(queue.take(0).has_value());
  for (int i = 0; i < 2; ++i) {
    const auto job = queue.take(1);
    REQUIRE(job.has_value());
    CHECK(job->tile.y >= 16);
    CHECK(queue.finished(1, *job, 0.001));
  }
  std::thread closer([&] {
    queue.wait(0.3);
    queue.close();
  });
  const auto next = queue.take(1);
  closer.join();
  return next;
}

}  // namespace

TEST_CASE("in a static split the last tile of a slow device is made by an idle one too") {
  const auto queue = two_parts(false);
  const auto job = next_of_second(*queue, 2);
  REQUIRE(job.has_value());
  CHECK(job->tile == Tile{0, 8, 64, 8});
  CHECK(queue->finished(1, *job, 0.001));
  CHECK(queue->complete());
  CHECK(queue->cancelled(0));
}

TEST_CASE("in a static split no tile but the last is made by another device") {
  CHECK_FALSE(next_of_second(*two_parts(false), 1).has_value());
}

TEST_CASE("shares that were asked for are kept to the tile") {
  CHECK_FALSE(next_of_second(*two_parts(true), 2).has_value());
}

TEST_CASE("a retired device's part goes to the others, in an exact split too") {
  const auto queue = two_parts(true);
  REQUIRE(queue->take(0).has_value());
  queue->retire(0);
  int tiles = 0;
  while (const auto job = queue->take(1)) {
    CHECK(queue->finished(1, *job, 0.001));
    ++tiles;
  }
  CHECK(tiles == 4);
  CHECK(queue->complete());
}

TEST_CASE("a device that was not started is needed when the others have failed, or in a fixed split") {
  const auto queue_of = [](std::size_t lists) {
    TilePlan plan;
    for (std::size_t i = 0; i < lists; ++i)
      plan.lists.emplace_back(std::vector<Tile>{{0, static_cast<int>(8 * i), 64, 8}});
    DeviceSpeed fast, slow;
    fast.estimate = 1000;
    slow.estimate = 1;
    fast.processor = slow.processor = 0;
    auto queue = std::make_unique<TileQueue>(std::move(plan), std::vector{fast, slow});
    queue->ready(0);
    return queue;
  };
  CHECK(queue_of(2)->wait_until_needed(1));
  CHECK(queue_of(1)->wait_until_needed(0));

  const auto finished = queue_of(1);
  std::thread worker([&] {
    while (const auto job = finished->take(0)) finished->finished(0, *job, 0.001);
  });
  CHECK_FALSE(finished->wait_until_needed(1));
  worker.join();

  const auto failing = queue_of(1);
  REQUIRE(failing->take(0).has_value());
  std::thread killer([&] { failing->retire(0); });
  CHECK(failing->wait_until_needed(1));
  killer.join();
  failing->ready(1);
  CHECK(failing->take(1).has_value());
}
