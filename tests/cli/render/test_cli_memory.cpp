// A frame that does not fit into memory is refused before the work begins; what one takes is stated.
#include "catch.h"
#include "cli_scene.h"

namespace {

/// With no more address space than so many KiB.
CommandResult limited(const CliFolder& folder, const char* kibibytes, const char* size, const char* out) {
  return run_command({"sh", "-c", "ulimit -v $1; exec \"$0\" render \"$2\" -o \"$3\" --size $4",
                      SUNDOG_BINARY, kibibytes, folder.scene, folder.file(out), size});
}

}  // namespace

TEST_CASE("a frame that does not fit into memory is refused with the figures, before the work begins") {
  const CliFolder folder;
  const CommandResult result = limited(folder, "4000000", "16384x16384", "a.exr");
  CAPTURE(result.err);
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
  CHECK(
      result.err.find("a frame of 16384x16384 pixels takes 14.2 GiB of memory (57 bytes a pixel), and 3.") !=
      std::string::npos);
  CHECK(result.err.find("GiB are available") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_CASE("--verbose states the memory of the frame") {
  const CliFolder folder;
  const CommandResult result =
      run_sundog({"render", folder.scene, "-o", folder.file("a.pfm"), "--size", "512x512", "--verbose"});
  REQUIRE(result.status == 0);
  CHECK(result.out.find("memory of the frame") != std::string::npos);
  CHECK(result.out.find("12.2 MiB, 49 bytes a pixel") != std::string::npos);
}
