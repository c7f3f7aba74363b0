// Files that render reads and writes: outside the scene's folder, no regular files, the cache.
#include <base/file.h>
#include <sys/stat.h>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

fs::perms mode(const fs::path& path) { return fs::status(path).permissions() & fs::perms::mask; }

/// A scene in "in" with a model from "out".
struct OutsideFolder : CliFolder {
  OutsideFolder() {
    write("out/m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("in/a.json", R"({"image":{"width":16,"height":12},"lights":[{"type":"ambient"}],
      "objects":[{"type":"model","file":"../out/m.obj"}]})");
  }
  CommandResult run(std::vector<std::string> command, bool allowed) const {
    if (allowed) command.emplace_back("--allow-outside-files");
    return run_sundog(command);
  }
};

}  // namespace

TEST_CASE("files outside the scene's folder are read with --allow-outside-files only, by every command") {
  const OutsideFolder folder;
  const std::string scene = folder.file("in/a.json");
  const std::vector<std::vector<std::string>> commands = {
      {"render", scene, "-o", folder.file("a.png")},
      {"render", scene, "-o", folder.file("a.png"), "--isolate"},
      {"info", scene},
      {"bench", "workgroup", scene, "--repeat", "1", "--quiet"},
      {"tune", scene, "--budget", "0"}};
  for (const std::vector<std::string>& command : commands) {
    CAPTURE(command[0], command.size());
    const CommandResult refused = folder.run(command, false);
    CHECK(refused.status == 3);
    CHECK(is_one_error_line(refused.err));
    CHECK(contains(refused.err, "leads out of the scene's folder"));
    if (command[0] == "bench" || command[0] == "tune") continue;
    CHECK(folder.run(command, true).status == 0);
  }
  CHECK(run_sundog({"tune", "--help"}).out.find("--allow-outside-files") != std::string::npos);
  CHECK(run_sundog({"bench", "workgroup", "--help"}).out.find("--allow-outside-files") != std::string::npos);
}

TEST_CASE("a pipe or a device in a file's place is refused at once, with status 3") {
  const CliFolder folder;
  REQUIRE(::mkfifo(folder.file("pipe.json").c_str(), 0600) == 0);
  REQUIRE(::mkfifo(folder.file("pipe.obj").c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", folder / "endless.obj");
  fs::create_symlink("/dev/zero", folder / "endless.part");
  CommandOptions options;
  options.timeout = 20;
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"info", folder.file("pipe.json")},
        {"info", folder.file("pipe.obj")},
        {"info", folder.file("endless.obj")},
        {"merge", folder.file("endless.part"), "-o", folder.file("a.png")},
        {"render", folder.scene, "-o", folder.file("a.png"), "--resume", folder.file("pipe.obj")}}) {
    const CommandResult result = run_sundog(command, options);
    CAPTURE(command[1], result.err);
    CHECK(result.status == 3);
    CHECK_FALSE(result.timed_out);
    CHECK(contains(result.err, "is no regular file"));
  }
}

TEST_CASE("the cache is the user's own: made for him alone, and not used where others may write") {
  const CliFolder folder;
  fs::create_directory(folder / "cache");
  CommandOptions options;
  options.environment["XDG_CACHE_HOME"] = folder.file("cache");
  const std::vector<std::string> command = {"render", folder.write("least.json", least_scene).string(), "-o",
                                            folder.file("a.png"), "--quiet"};
  const fs::path own = folder / "cache/sundog";
  REQUIRE(run_sundog(command, options).status == 0);
  for (const fs::path& made : {own, own / "kernels"}) CHECK(mode(made) == fs::perms::owner_all);
  REQUIRE_FALSE(fs::is_empty(own / "kernels"));
  for (const fs::path& open : {own, own / "kernels"}) {
    fs::remove_all(own);
    fs::create_directories(own / "kernels");
    fs::permissions(own, fs::perms(0755));
    fs::permissions(open, fs::perms(0777));
    const CommandResult result = run_sundog(command, options);
    CAPTURE(result.err);
    CHECK(result.status == 0);
    CHECK(result.err.starts_with("sundog: warning: the cache is not used: others may write to " +
                                 open.string()));
    CHECK(fs::is_empty(own / "kernels"));
    fs::permissions(open, fs::perms(0755));
  }
  CHECK(run_sundog(command, options).err.empty());
  CHECK_FALSE(fs::is_empty(own / "kernels"));
}
