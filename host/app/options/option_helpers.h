// Helpers that declare options alike in every command.
#pragma once
#include <string>
#include <vector>

#include "base/arguments.h"
#include "models/model.h"

namespace sundog {

inline constexpr const char* scene_help =
    "a .json scene (-: from the standard input), or a " SUNDOG_MODEL_EXTENSIONS " model";
inline constexpr const char* device_help =
    "P:D, cpu, gpu, accelerator, all, part of a name (pocl, nvidia, ...), or !SPEC to take away (!SPEC?: if "
    "it is there); /N for N compute units (default: SUNDOG_DEVICE, or the fastest)";

template <class T>
Option* value(Arguments* app, const char* name, const char* type, T& target, const std::string& help) {
  return app->add_option(name, target, help)->type_name(type);
}

/// Declares an option that may be repeated, with one value each time.
inline void values(Arguments* app, const char* name, const char* type, std::vector<std::string>& target,
                   const std::string& help) {
  value(app, name, type, target, help + "; repeatable")->one_value_each();
}

inline void outside_files(Arguments* app, bool& target) {
  app->add_flag(
      "--allow-outside-files", target,
      "the scene and its models may name files outside their own folders; only for files that you trust");
}

}  // namespace sundog
