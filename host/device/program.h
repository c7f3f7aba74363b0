// A built program and the contents of its entry in the binary cache. Internal to the device layer.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "device/compile_process.h"
#include "device/device.h"
#include "device/kernel_source.h"
#include "device/program_cache.h"

namespace sundog {

/// A program's text, expanded only if it is compiled.
struct ProgramSource {
  KernelText text;
  std::string identity;  // text.identity()
};

struct ProgramRecord {
  cl::Program program;
  DeviceInfo device;
  ProgramSource source;
  std::string options;               // build options
  std::string key;                   // everything that the binary depends on
  std::filesystem::path cache_file;  // empty: do not cache
  bool stored = false;               // the cache holds this program, with machine code for stored_variants
  std::set<std::string> stored_variants, launched_variants;

  const std::string& entry() const { return source.text.entry; }  // for messages
};

/// Prepared for a Device's next build: the program last found in the cache, and one that another process is
/// building.
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

/// Loads the program from the cache, takes another process's result, or compiles it. Throws BuildError,
/// DeviceError.
std::shared_ptr<ProgramRecord> build_program(const cl::Context& context, const cl::Device& device,
                                             const DeviceInfo& info, ProgramSource source,
                                             const BuildWish& wish, PreparedBuilds& prepared,
                                             BuildReport& report);

/// Whether build_program() would find the program in the cache. Keeps it for the next build.
bool is_program_cached(const DeviceInfo& info, const ProgramSource& source, const BuildWish& wish,
                       PreparedBuilds& prepared);

/// Starts another process that builds for build_program(), with machine code for `launch`. Returns whether
/// the process started.
bool begin_program(const DeviceInfo& info, const ProgramSource& source, const BuildWish& wish,
                   const EmptyLaunch& launch, PreparedBuilds& prepared);

/// Updates the cache if it lacks a launched variant. Skips a program that was never launched unless
/// `unlaunched`. Throws DeviceError, IoError.
void save_program(ProgramRecord& record, bool unlaunched);

}  // namespace sundog
