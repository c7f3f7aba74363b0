// sundog gallery: pictures on one page.
#include <base/file.h>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

TEST_CASE("gallery renders scenes and models to a page with the pictures that render makes") {
  const CliFolder folder;
  const std::string other = folder.write("other.json", small_scene).string(), site = folder.file("site");
  const CommandResult made = run_sundog({"gallery", site, folder.scene, other, "--size", "24x18"});
  CAPTURE(made.err);
  CHECK(made.status == 0);
  CHECK(made.err.empty());
  REQUIRE(run_sundog({"render", other, "-o", folder.file("one.png"), "--size", "24x18", "-q"}).status == 0);
  CHECK(read_file(folder / "site/other.png") == read_file(folder / "one.png"));
  const std::string page = read_file(folder / "site/index.html");
  for (const char* part : {"src=\"scene.png\"", "src=\"other.png\"", "24 x 18, ", "<dt>device</dt>"}) {
    INFO(part);
    CHECK(page.find(part) != std::string::npos);
  }
}

TEST_CASE("gallery refuses scenes of one name, and what is no scene, and keeps the pictures before it") {
  const CliFolder folder;
  std::filesystem::create_directories(folder / "more");
  const std::string same = folder.write("more/scene.json", small_scene).string(),
                    bad = folder.write("bad.json", "{").string(), site = folder.file("site");
  CommandResult result = run_sundog({"gallery", site, folder.scene, same});
  CHECK(result.status == 2);
  CHECK(result.err.find("another scene has the name scene too") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(site));
  result = run_sundog({"gallery", site, folder.scene, bad});
  CHECK(result.status == 3);
  CHECK(result.err.find("bad.json") != std::string::npos);
  CHECK(read_file(folder / "site/index.html").find("scene.png") != std::string::npos);
}

TEST_CASE("a gallery's page finds pictures of any name, and its commands work in a shell") {
  const CliFolder folder;
  const std::string site = folder.file("site");
  std::vector<std::string> command = {"gallery", site, "--size", "12x9", "-q"};
  for (const char* name : {"run#1", "50%25", "why?", "a b", "it's"})
    command.push_back(folder.write(std::string(name) + ".json", small_scene).string());
  const CommandResult made = run_sundog(command);
  CAPTURE(made.err);
  CHECK(made.status == 0);
  const std::string page = read_file(folder / "site/index.html");
  for (const char* file : {"run%231.png", "50%2525.png", "why%3F.png", "a%20b.png", "it%27s.png"}) {
    INFO(file);
    CHECK(page.find(std::string("<a href=\"") + file + "\"><img src=\"" + file + "\"") != std::string::npos);
  }
  CHECK(page.find("/it'\\''s.json' -o 'it'\\''s.png'") != std::string::npos);
  CHECK(page.find("-o 'run#1.png'") != std::string::npos);
}
