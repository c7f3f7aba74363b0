// cmake/prepare.sh: which packages it installs, how much it says that is, and what it does where it may not.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "catch.h"
#include "script_tree.h"

namespace fs = std::filesystem;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("only the packages that are missing are installed") {
  const ScriptTree tree;
  const std::string prepare = (tree.root / "cmake/prepare.sh").string();
  CHECK(tree.run({prepare, "program"}).status == 0);
  CHECK(contains(tree.called(), "install -y -qq --no-install-recommends libstb-dev\n"));
  CHECK_FALSE(contains(tree.called(), "povray"));
  tree.tool("dpkg-query", "for p in \"${@:4}\"; do echo \"$p installed\"; done");
  CHECK(tree.run({prepare, "program"}).status == 0);
  CHECK_FALSE(contains(tree.called(), "apt"));
}

TEST_CASE("a package that this distribution does not have is reported and left out") {
  const ScriptTree tree;
  const CommandResult result = tree.run({(tree.root / "cmake/prepare.sh").string(), "tests"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "no package povray here"));
  CHECK_FALSE(contains(tree.called(), "recommends povray"));
  CHECK(contains(tree.called(), "--target all"));
}

TEST_CASE("without apt the build continues and names what it needs") {
  const ScriptTree tree;
  fs::remove(tree.tools / "apt-get");
  fs::create_directory(tree / "bin");  // all that the script calls but apt-get
  for (const char* name :
       {"bash", "env", "readlink", "dirname", "mkdir", "flock", "grep", "xargs", "touch", "cat", "echo"})
    fs::create_symlink(fs::path("/usr/bin") / name, tree / "bin" / name);
  fs::remove(tree.calls);
  CommandOptions options;
  options.environment["PATH"] = tree.tools.string() + ":" + (tree / "bin").string();
  const CommandResult result = run_command({(tree.root / "cmake/prepare.sh").string(), "program"}, options);
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(contains(result.err, "there is no apt-get here"));
  CHECK(contains(result.err, "libstb-dev"));
  CHECK(contains(tree.called(), "cmake --build"));
}

TEST_CASE("while another program has apt's locks the script says so once and waits") {
  const ScriptTree tree;
  tree.tool("apt-get",
            "[[ $1 == -s || $1 == --print-uris ]] && exit 0\n"
            "n=$(cat '" +
                (tree / "turns").string() + "' 2>/dev/null || echo 0); echo $((n + 1)) >'" +
                (tree / "turns").string() +
                "'\n"
                "if ((n < 2)); then echo 'E: Could not get lock /var/lib/dpkg/lock-frontend. It is held by "
                "process 7' >&2; exit 100; fi");
  const CommandResult result = tree.run({(tree.root / "cmake/prepare.sh").string(), "program"});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  const std::size_t said = result.err.find("apt is locked by another program");
  CHECK(said != std::string::npos);
  CHECK(result.err.find("apt is locked", said + 1) == std::string::npos);
  CHECK_FALSE(contains(result.err, "E: Could not get lock"));
  CHECK(contains(tree.called(), "recommends libstb-dev\n"));
  CHECK(contains(tree.called(), "--target sundog"));
}

TEST_CASE("packages that fail end the build beside them at once, with a line that says so") {
  const ScriptTree tree;
  tree.tool("dpkg-query", "for p in \"${@:4}\"; do [[ $p == povray ]] || echo \"$p installed\"; done");
  tree.tool("apt-cache", "");
  tree.tool("apt-get",
            "if [[ $1 == install ]]; then echo 'E: Unable to fetch some archives' >&2; exit 100; fi");
  tree.tool("cmake", "[[ $1 == --build ]] && sleep 60");
  const CommandResult result = tree.run({(tree.root / "cmake/prepare.sh").string(), "packages"});
  CAPTURE(result.err);
  CHECK(result.status == 1);
  CHECK(result.seconds < 30);
  CHECK(contains(result.err, "E: Unable to fetch some archives"));
  CHECK(contains(result.err, "sundog: the packages could not be installed\n"));
}

