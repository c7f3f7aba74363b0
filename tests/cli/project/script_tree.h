// The project's scripts in a tree and with tools of the test's own.
#pragma once
#include <base/file.h>

#include <filesystem>
#include <string>
#include <vector>

#include "run_command.h"
#include "temporary_folder.h"

/// A tree with the project's scripts, a "sundog" that prints its arguments, and a folder of tools for the
/// PATH that note their calls in the file `calls`.
struct ScriptTree : TemporaryFolder {
  std::filesystem::path root = *this / "a tree", tools = *this / "tools", calls = *this / "calls";

  ScriptTree() {
    for (const char* script : {"run.sh", "cmake/prepare.sh"}) {
      std::filesystem::create_directories((root / script).parent_path());
      std::filesystem::copy_file(std::filesystem::path(SUNDOG_SOURCE_DIR) / script, root / script);
    }
    for (const char* folder : {"host", "bench", "kernels", "third_party", "build/release"})
      std::filesystem::create_directories(root / folder);
    for (const char* file : {"CMakeLists.txt", "CMakePresets.json"}) write("a tree/" + std::string(file), "");
    script("a tree/build/release/sundog", "printf '<%s>' \"$@\"");
    tool("cmake", "echo building");
    tool("sudo", "\"$@\"");
    tool("apt-get", "");
    tool("apt-cache", "[[ $2 != povray ]]");
    tool("dpkg-query",
         "for p in \"${@:4}\"; do [[ $p == libstb-dev || $p == povray ]] || echo \"$p installed\"; done");
  }

  void script(const std::string& name, const std::string& text) const {
    std::filesystem::permissions(write(name, "#!/bin/bash\n" + text + "\n"),
                                 std::filesystem::perms::owner_all);
  }
  void tool(const std::string& name, const std::string& text) const {
    script("tools/" + name, "echo \"" + name + " $*\" >>'" + calls.string() + "'\n" + text);
  }
  CommandResult run(const std::vector<std::string>& arguments) const {
    std::filesystem::remove(calls);
    CommandOptions options;
    options.folder = path();
    options.environment["PATH"] = tools.string() + ":/usr/bin:/bin";
    return run_command(arguments, options);
  }
  CommandResult run_script() const { return run({(root / "run.sh").string(), "render", "a scene.json", ""}); }
  std::string called() const { return std::filesystem::exists(calls) ? sundog::read_file(calls) : ""; }
};
