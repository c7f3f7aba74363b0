// The program that traces the same rays with sundog and with Embree: what it says of hits, never how long
// anything took.
#include <filesystem>

#include "catch.h"
#include "cli_scene.h"

namespace fs = std::filesystem;

namespace {

/// Two crossed squares, as a model file.
std::string write_model(const TemporaryFolder& folder) {
  return folder
      .write("squares.obj",
             "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 -1 -1\nv 0 -1 1\nv 0 1 1\nv 0 1 -1\n"
             "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n")
      .string();
}

CommandResult run_embree_rays(const std::string& model, const CommandOptions& options = {}) {
  const std::string program = (fs::path(SUNDOG_BINARY).parent_path() / "embree_rays").string();
  return run_command({program, model, "--size", "64", "--repeats", "1", "--device", "portable"}, options);
}

}  // namespace

TEST_CASE("embree_rays succeeds where hits are Embree's but for rounding") {
  const TemporaryFolder folder;
  const CommandResult result = run_embree_rays(write_model(folder));
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK_THAT(result.out, ContainsSubstring("primary") && ContainsSubstring("glass"));
}