TEST_CASE("how much there is to install is asked of apt in ways that need no right and install nothing") {
  const ScriptTree tree;
  tree.tool("apt-get", R"(case "$1 $2" in
      '-s -qq') echo 'Inst libstb-dev (1.0 Debian:12 [amd64])'; echo 'Inst libstb0 (1.0 Debian:12 [amd64])';;
      '--print-uris -qq') echo "'http://a/b.deb' b.deb 2600000 MD5:0"; echo "'http://a/c.deb' c.deb 1000000 MD5:0";;
    esac)");
  tree.tool("apt-cache", "printf 'Package: a\nInstalled-Size: 2000\n'");
  const CommandResult result = tree.run({(tree.root / "cmake/prepare.sh").string(), "program"});
  CAPTURE(result.err);
  CHECK(contains(result.err, "with what they need 2 packages, 4 MB to fetch, 2 MB on disk"));
  CHECK_FALSE(contains(tree.called(), "assume-no"));
}

namespace {

/// Runs as nobody, in a tree that belongs to another, with no sudo; no result where this test may not become
/// somebody else.
std::optional<CommandResult> run_as_nobody(const ScriptTree& tree, const std::string& command) {
  fs::remove(tree.calls);
  fs::remove(tree.tools / "sudo");
  fs::permissions(tree.path(), fs::perms(0755));
  for (const auto& tool : fs::directory_iterator(tree.tools)) fs::permissions(tool, fs::perms(0755));
  for (const char* script : {"run.sh", "cmake/prepare.sh", "build/release/sundog"})
    if (fs::exists(tree.root / script)) fs::permissions(tree.root / script, fs::perms(0755));
  CommandOptions options;
  const fs::path home = tree / "home";
  fs::create_directories(home);
  fs::permissions(home, fs::perms(0777));
  std::ofstream(tree.calls).close();
  fs::permissions(tree.calls, fs::perms(0666));
  options.environment = {
      {"PATH", tree.tools.string() + ":/usr/bin:/bin"}, {"HOME", home.string()}, {"XDG_CACHE_HOME", ""}};
  const std::vector<std::string> nobody{"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
  std::vector<std::string> probe = nobody, whole = nobody;
  probe.emplace_back("true");
  if (run_command(probe).status != 0) return std::nullopt;
  whole.insert(whole.end(), {"bash", "-c", command});
  return run_command(whole, options);
}

}  // namespace

TEST_CASE(
    "a clone that cannot be written is built in the user's cache; without root and sudo one line says so") {
  const ScriptTree tree;
  const std::string run = "'" + (tree.root / "run.sh").string() + "' render";
  SECTION("packages are missing") {
    if (fs::exists("/usr/bin/sudo") || fs::exists("/bin/sudo")) return;
    const auto result = run_as_nobody(tree, run);
    if (!result) return;
    CAPTURE(result->err);
    CHECK(result->status == 1);
    CHECK(contains(
        result->err,
        "neither root nor sudo to install them: ask an administrator for: apt-get install libstb-dev\n"));
    CHECK(std::ranges::count(result->err, '\n') == 1);
    CHECK_FALSE(contains(tree.called(), "apt-get"));
  }
  SECTION("all are there") {
    tree.tool("dpkg-query", "for p in \"${@:4}\"; do echo \"$p installed\"; done");
    tree.tool("cmake",
              "[[ $1 == --build ]] && printf '#!/bin/bash\necho built \"$@\"\n' >\"$2/sundog\" && chmod +x "
              "\"$2/sundog\"; true");
    const auto result = run_as_nobody(tree, run);
    if (!result) return;
    CAPTURE(result->err);
    CHECK(result->status == 0);
    CHECK(result->out == "built render\n");
    CHECK(fs::exists((tree / "home/.cache/sundog-build").string() + tree.root.string() + "/sundog"));
    CHECK(fs::is_directory(tree.root / "build/release"));
  }
  SECTION("the tests") {
    const auto result = run_as_nobody(tree, "'" + (tree.root / "cmake/prepare.sh").string() + "' packages");
    if (!result) return;
    CHECK(result->status == 1);
    CHECK(contains(result->err, "build/release cannot be written: copy the clone"));
    CHECK(std::ranges::count(result->err, '\n') == 1);
  }
}
