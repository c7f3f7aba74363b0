// The library in a process: first uses at once, copies side by side, fork(), dlclose().
#include <filesystem>
#include <sstream>

#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace fs = std::filesystem;

namespace {

/// With PoCL as the only driver where it is installed, as on a fresh system: beside Mesa's, which takes long
/// to load, threads that come first do not meet.
CommandResult own_process(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SUNDOG_OWN_PROCESS);
  const fs::path pocl = "/etc/OpenCL/vendors/pocl.icd";
  CommandOptions options;
  if (fs::exists(pocl)) {
    fs::create_directories(folder / "vendors");
    fs::copy_file(pocl, folder / "vendors/pocl.icd", fs::copy_options::overwrite_existing);
    options.environment["OCL_ICD_VENDORS"] = (folder / "vendors").string() + "/";
  }
  return run_command(arguments, options);
}

std::string copy_of_library(const TemporaryFolder& folder, const char* name) {
  fs::copy_file(SUNDOG_SHARED_LIBRARY, folder / name, fs::copy_options::overwrite_existing);
  return (folder / name).string();
}

}  // namespace

TEST_CASE("several threads may be the first to use the library") {
  const TemporaryFolder folder;
  for (int run = 0; run < 12; ++run) {
    const CommandResult result = own_process(folder, {"first_use"});
    CAPTURE(run, result.err);
    CHECK(result.status == 0);
    CHECK(result.out == "rendered\n");
  }
}

TEST_CASE("a program that rounds up and traps divisions by 0 has the same picture, and keeps its ways") {
  const TemporaryFolder folder;
  const CommandResult usual = own_process(folder, {"arithmetic"}),
                      other = own_process(folder, {"arithmetic", "other"});
  CAPTURE(other.err);
  CHECK(other.status == 0);
  CHECK(usual.out.find("kept") != std::string::npos);
  CHECK(other.out == usual.out);
}

TEST_CASE("two copies of the library may be first used at once") {
  const TemporaryFolder folder;
  const std::string first = copy_of_library(folder, "first.so"),
                    second = copy_of_library(folder, "second.so");
  for (int run = 0; run < 20; ++run) {
    const CommandResult result = own_process(folder, {"copies", first, second});
    CAPTURE(run, result.err);
    CHECK(result.status == 0);
    CHECK(result.out == "rendered\nrendered\n");
  }
}

TEST_CASE("a dlclose() after a render does not take the code of running threads away") {
  const TemporaryFolder folder;
  const CommandResult result = own_process(folder, {"unload", copy_of_library(folder, "library.so")});
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK(result.out == "rendered\nrendered\n");
}

TEST_CASE("after a fork() the library says that processes want to be spawned, and nothing hangs") {
  const TemporaryFolder folder;
  const CommandResult result = own_process(folder, {"fork"});
  CAPTURE(result.out, result.err);
  CHECK(result.status == 0);
  std::istringstream lines(result.out);
  int refused = 0;
  for (std::string line; std::getline(lines, line);) {
    CAPTURE(line);
    if (line.find(": kind 0: ") != std::string::npos && line.find("spawn") != std::string::npos)
      ++refused;
    else
      CHECK((line == "render before: no error" || line == "before: exited" || line == "after: exited" ||
             line == "idle: exited" || line == "parent: no error"));
  }
  CHECK(refused == 7);
}
