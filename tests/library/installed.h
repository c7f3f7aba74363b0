// The library as it is installed.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "catch.h"
#include "run_command.h"

/// Runs a command, which must end well.
inline void must(const std::vector<std::string>& command) {
  const CommandResult result = run_command(command);
  CAPTURE(command, result.out, result.err);
  REQUIRE(result.status == 0);
}

/// libsundog with its headers, in a prefix that is moved after the installation.
inline std::filesystem::path install_library(const std::filesystem::path& folder) {
  for (const char* component : {"library", "development"})
    must({"cmake", "--install", std::filesystem::path(SUNDOG_BINARY).parent_path().string(), "--component",
          component, "--prefix", (folder / "first").string()});
  std::filesystem::rename(folder / "first", folder / "moved");
  return folder / "moved";
}

inline std::string find_below(const std::filesystem::path& folder, const std::string& name) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().filename() == name) return entry.path().string();
  FAIL("there is no " << name << " below " << folder);
  return "";
}
