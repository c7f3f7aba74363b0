// sundog kernels: plain kernel files, in lanes.
#include "base/file.h"
#include "catch.h"
#include "run_command.h"
#include "temporary_folder.h"

using Catch::Contains;

TEST_CASE("kernels lists the plain files, and prints one in lanes or what varies in it") {
  const CommandResult list = run_sundog({"kernels"});
  CHECK(list.status == 0);
  CHECK_THAT(list.out, Contains("plain/pathtracer/roulette.cl\n"));
  const CommandResult made = run_sundog({"kernels", "plain/pathtracer/bounce.cl", "--lanes", "16"});
  CHECK(made.status == 0);
  CHECK_THAT(made.out, Catch::StartsWith("#define LANES 16\n") && Contains("MASK survives("));
  const CommandResult told = run_sundog({"kernels", "plain/pathtracer/bounce.cl", "--explain"});
  CHECK_THAT(told.out, Contains("worth varies: line "));
}

TEST_CASE("kernels takes a file of one's own, and refuses it at its place") {
  const TemporaryFolder folder;
  folder.write("mine.cl", "ENTRY static float f(float x) {\n  return x * 2.0;\n}\n");
  const CommandResult refused = run_sundog({"kernels", (folder / "mine.cl").string()});
  CHECK(refused.status == 5);
  CHECK_THAT(refused.err, Contains("mine.cl:2:14: 2.0 is a double: write 2.0f"));
  folder.write("mine.cl", "ENTRY static float f(float x) {\n  return x * 2.0f;\n}\n");
  const CommandResult made = run_sundog({"kernels", (folder / "mine.cl").string()});
  CHECK(made.status == 0);
  CHECK_THAT(made.out, Contains("return (x * 2.0f);"));
  CHECK(run_sundog({"kernels", "plain/none.cl"}).status != 0);
  CHECK(run_sundog({"kernels", "--lanes", "3"}).status == 2);
}
