// Homes that may not be entered, folders without locks or the right to run what lies there, limits of the
// system, streams that are closed: each is one line with its mend, or makes no difference to the picture.
#include <base/file.h>

#include <algorithm>
#include <cstdio>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

/// A scene, a folder for the cache and one for temporary files, and shells that run sundog as "$0".
struct Surroundings : TemporaryFolder {
  std::string scene = write("least.json", least_scene).string();
  CommandOptions options;
  std::vector<std::string> before;  // a command that runs the shell

  Surroundings() {
    for (const char* name : {"cache", "tmp"}) fs::create_directory(*this / name);
    options.environment = {{"XDG_CACHE_HOME", (*this / "cache").string()},
                           {"TMPDIR", (*this / "tmp").string()},
                           {"SUNDOG_DEVICE", "pocl"},
                           {"POCL_CACHE_DIR", ""}};
    options.folder = path();
  }
  /// `line`, in which $0 is sundog and $render its rendering of the scene to a.pfm.
  CommandResult run(const std::string& line) const {
    std::vector<std::string> all = before;
    all.insert(all.end(),
               {"bash", "-c", "render=\"$0 render $1 -o a.pfm --quiet\"; " + line, SUNDOG_BINARY, scene});
    return run_command(all, options);
  }
  bool has_picture() const { return fs::exists(*this / "a.pfm"); }
  bool is_clean(const std::string& folder) const {
    return !fs::exists(*this / folder) || fs::is_empty(*this / folder);
  }
  std::size_t temporaries() const {
    return static_cast<std::size_t>(
        std::count_if(fs::directory_iterator(path()), fs::directory_iterator(),
                      [](const auto& e) { return e.path().extension() == ".tmp"; }));
  }
  /// False, and says so, where this machine does not let a test do it.
  bool can(const std::vector<std::string>& prefix) {
    std::vector<std::string> probe = prefix;
    probe.insert(probe.end(), {SUNDOG_BINARY, "--help"});
    before = prefix;
    if (run_command(probe).status == 0) return true;
    std::printf("%s is not allowed here: not tested with it\n", prefix[0].c_str());
    return false;
  }
  bool become_nobody() {
    fs::remove_all(*this / "cache/sundog");  // the one of whoever runs the test
    fs::permissions(path(), fs::perms::all);
    for (const char* name : {"cache", "tmp"}) fs::permissions(*this / name, fs::perms::all);
    options.environment["HOME"] = (*this / "cache").string();
    return can({"setpriv", "--reuid=64321", "--regid=65534", "--clear-groups"});
  }
};

}  // namespace

TEST_CASE("with a home that may not be entered there is a warning and the picture") {
  Surroundings here;
  if (!here.become_nobody()) return;
  fs::create_directory(here / "home");
  fs::permissions(here / "home", fs::perms::owner_all);
  here.options.environment["HOME"] = (here / "home").string();
  here.options.environment["XDG_CACHE_HOME"] = "";
  const CommandResult result = here.run("$render");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(is_one_error_line(result.err));
  CHECK_THAT(result.err,
             ContainsSubstring("warning: the cache is not used: ") &&
                 ContainsSubstring("home/.cache/sundog: Permission denied: name a folder of your own"));
  CHECK(here.has_picture());
  CHECK(here.is_clean("tmp"));
}

TEST_CASE("a file system without locks is used like another, and nothing is left there") {
  Surroundings here;
  here.options.environment["LD_PRELOAD"] = SUNDOG_NO_LOCKS;
  here.options.environment["NO_LOCKS_BELOW"] = here.path().string();
  const CommandResult result = here.run("$render");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  CHECK(here.has_picture());
  CHECK(here.is_clean("cache/sundog/pocl"));
  CHECK(here.is_clean("tmp"));
}

TEST_CASE("PoCL's files go where what it compiles may be run, else the message says noexec") {
  Surroundings here;
  if (!here.can({"unshare", "-m"})) return;
  CommandResult result =
      here.run("mount -t tmpfs -o noexec none cache && $render && ls cache/sundog/pocl tmp");
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  CHECK(here.has_picture());
  CHECK(here.is_clean("tmp"));
  fs::remove(here / "a.pfm");
  result = here.run("mount -t tmpfs -o noexec none cache && mount -t tmpfs -o noexec none tmp && $render");
  CHECK(result.status == 5);
  CHECK(is_one_error_line(result.err));
  CHECK_THAT(result.err, ContainsSubstring("is mounted noexec") &&
                             ContainsSubstring("name another folder by XDG_CACHE_HOME or TMPDIR"));
  CHECK_FALSE(here.has_picture());
}

TEST_CASE("PoCL finds its linker whatever PATH says") {
  const Surroundings here;
  for (const char* path : {"PATH=/nonexistent", "PATH=", "-u PATH"}) {
    const CommandResult result = here.run("/usr/bin/env " + std::string(path) + " $render");
    CAPTURE(path, result.err);
    CHECK(result.status == 0);
    CHECK(result.err.empty());
    fs::remove_all(here / "cache/sundog/kernels");
  }
}

