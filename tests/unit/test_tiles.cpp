// Cutting a frame and sizing launches: arithmetic without a device.
#include <vector>

#include "catch.h"
#include "render/tiles.h"

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

TEST_CASE("the default tile gives each of several devices more than one tile") {
  for (const std::size_t devices : {1u, 2u, 5u})
    for (const int size : {16, 256, 640, 4000}) {
      const int edge = default_tile_edge(size, size, devices);
      CHECK(edge >= 32);
      CHECK(edge % 4 == 0);
      if (size >= 640) CHECK(cut_tiles(size, size, edge).size() >= 4 * devices);
    }
}

TEST_CASE("a launch follows the measured speed within its limits") {
  CHECK(next_launch_size(1000, 0.1, 0.05, 1, 1'000'000) == 500);
  CHECK(next_launch_size(1000, 0.025, 0.05, 1, 1'000'000) == 2000);
  CHECK(next_launch_size(1000, 1e-9, 0.05, 1, 1'000'000) == 8000);  // never more than eightfold at a step
  CHECK(next_launch_size(1000, 0.0, 0.05, 1, 1'000'000) == 8000);
  CHECK(next_launch_size(1000, 100.0, 0.05, 64, 1'000'000) == 64);  // never less than the least
  CHECK(next_launch_size(1000, 1e-9, 0.05, 64, 3000) == 3000);
}
