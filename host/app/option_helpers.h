// Short ways to declare options, the same in every command. For the files that declare options only: CLI11 is
// a large header.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace sundog {

inline constexpr const char* scene_help = "a .json scene, or a .gltf .glb .obj .ply .stl .nff model";
inline constexpr const char* device_help =
    "P:D, cpu, gpu, accelerator, all, part of a name, or !SPEC to take away; /N for N compute units "
    "(default: SUNDOG_DEVICE, or the fastest)";

template <class T>
CLI::Option* value(CLI::App* app, const char* name, const char* type, T& target, const std::string& help) {
  return app->add_option(name, target, help)->type_name(type);
}

/// An option that may be given several times, each time with one value.
inline void values(CLI::App* app, const char* name, const char* type, std::vector<std::string>& target,
                   const std::string& help) {
  value(app, name, type, target, help + "; repeatable")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

/// SPECs of SUNDOG_DEVICE, separated by commas.
std::vector<std::string> devices_of_environment();

}  // namespace sundog
