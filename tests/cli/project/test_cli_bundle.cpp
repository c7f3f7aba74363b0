// The slim bundle (cmake/make_bundle.sh): a program with its libraries that runs from any folder.
#include <cstdio>

#include "catch.h"
#include "cli_scene.h"

namespace fs = std::filesystem;

TEST_CASE("a bundle runs from another folder, from a link and without any setting") {
  if (run_command({"sh", "-c", "command -v patchelf zstd"}).status != 0) {
    std::printf("no patchelf or no zstd here: the bundle is not tested\n");
    return;
  }
  const TemporaryFolder folder;
  CommandOptions fast;
  fast.environment["BUNDLE_LEVEL"] = "1";
  fast.environment["BUNDLE_PICTURES"] = "none";
  const CommandResult made = run_command(
      {SUNDOG_SOURCE_DIR "/cmake/make_bundle.sh", SUNDOG_BINARY, (folder / "tried-slim.tar.zst").string()},
      fast);
  CAPTURE(made.err);
  REQUIRE(made.status == 0);
  const fs::path moved = folder / "a folder";
  fs::create_directory(moved);
  REQUIRE(
      run_command({"tar", "-C", moved.string(), "--zstd", "-xf", (folder / "tried-slim.tar.zst").string()})
          .status == 0);
  const fs::path program = moved / "tried-slim" / "sundog";
  fs::create_symlink(program, folder / "link");
  for (const std::string& start : {program.string(), (folder / "link").string()}) {
    const CommandResult info = run_command({"env", "-i", "PATH=/usr/bin:/bin", start, "info",
                                            (moved / "tried-slim/scenes/spheres.json").string()});
    CAPTURE(start, info.err);
    CHECK(info.status == 0);
    CHECK_THAT(info.out, ContainsSubstring("instances"));
  }
  CHECK(fs::exists(moved / "tried-slim/bench/gpu.sh"));
  CHECK_FALSE(fs::exists(moved / "tried-slim/libexec"));
}
