// Building: from the binary cache where it can be trusted, else by the driver's compiler.
#include "device/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "base/error.h"
#include "base/faults.h"
#include "base/file.h"
#include "device/cl_status.h"
#include "device/compile_process.h"
#include "device/program_cache.h"

namespace sundog {
namespace {

// Argument information is asked for always, so that the tests check the very program that renders.
constexpr const char* build_options = "-cl-std=CL1.2 -cl-kernel-arg-info";

/// Everything that may change what the compiler makes. PoCL reads the named variables when it compiles.
std::string program_key(const DeviceInfo& info, const std::string& source) {
  std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", info.platform_name, info.platform_version,
                                info.name, info.driver, info.version, build_options);
  for (const char* name :
       {"POCL_EXTRA_BUILD_FLAGS", "POCL_WORK_GROUP_METHOD", "POCL_WORK_GROUP_SPECIALIZATION"}) {
    const char* value = std::getenv(name);
    key += fmt::format("{}={}\n", name, value ? value : "");
  }
  return key + source;
}

/// SUNDOG_DUMP_KERNELS=folder keeps each program's final text there.
void dump_source(const std::string& entry, const std::string& source) {
  const char* folder = std::getenv("SUNDOG_DUMP_KERNELS");
  if (!folder || !*folder) return;
  std::filesystem::create_directories(folder);
  const std::string stem = std::filesystem::path(entry).stem().string();
  write_file(std::filesystem::path(folder) / fmt::format("{}-{:.8}.cl", stem, hash128(source)), source);
}

std::string build_log(const cl::Program& program, const cl::Device& device) {
  std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

/// The log's first line that speaks of an error, else its first line.
std::string first_error(const std::string& log) {
  std::istringstream in(log);
  std::string first;
  for (std::string line; std::getline(in, line);) {
    if (line.find("error") != std::string::npos) return line;
    if (first.empty()) first = line;
  }
  return first.empty() ? "the compiler gave no reason" : first;
}

/// Whether the driver can make kernels of what its compiler made.
bool kernels_work(const cl::Program& program) {
  std::istringstream names(program.getInfo<CL_PROGRAM_KERNEL_NAMES>());
  cl_int status = CL_INVALID_PROGRAM_EXECUTABLE;
  for (std::string name; std::getline(names, name, ';');) {
    cl::Kernel(program, name.c_str(), &status);
    if (status != CL_SUCCESS) break;
  }
  return status == CL_SUCCESS;
}

/// The program of a cached binary; null when the driver will not have it.
cl::Program program_from_binary(const cl::Context& context, const cl::Device& device,
                                const std::string& binary) {
  const cl::Program::Binaries binaries{{binary.begin(), binary.end()}};
  std::vector<cl_int> statuses;
  cl_int status = CL_SUCCESS;
  cl::Program program(context, {device}, binaries, &statuses, &status);
  if (status != CL_SUCCESS || std::ranges::any_of(statuses, [](cl_int s) { return s != CL_SUCCESS; }))
    return {};
  if (program.build({device}, build_options) != CL_SUCCESS || !kernels_work(program)) return {};
  return program;
}

/// Builds a program of nothing: the driver reads what it needs to build any. A name of its own, lest the
/// driver has it in a cache.
void warm_up(const cl::Context& context, const cl::Device& device, const std::string& name) {
  cl_int status = CL_SUCCESS;
  const cl::Program nothing(context, fmt::format("__kernel void nothing_{}(void) {{}}", name), false,
                            &status);
  if (status == CL_SUCCESS) nothing.build({device}, build_options);
}

/// The program of a binary that another process compiled; null when the driver will not have it.
cl::Program program_of_parts(const cl::Context& context, const cl::Device& device,
                             const std::string& compiled) {
  std::vector<cl_int> statuses;
  cl_int status = CL_SUCCESS;
  const cl::Program::Binaries binaries{{compiled.begin(), compiled.end()}};
  const cl::Program part(context, {device}, binaries, &statuses, &status);
  if (status != CL_SUCCESS || std::ranges::any_of(statuses, [](cl_int s) { return s != CL_SUCCESS; }))
    return {};
  cl::Program whole = cl::linkProgram({part}, nullptr, nullptr, nullptr, &status);
  return status == CL_SUCCESS && kernels_work(whole) ? whole : cl::Program();
}

/// Compiles in another process while this one's driver makes itself ready; false: it has to be done here.
bool compile_beside(ProgramRecord& record, const cl::Context& context, const cl::Device& device,
                    const std::string& source) {
  auto process = CompileProcess::start(record.device, source, build_options);
  if (!process) return false;
  warm_up(context, device, hash128(source));
  const std::string compiled = process->wait();
  if (!compiled.empty()) record.program = program_of_parts(context, device, compiled);
  return record.program() != nullptr;
}

void compile(ProgramRecord& record, const cl::Context& context, const cl::Device& device,
             const std::string& source, const std::string& options, BuildReport& report) {
  cl_int status = CL_SUCCESS;
  record.program = cl::Program(context, source, false, &status);
  check_cl(status, record.device, fmt::format("{}: clCreateProgramWithSource", record.entry));
  status = record.program.build({device}, options.c_str());
  report.log = build_log(record.program, device);
  if (status == CL_SUCCESS) return;
  if (status != CL_BUILD_PROGRAM_FAILURE && report.log.empty())
    check_cl(status, record.device, fmt::format("{}: clBuildProgram", record.entry));
  throw BuildError(
      fmt::format("{} did not build on {}: {}", record.entry, record.device.label(), first_error(report.log)),
      report.log);
}

/// Oclgrind's optimiser leaves calls in the program that its interpreter does not know (llvm.bitreverse,
/// noalias scopes): such a program builds, but gives no kernels. Without optimisation it runs.
void compile_to_kernels(ProgramRecord& record, const cl::Context& context, const cl::Device& device,
                        const std::string& source, BuildReport& report) {
  compile(record, context, device, source, build_options, report);
  if (kernels_work(record.program)) return;
  compile(record, context, device, source, fmt::format("{} -cl-opt-disable", build_options), report);
  if (kernels_work(record.program)) return;
  throw BuildError(fmt::format("{} on {}: the driver built it but makes no kernels of it", record.entry,
                               record.device.label()),
                   report.log);
}

}  // namespace

std::shared_ptr<ProgramRecord> build_program(const cl::Context& context, const cl::Device& device,
                                             const DeviceInfo& info, const std::string& entry,
                                             const std::string& source, BuildReport& report) {
  dump_source(entry, source);
  if (fault("build", fmt::format("{}:{}", info.platform, info.device)))
    throw BuildError(fmt::format("{} did not build on {}: a fault was asked for", entry, info.label()), "");
  auto record = std::make_shared<ProgramRecord>();
  record->device = info;
  record->entry = entry;
  record->source = source;
  record->key = program_key(info, source);
  record->cache_file = program_cache_file(record->key);
  if (const auto cached = load_program(record->cache_file, record->key)) {
    record->program = program_from_binary(context, device, cached->binary);
    if (record->program()) {
      report.cached = true;
      record->stored = true;
      record->stored_variants = cached->variants;
      return record;
    }
    report.note = fmt::format("{}: the driver refused the cached binary", record->cache_file.string());
  }
  if (!record->cache_file.empty())
    if (const auto reason = cannot_store(record->cache_file)) {
      report.note = *reason;
      record->cache_file.clear();
    }
  if (!compile_beside(*record, context, device, source))
    compile_to_kernels(*record, context, device, source, report);
  return record;
}

void save_program(ProgramRecord& record) {
  const bool complete = std::ranges::includes(record.stored_variants, record.launched_variants);
  // What was never launched is not worth it: PoCL would compile it now to give its binary out.
  if (record.cache_file.empty() || record.launched_variants.empty() || (record.stored && complete)) return;
  cl_int status = CL_SUCCESS;
  const auto binaries = record.program.getInfo<CL_PROGRAM_BINARIES>(&status);
  check_cl(status, record.device, fmt::format("{}: CL_PROGRAM_BINARIES", record.entry));
  if (binaries.empty() || binaries.front().empty()) return;
  record.stored_variants.insert(record.launched_variants.begin(), record.launched_variants.end());
  store_program(record.cache_file, record.key,
                {{binaries.front().begin(), binaries.front().end()}, record.stored_variants});
  record.stored = true;
}

}  // namespace sundog
