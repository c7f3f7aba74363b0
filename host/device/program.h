// A built program and what its entry in the binary cache holds. Internal to the device layer.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "device/compile_process.h"
#include "device/device.h"
#include "device/program_cache.h"

namespace sundog {

struct ProgramRecord {
  cl::Program program;
  DeviceInfo device;
  std::string entry;                 // the kernel file, for messages
  std::string source;                // expanded
  std::string options;               // that it is built with
  std::string key;                   // all that the binary depends on
  std::filesystem::path cache_file;  // empty: there is no cache to store it in
  bool stored = false;               // the cache holds this program, with the machine code of stored_variants
  std::set<std::string> stored_variants, launched_variants;
};

/// What is there for the next build of a Device: the program that the cache was last found to hold, and one
/// that another process builds.
struct PreparedBuilds {
  struct Found {
    std::string key;
    CachedProgram program;
  };
  struct Begun {
    std::string key;
    CompileProcess process;
  };
  std::optional<Found> found;
  std::optional<Begun> begun;
};

/// Loads the program from the cache, takes what another process has built, or compiles it. Throws BuildError,
/// DeviceError.
std::shared_ptr<ProgramRecord> build_program(const cl::Context& context, const cl::Device& device,
                                             const DeviceInfo& info, const std::string& entry,
                                             const std::string& source, const BuildWish& wish,
                                             PreparedBuilds& prepared, BuildReport& report);

/// Whether build_program() would find it in the cache. The next one need not read it again.
bool is_program_cached(const DeviceInfo& info, const std::string& source, const BuildWish& wish,
                       PreparedBuilds& prepared);

/// Has another process build it for build_program(), with machine code for `launch`. Returns whether one
/// does.
bool begin_program(const DeviceInfo& info, const std::string& source, const BuildWish& wish,
                   const EmptyLaunch& launch, PreparedBuilds& prepared);

/// Stores the program when the cache lacks something that was launched. Throws DeviceError, IoError.
void save_program(ProgramRecord& record);

}  // namespace sundog
