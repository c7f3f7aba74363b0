// `cmake --install` puts the pages beside the program, and the files that they link to.
#include <base/file.h>

#include <filesystem>
#include <regex>

#include "catch.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace {

namespace fs = std::filesystem;

/// The files that a page's links and pictures name, relative to it; those of other sites and of the page
/// itself are left out.
std::vector<std::string> linked_files(const std::string& page) {
  static const std::regex link(R"re(\]\(([^)\s]+)\)|(?:src|href)="([^"]+)")re");
  std::vector<std::string> files;
  for (std::sregex_iterator at(page.begin(), page.end(), link), end; at != end; ++at) {
    const std::string target = (*at)[1].matched ? (*at)[1] : (*at)[2];
    const std::string file = target.substr(0, target.find('#'));
    if (!file.empty() && file.find("://") == file.npos && !file.starts_with("mailto:")) files.push_back(file);
  }
  return files;
}

std::vector<std::string> broken_links(const fs::path& folder, std::size_t& links) {
  std::vector<std::string> broken;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".md") continue;
    for (const std::string& file : linked_files(sundog::read_file(entry.path()))) {
      ++links;
      if (!fs::exists(entry.path().parent_path() / file))
        broken.push_back(fs::relative(entry.path(), folder).string() + ": " + file);
    }
  }
  return broken;
}

}  // namespace

TEST_CASE("the installed pages are whole: each relative link leads to an installed file") {
  const TemporaryFolder folder;
  const std::string build = fs::path(SUNDOG_BINARY).parent_path().string(), prefix = folder.path().string();
  const CommandResult installed =
      run_command({"cmake", "--install", build, "--component", "documents", "--prefix", prefix});
  CAPTURE(installed.err);
  REQUIRE(installed.status == 0);
  const fs::path pages = folder / "share/doc/sundog";
  for (const char* file :
       {"README.md", "LICENSE", "NOTICE", "docs/reference/command-line.md", "scenes/hollow_ice.json"}) {
    CAPTURE(file);
    CHECK(fs::exists(pages / file));
  }
  std::size_t links = 0;
  CHECK(broken_links(pages, links) == std::vector<std::string>());
  CHECK(links > 30);
}
