// Renders whose devices, drivers and disks fail as SUNDOG_FAULTS (host/base/faults.h) says.
#pragma once
#include <base/file.h>

#include <nlohmann/json.hpp>

#include "catch.h"
#include "cli_scene.h"

/// A folder whose renders have two devices, PoCL's "basic" (0:0) and "pthread" (0:1), which compute the same
/// bits.
struct FaultyFolder : CliFolder {
  CommandOptions options;
  FaultyFolder() { options.environment["POCL_DEVICES"] = "basic pthread"; }

  std::string size = "160x120";
  CommandResult render(const std::string& faults, const std::vector<std::string>& more = {}) {
    options.environment["SUNDOG_FAULTS"] = faults;
    std::vector<std::string> arguments = {"render",  scene,          "-o",        file("a.pfm"),
                                          "--size",  size,           "--samples", "4",
                                          "--stats", file("s.json"), "--device",  "portable comp"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sundog(arguments, options);
  }
  std::string plain() {
    const CommandResult result = render("");
    REQUIRE(result.status == 0);
    CHECK(result.err.empty());
    return sundog::read_file(*this / "a.pfm");
  }
  nlohmann::json stats() const { return nlohmann::json::parse(sundog::read_file(*this / "s.json")); }
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
