// The names of the tests themselves.
#include <filesystem>
#include <regex>

#include "base/file.h"
#include "catch.h"

namespace fs = std::filesystem;

// Catch2 2's console reporter indents what follows ": " by the length of what is before it. With one column
// left of the 80 it never ends, and takes all memory, when the test fails.
TEST_CASE("no name of a test or a section has a colon where a failure's report would never end") {
  const std::regex macro("(?:TEST_CASE|SECTION)\\(\\s*\"([^\"]*)\""), joined("\"\\s*\n\\s*\"");
  std::size_t names = 0;
  for (const auto& entry : fs::recursive_directory_iterator(SUNDOG_SOURCE_DIR "/tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = std::regex_replace(sundog::read_file(entry.path()), joined, "");
    for (std::sregex_iterator found(text.begin(), text.end(), macro), end; found != end; ++found, ++names) {
      const std::string name = (*found)[1];
      CAPTURE(entry.path().string(), name);
      const std::size_t colon = name.find(": ");
      CHECK((colon == std::string::npos || colon < 60));
    }
  }
  CHECK(names > 500);
}
