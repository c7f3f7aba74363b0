// Cutting a frame and sizing launches: arithmetic without a device.
#include <vector>

#include "catch.h"
#include "render/film/rows.h"
#include "render/plan/tiles.h"

using namespace sundog;

TEST_CASE("tiles cover every pixel once and begin on multiples of the work-item's tile") {
  for (const int width : {1, 4, 37, 640})
    for (const int height : {1, 29, 513})
      for (const int edge : {1, 4, 30, 4096}) {
        std::vector<int> covered(static_cast<std::size_t>(width * height));
        for (const Tile& tile : cut_tiles(width, height, edge)) {
          CHECK(tile.x % 4 == 0);
          CHECK(tile.y % 4 == 0);
          for (int y = tile.y; y < tile.y + tile.height; ++y)
            for (int x = tile.x; x < tile.x + tile.width; ++x)
              covered.at(static_cast<std::size_t>(y * width + x)) += 1;
        }
        CHECK(covered == std::vector<int>(covered.size(), 1));
      }
}

namespace {

/// How often each pixel of a width x height image lies in the tiles.
std::vector<int> coverage(int width, int height, const std::vector<Tile>& tiles) {
  std::vector<int> covered(static_cast<std::size_t>(width * height));
  for (const Tile& tile : tiles)
    for (int y = tile.y; y < tile.y + tile.height; ++y)
      for (int x = tile.x; x < tile.x + tile.width; ++x)
        covered.at(static_cast<std::size_t>(y * width + x)) += 1;
  return covered;
}

}  // namespace

TEST_CASE("tiles of any size asked for cover every pixel once") {
  for (const int width : {1, 5, 37, 640})
    for (const int height : {1, 30, 64})
      for (const std::uint64_t wanted : {1u, 16u, 100u, 5000u, 1'000'000u}) {
        WaitingTiles waiting({{0, 0, width, height}});
        std::vector<Tile> tiles;
        while (const auto tile = waiting.take(wanted)) {
          CHECK(tile->x % 4 == 0);
          CHECK(tile->y % 4 == 0);
          CHECK(pixel_count(*tile) <= 4 * wanted + 64);
          tiles.push_back(*tile);
        }
        CHECK(waiting.pixels() == 0);
        CHECK(coverage(width, height, tiles) ==
              std::vector<int>(static_cast<std::size_t>(width * height), 1));
      }
}

TEST_CASE("a tile that was given back is the next") {
  WaitingTiles waiting({{0, 0, 64, 64}});
  const Tile first = *waiting.take(512);
  waiting.give_back(first);
  CHECK(waiting.pixels() == 64 * 64);
  CHECK(waiting.take(512) == first);
}

TEST_CASE("what is unfinished is covered once, and blocks that are done are left alone") {
  Film film(37, 29, false);
  const auto finish = [&](Tile tile) {
    const std::vector<float4> sums(pixel_count(tile));
    const std::vector<float> weights(pixel_count(tile));
    film.put(tile, {.sums = sums, .weights = weights, .aovs = {}, .rays = {}});
  };
  CHECK(unfinished_tiles(film, {0, 0, 37, 29}) == std::vector<Tile>{{0, 0, 37, 29}});
  finish({0, 0, 37, 8});
  CHECK(unfinished_tiles(film, {0, 0, 37, 29}) == std::vector<Tile>{{0, 8, 37, 21}});
  finish({8, 12, 13, 9});
  const std::vector<Tile> tiles = unfinished_tiles(film, {0, 0, 37, 29});
  const std::vector<int> covered = coverage(37, 29, tiles);
  for (int y = 0; y < 29; ++y)
    for (int x = 0; x < 37; ++x) {
      const auto at = static_cast<std::size_t>(y * 37 + x);
      const bool in_done_block = y < 8 || (x >= 8 && x < 20 && y >= 12 && y < 20);
      CHECK(covered[at] == (in_done_block ? 0 : 1));
    }
  CHECK(unfinished_tiles(film, {0, 0, 37, 8}).empty());
}

TEST_CASE("a launch follows the measured speed within its limits") {
  CHECK(next_launch_size(1000, 0.1, 0.05, 1, 1'000'000) == 500);
  CHECK(next_launch_size(1000, 0.025, 0.05, 1, 1'000'000) == 2000);
  CHECK(next_launch_size(1000, 1e-9, 0.05, 1, 1'000'000) == 8000);  // never more than eightfold at a step
  CHECK(next_launch_size(1000, 0.0, 0.05, 1, 1'000'000) == 8000);
  CHECK(next_launch_size(1000, 100.0, 0.05, 64, 1'000'000) == 64);  // never less than the least
  CHECK(next_launch_size(1000, 1e-9, 0.05, 64, 3000) == 3000);
}

TEST_CASE("rows are divided by shares, without gap or overlap") {
  CHECK(divide_rows(16, std::vector{3.0, 1.0}) == std::vector<RowRange>{{0, 12}, {12, 4}});
  CHECK(divide_rows(480, std::vector{1.0}) == std::vector<RowRange>{{0, 480}});
  CHECK(divide_rows(480, std::vector{0.0, 2.0}) == std::vector<RowRange>{{0, 0}, {0, 480}});
  for (const int height : {1, 5, 30, 479})
    for (const std::size_t count : {1u, 2u, 3u, 9u}) {
      int next = 0;
      for (const RowRange& range : divide_rows(height, std::vector<double>(count, 0.7))) {
        CHECK(range.first == next);
        CHECK((range.first % 4 == 0 || range.count == 0));
        next += range.count;
      }
      CHECK(next == height);
    }
}
