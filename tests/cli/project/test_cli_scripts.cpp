// run.sh and the scripts that check sources, in a tree and with tools of the test's own: when they build,
// what they pass on.
#include <filesystem>

#include "catch.h"
#include "script_tree.h"

namespace fs = std::filesystem;
using sundog::read_file;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("run.sh builds at first, then only starts sundog with its arguments") {
  const ScriptTree tree;
  CommandResult result = tree.run_script();
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.out == "<render><a scene.json><>");  // what the build says goes to stderr
  CHECK(contains(tree.called(), "cmake --preset release"));
  CHECK(contains(tree.called(), "--target sundog"));
  result = tree.run_script();
  CHECK(result.out == "<render><a scene.json><>");
  CHECK(result.err.empty());
  CHECK(tree.called().empty());
}

TEST_CASE("run.sh builds again when a source is changed, added or taken away") {
  const ScriptTree tree;
  tree.write("a tree/host/a.cpp", "");
  REQUIRE(tree.run_script().status == 0);
  const auto later = fs::file_time_type::clock::now() + std::chrono::seconds(2);
  SECTION("changed") { fs::last_write_time(tree.root / "host/a.cpp", later); }
  SECTION("added") {
    tree.write("a tree/kernels/b.cl", "");
    fs::last_write_time(tree.root / "kernels/b.cl", later);
  }
  SECTION("taken away") {
    fs::remove(tree.root / "host/a.cpp");
    fs::last_write_time(tree.root / "host", later);
  }
  SECTION("the program is gone") { fs::rename(tree.root / "build/release/sundog", tree / "sundog"); }
  tree.run_script();
  CHECK(contains(tree.called(), "cmake --build"));
}

TEST_CASE("a failed build is run.sh's failure, and the next call tries again") {
  const ScriptTree tree;
  tree.tool("cmake", "echo broken; false");
  const CommandResult result = tree.run_script();
  CHECK(result.status != 0);
  CHECK(result.out.empty());
  CHECK(contains(result.err, "broken"));
  tree.tool("cmake", "");
  CHECK(tree.run_script().status == 0);
  CHECK(contains(tree.called(), "cmake --preset release"));
}

TEST_CASE("the build notes the git commit, whether files differ from it, and nothing outside git") {
  const TemporaryFolder folder;
  const std::string source = folder.write("tree/a.txt", "a").parent_path().string(),
                    output = (folder / "revision.cpp").string();
  const auto revision = [&] {
    const CommandResult result = run_command({"cmake", "-DSOURCE=" + source, "-DOUTPUT=" + output, "-P",
                                              SUNDOG_SOURCE_DIR "/cmake/GitRevision.cmake"});
    CHECK(result.status == 0);
    const std::string text = read_file(output);
    const std::size_t start = text.find("return \"") + 8;
    return text.substr(start, text.find('"', start) - start);
  };
  CHECK(revision() == "unknown");
  const auto git = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"git", "-C", source, "-c", "user.name=a", "-c", "user.email=a@b"});
    return run_command(arguments);
  };
  if (git({"init", "-q"}).status != 0) return;  // no git here
  CHECK(revision() == "unknown");               // without a commit
  git({"add", "a.txt"});
  git({"commit", "-q", "-m", "first"});
  const std::string commit = git({"rev-parse", "--short=12", "HEAD"}).out;
  CHECK(revision() + "\n" == commit);
  const auto written = fs::last_write_time(output);
  CHECK(revision() + "\n" == commit);
  CHECK(fs::last_write_time(output) == written);  // so nothing is compiled again
  folder.write("tree/a.txt", "b");
  CHECK(revision() + "\n" == commit.substr(0, 12) + " with changes\n");
  fs::create_directory(folder / "tree/inner");  // a part of somebody else's checkout
  const std::string whole = "-DSOURCE=" + source + "/inner";
  run_command({"cmake", whole, "-DOUTPUT=" + output, "-P", SUNDOG_SOURCE_DIR "/cmake/GitRevision.cmake"});
  CHECK(contains(read_file(output), "unknown"));
}

TEST_CASE("the format check passes a formatted tree and fails one line that is not") {
  const TemporaryFolder tree;
  for (const char* file : {"tests/check_format.sh", ".clang-format"}) {
    fs::create_directories((tree / file).parent_path());
    fs::copy_file(fs::path(SUNDOG_SOURCE_DIR) / file, tree / file);
  }
  for (const char* folder : {"host", "kernels", "bench"}) fs::create_directories(tree / folder);
  tree.write("host/a.cpp", "int a() { return 1; }\n");
  tree.write("kernels/b.cl", "int b() { return 2; }\n");
  const std::string check = (tree / "tests/check_format.sh").string();
  CommandResult result = run_command({check});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  if (contains(result.err, "no clang-format 19")) return;
  tree.write("kernels/b.cl", "int b( ) { return 2; }\n");
  result = run_command({check});
  CHECK(result.status == 1);
  CHECK(contains(result.err, "b.cl:1"));
  CHECK_FALSE(contains(result.err, "a.cpp"));
}

TEST_CASE("the check by clang-tidy reads the sources that changed, and fails for what it finds") {
  const TemporaryFolder tree;
  for (const char* file : {"tests/tidy.sh", ".clang-tidy"}) {
    fs::create_directories((tree / file).parent_path());
    fs::copy_file(fs::path(SUNDOG_SOURCE_DIR) / file, tree / file);
  }
  for (const char* folder : {"host", "bench", "build"}) fs::create_directories(tree / folder);
  tree.write("CMakeLists.txt",
             "cmake_minimum_required(VERSION 3.22)\nproject(tree CXX)\nfile(GLOB all host/*.cpp)\n"
             "add_library(tree ${all})\n");
  tree.write("CMakePresets.json",
             R"({"version": 3, "configurePresets": [{"name": "release", "generator": "Ninja", "binaryDir":
               "${sourceDir}/build/release", "cacheVariables": {"CMAKE_EXPORT_COMPILE_COMMANDS": "ON"}}]})");
  tree.write(".gitignore", "build\n");
  const std::string fault =
      "bool is_empty(double x, double y) { if (x = y) return true; return x / 2 > (1 / 2); }\n";
  tree.write("host/old.cpp", fault);
  tree.write("host/a.cpp", "int a() { return 1; }\n");
  CommandOptions options;
  options.folder = tree.path();
  const auto run = [&](const std::string& command) { return run_command({"bash", "-c", command}, options); };
  REQUIRE(run("git init -q -b main && git add . && git -c user.name=a -c user.email=a commit -qm 1").status ==
          0);
  CHECK(run("tests/tidy.sh").status == 0);
  tree.write("host/a.cpp", fault);
  const CommandResult changed = run("tests/tidy.sh"), all = run("tests/tidy.sh --all");
  if (contains(changed.err, "no clang-tidy 19")) return;
  CHECK(changed.status == 1);
  CHECK(contains(changed.out, "a.cpp:1"));
  CHECK_FALSE(contains(changed.out, "old.cpp"));
  CHECK(contains(all.out, "old.cpp:1"));
}
