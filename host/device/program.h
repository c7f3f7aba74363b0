// A built program and what its entry in the binary cache holds. Internal to the device layer.
#pragma once
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "device/device.h"

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

/// Expands, and loads from the cache or compiles. Throws BuildError, DeviceError.
std::shared_ptr<ProgramRecord> build_program(const cl::Context& context, const cl::Device& device,
                                             const DeviceInfo& info, const std::string& entry,
                                             const std::string& source, const BuildWish& wish,
                                             BuildReport& report);

/// Whether build_program() would find it in the cache.
bool is_program_cached(const DeviceInfo& info, const std::string& source, const BuildWish& wish);

/// Stores the program when the cache lacks something that was launched. Throws DeviceError, IoError.
void save_program(ProgramRecord& record);

}  // namespace sundog