TEST_CASE("a name that is too long and a folder that is gone are refused before the render") {
  const Surroundings here;
  const std::string longest(251, 'y');
  CommandResult result = here.run("$0 render $1 -o " + longest + "yy.png");
  CHECK(result.status == 1);
  CHECK(is_one_error_line(result.err));
  CHECK_THAT(result.err, ContainsSubstring("yy.png: cannot be written: File name too long\n"));
  result = here.run("$0 render $1 --quiet -o " + longest + ".png");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(fs::exists(here / (longest + ".png")));

  const std::string gone = "mkdir gone; cd gone; rmdir ../gone; ";
  result = here.run(gone + "$render");
  CHECK(result.status == 1);
  CHECK_THAT(result.err, ContainsSubstring("a.pfm: cannot be written: the folder . has been deleted"));
  CHECK(here.is_clean("tmp"));
  result = here.run(gone + "$0 render $1 --quiet -o " + (here / "b.pfm").string());
  CHECK(result.status == 0);
  result = here.run(gone + "$0 serve $1");
  CHECK(result.status == 1);
  CHECK_THAT(result.err,
             ContainsSubstring("the folder that sundog runs in: No such file or directory: go to another"));
}

TEST_CASE(
    "limits on files, address space and threads are named by the message, and nothing is killed or left") {
  Surroundings here;
  struct Case {
    const char *limit, *says;
    int status;
  };
  const auto check = [&](const Case& c) {
    const CommandResult result = here.run(c.limit + std::string("; $render"));
    CAPTURE(c.limit, result.err);
    CHECK(result.status == c.status);
    CHECK(is_one_error_line(result.err));
    CHECK_THAT(result.err, ContainsSubstring(c.says));
    CHECK_FALSE(here.has_picture());
    CHECK(here.temporaries() == 0);
    CHECK(here.is_clean("cache/sundog/pocl"));
    CHECK(here.is_clean("tmp"));
  };
  check({"ulimit -f 0", "a file may have 0 KiB (`ulimit -f`)", 5});
  check({"ulimit -f 1000", "a file may have 1000 KiB (`ulimit -f`)", 5});
  for (const char* space : {"ulimit -v 300000", "ulimit -v 900000", "ulimit -v 1200000"})
    check({space, "the limit on address space (`ulimit -v`, or a batch system's) of ", 1});
  if (!here.become_nobody()) return;
  for (const char* threads : {"ulimit -u 5", "ulimit -u 8"})
    check({threads, "(`ulimit -u`, or the container's)", 1});
}

TEST_CASE("standard streams that are closed are /dev/null, so that what is printed goes into no file") {
  Surroundings here;
  here.options.environment["SUNDOG_FAULTS"] = "hold@least.json";  // waits with the scene open
  CommandResult result = here.run(
      "$render <&- >&- 2>&- & p=$!; for i in {1..200}; do ls -l /proc/$p/fd | grep -q least.json && break; "
      "sleep .05; done; "
      "readlink /proc/$p/fd/{0,1,2}; kill -9 $p");
  CHECK(result.out == "/dev/null\n/dev/null\n/dev/null\n");
  here.options.environment.erase("SUNDOG_FAULTS");
  result = here.run("$0 render $1 -o a.pfm >&-");
  CHECK(result.status == 0);
  CHECK(read_file(here / "a.pfm").starts_with("PF\n32 24\n"));
  for (const char* command : {"$0 render $1 -o - >&-", "$0 info $1 --json >&-", "$0 devices >&-",
                              "$0 formulas >&-", "$0 --help >&-", "$0 serve $1 >&-"}) {
    INFO(command);
    result = here.run(command);
    CHECK(result.status == 2);
    CHECK_THAT(result.err, ContainsSubstring("the standard output is closed"));
  }
}

TEST_CASE("a symbolic link as the output stays, and what it names is written; a pipe is written into") {
  const Surroundings here;
  fs::create_directory(here / "real");
  fs::create_symlink("real/picture.pfm", here / "a.pfm");
  for (int time = 0; time < 2; ++time) {  // the file is not there, then it is
    REQUIRE(here.run("$render").status == 0);
    CHECK(fs::is_symlink(here / "a.pfm"));
    CHECK(fs::is_regular_file(fs::symlink_status(here / "real/picture.pfm")));
  }
  const std::string picture = read_file(here / "real/picture.pfm");
  fs::create_symlink("nowhere/picture.pfm", here / "b.pfm");
  CommandResult result = here.run("$0 render $1 -o b.pfm");
  CHECK(result.status == 1);
  CHECK_THAT(result.err, ContainsSubstring("b.pfm: cannot be written: there is no folder nowhere"));

  result = here.run(
      "mkfifo p.pfm; cat p.pfm >read & $0 render $1 -q -o p.pfm; s=$?; wait; [[ -p p.pfm ]] && exit $s");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(read_file(here / "read") == picture);
  result = here.run("mkfifo q.pfm; head -c 1 q.pfm >read & $0 render $1 -q --size 400x300 -o q.pfm");
  CHECK(result.status == 1);
  CHECK_THAT(result.err, ContainsSubstring("q.pfm: cannot be written: Broken pipe"));
  result = here.run("$render --stats /dev/fd/1");
  CHECK_THAT(result.out, ContainsSubstring("\"schema\": 1"));
}

TEST_CASE("without /proc devices are listed, a worker renders and check looks at drivers in processes") {
  Surroundings here;
  if (!here.can({"unshare", "-m"})) return;
  fs::create_directory(here / "vendors");
  here.write("vendors/fake.icd", SUNDOG_FAKE_DRIVER "\n");
  const std::string hide = "mount -t tmpfs none /proc && ";
  CommandResult result = here.run(hide + "$render --isolate");
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(here.has_picture());
  here.options.environment["OCL_ICD_VENDORS"] = (here / "vendors").string() + "/";
  here.options.environment["SUNDOG_DEVICE"] = "";
  result = here.run(hide + "$0 check");
  CHECK(result.status == 4);
  CHECK_THAT(result.out, ContainsSubstring("Fake crashing") && ContainsSubstring("crashed (signal "));
}
