// The notebook of three tables, on reports as the page on experiments makes them.
#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

namespace {

// Its cells without Jupyter, and its plots without matplotlib.
constexpr const char* run_cells = R"(
import json, sys, unittest.mock
sys.modules["matplotlib"] = sys.modules["matplotlib.pyplot"] = unittest.mock.MagicMock()
names = {}
for cell in json.load(open(sys.argv[1]))["cells"]:
    if cell["cell_type"] == "code":
        exec("".join(cell["source"]), names)
)";

}  // namespace

TEST_CASE("the notebook makes three tables from the reports of bench threads, samples and workgroup") {
  const CliFolder folder;
  const auto bench = [&](const char* name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"bench",    name,       folder.scene,
                                       "--device", "portable", "--repeat",
                                       "1",        "--json",   folder.file(std::string(name) + ".json"),
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_sundog(arguments);
    CAPTURE(name, result.err);
    CHECK(result.status == 0);
  };
  bench("threads", {"--sizes", "16,24", "--counts", "1,2", "--no-plain"});
  bench("samples", {"--counts", "1,2", "--adaptive", "0.05"});
  bench("workgroup", {"--kernel", "render_whitted", "--sizes", "2,4x4"});
  CommandOptions there;
  there.folder = folder.path();
  const CommandResult result =
      run_command({"python3", "-c", run_cells, SUNDOG_SOURCE_DIR "/examples/report.ipynb"}, there);
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK_THAT(result.out,
             ContainsSubstring("| pixels a side | 1 thread | 2 threads |\n| --- | --- | --- |\n| 16 |") &&
                 ContainsSubstring("| adaptive, 0.05 |") && ContainsSubstring("| 4x4 |"));
}
