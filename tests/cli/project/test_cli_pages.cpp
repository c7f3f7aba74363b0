// The manual page and the completions that are written from `sundog --help`.
#include <filesystem>
#include <regex>

#include "base/file.h"
#include "catch.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace {

namespace fs = std::filesystem;

/// bash's completions for these words, the last of which is being typed.
std::string completed(const fs::path& pages, const std::string& words, int last) {
  return run_command({"bash", "-c",
                      "source '" + (pages / "sundog.bash").string() + "'; COMP_WORDS=(" + words +
                          "); COMP_CWORD=" + std::to_string(last) + "; _sundog; echo \"${COMPREPLY[*]}\""})
      .out;
}

}  // namespace

TEST_CASE("the manual page has every command and option, and bash completes them") {
  const TemporaryFolder folder;
  const CommandResult written =
      run_command({(fs::path(SUNDOG_SOURCE_DIR) / "cmake/write_command_pages.sh").string(), SUNDOG_BINARY,
                   folder.path().string()});
  CAPTURE(written.err);
  REQUIRE(written.status == 0);
  const std::string page =
      std::regex_replace(sundog::read_file(folder / "sundog.1"), std::regex(R"(\\-)"), "-");
  for (const char* text : {"sundog render", "models (.gltf .glb", "OPTIONS OF BENCH RAYS", "--samples",
                           "fIN\\fR", "-o,--out", "EXIT STATUS"}) {
    CAPTURE(text);
    CHECK(page.find(text) != page.npos);
  }
  const std::string help = run_sundog({"render", "--help"}).out;
  const std::regex option(R"(\n  (?:-\w,)?(--[a-z-]+))");
  int options = 0;
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at, ++options) {
    CAPTURE((*at)[1].str());
    CHECK(page.find((*at)[1].str()) != page.npos);
    CHECK(sundog::read_file(folder / "_sundog").find((*at)[1].str()) != std::string::npos);
  }
  CHECK(options > 20);
  CHECK(completed(folder.path(), "sundog ren", 1) == "render\n");
  CHECK(completed(folder.path(), "sundog render --sam", 2) == "--samples\n");
  CHECK(completed(folder.path(), "sundog bench rays --ki", 3) == "--kinds\n");
  for (const char* shell : {"zsh", "fish"})
    if (run_command({shell, "--version"}).status == 0)
      CHECK(run_command(
                {shell, "-n", (folder / (shell == std::string("zsh") ? "_sundog" : "sundog.fish")).string()})
                .status == 0);
}
