// Builds programs: from the binary cache if its entry is intact, else with the driver's compiler.
#include "device/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "base/file.h"
#include "device/build_options.h"
#include "device/cl_status.h"
#include "device/driver_folder.h"

namespace sundog {
namespace {

/// Everything that may affect the compiler's output. PoCL and Intel's driver read the named variables.
std::string program_key(const DeviceInfo& info, const std::string& options, const std::string& source) {
  std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", info.platform_name, info.platform_version,
                                info.name, info.driver, info.version, options);
  for (const char* name : {"POCL_EXTRA_BUILD_FLAGS", "POCL_WORK_GROUP_METHOD",
                           "POCL_WORK_GROUP_SPECIALIZATION", "CL_CONFIG_USE_VECTORIZER"})
    key += fmt::format("{}={}\n", name, value_of(info.environment).driver(name));
  return key + source;
}

/// Creates the folder that a variable names.
std::filesystem::path made_folder(const char* variable, const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw IoError(
        fmt::format("{}: {} ({}): name a folder that can be written", folder, failed.message(), variable));
  return folder;
}

/// Writes a program's final source to HostEnvironment::dump_folder.
void dump_source(const std::string& folder, const KernelText& text) {
  if (folder.empty()) return;
  const std::string stem = std::filesystem::path(text.entry).stem().string(), source = text.expanded();
  write_file(made_folder("SUNDOG_DUMP_KERNELS", folder) / fmt::format("{}-{:.8}.cl", stem, hash128(source)),
             source);
}

/// Writes a program's compiler log and options to HostEnvironment::build_log. A program built with several
/// option sets gets a file for each.
void keep_log(const ProgramRecord& record, const std::string& options, const std::string& log,
              cl_int status) {
  const std::string& folder = value_of(record.device.environment).build_log;
  if (folder.empty()) return;
  const std::string stem = std::filesystem::path(record.entry()).stem().string();
  const DeviceInfo& info = record.device;
  write_file(made_folder("SUNDOG_BUILD_LOG", folder) / fmt::format("{}-{}.{}-{:.8}.txt", stem, info.platform,
                                                                   info.device,
                                                                   hash128(options + "\n" + record.key)),
             fmt::format("program  {}\ndevice   {}\ndriver   {}, {}\noptions  {}\nstatus   {}\n\n"
                         "== log ==\n{}\n\n== source ==\n{}",
                         record.entry(), info.label(), info.driver, info.version, options,
                         cl_status_name(status), log, record.source.text.expanded()));
}

std::string build_log(const cl::Program& program, const cl::Device& device) {
  std::string log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
  while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
  return log;
}

/// The log's first line about an error, else its first line.
std::string first_error(const std::string& log) {
  std::istringstream in(log);
  std::string first;
  for (std::string line; std::getline(in, line);) {
    if (line.find("error") != std::string::npos) return line;
    if (first.empty()) first = line;
  }
  return first.empty() ? "the compiler gave no reason" : first;
}

/// Whether the driver can create kernels of the compiled program.
bool kernels_work(const cl::Program& program) {
  std::istringstream names(program.getInfo<CL_PROGRAM_KERNEL_NAMES>());
  cl_int status = CL_INVALID_PROGRAM_EXECUTABLE;
  for (std::string name; std::getline(names, name, ';');) {
    const cl::Kernel kernel(program, name.c_str(), &status);
    if (status != CL_SUCCESS) break;
  }
  return status == CL_SUCCESS;
}

/// Creates a program from a cached binary; null if the driver rejects it.
cl::Program program_from_binary(const cl::Context& context, const cl::Device& device,
                                const std::string& binary, const std::string& options) {
  const cl::Program::Binaries binaries{{binary.begin(), binary.end()}};
  std::vector<cl_int> statuses;
  cl_int status = CL_SUCCESS;
  cl::Program program(context, {device}, binaries, &statuses, &status);
  if (status != CL_SUCCESS || std::ranges::any_of(statuses, [](cl_int s) { return s != CL_SUCCESS; }))
    return {};
  if (program.build({device}, options.c_str()) != CL_SUCCESS || !kernels_work(program)) return {};
  return program;
}

/// Builds a trivial program, so that the driver loads its compiler. A unique name avoids the driver's cache.
cl_int build_nothing(const cl::Context& context, const cl::Device& device, const std::string& name,
                     const std::string& options) {
  cl_int status = CL_SUCCESS;
  const cl::Program nothing(context, fmt::format("__kernel void nothing_{}(void) {{}}", name), false,
                            &status);
  return status == CL_SUCCESS ? nothing.build({device}, options.c_str()) : status;
}

/// Creates a program from a binary compiled by another process; null if the driver rejects it.
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

/// Compiles in another process while this one's driver initialises; false: the program must be compiled here.
bool compile_beside(ProgramRecord& record, const cl::Context& context, const cl::Device& device,
                    const std::string& source) {
  auto process = CompileProcess::start(record.device, source, record.options);
  if (!process) return false;
  build_nothing(context, device, hash128(source), record.options);
  const std::string compiled = process->wait();
  if (!compiled.empty()) record.program = program_of_parts(context, device, compiled);
  return record.program() != nullptr;
}

/// Creates the program from another process's binary if it has the same key, else null.
cl::Program program_begun(PreparedBuilds& prepared, const ProgramRecord& record, const cl::Context& context,
                          const cl::Device& device) {
  if (!prepared.begun || prepared.begun->key != record.key) return {};
  const std::string built = prepared.begun->process.wait();
  prepared.begun.reset();
  return built.empty() ? cl::Program() : program_from_binary(context, device, built, record.options);
}

/// The cached program for `key`; uses the one already read, if any.
std::optional<CachedProgram> cached_program(const std::filesystem::path& file, const std::string& key,
                                            PreparedBuilds& prepared) {
  std::optional<PreparedBuilds::Found> found = std::exchange(prepared.found, std::nullopt);
  if (found && found->key == key) return std::move(found->program);
  return load_program(file, key);
}

/// Whether the build must produce the compiler's log, which neither a cache nor another process provides.
bool wants_log(const HostEnvironment& environment, const BuildWish& wish) {
  return wish.from_source || !environment.build_log.empty();
}

/// Whether the user's options broke the build, i.e. not even a trivial program builds with them.
bool options_are_bad(const ProgramRecord& record, const cl::Context& context, const cl::Device& device) {
  return !value_of(record.device.environment).build_options.empty() &&
         build_nothing(context, device, hash128(record.key), record.options) != CL_SUCCESS;
}

void compile(ProgramRecord& record, const cl::Context& context, const cl::Device& device,
             const std::string& source, const std::string& options, BuildReport& report) {
  cl_int status = CL_SUCCESS;
  record.program = cl::Program(context, source, false, &status);
  check_cl(status, record.device, fmt::format("{}: clCreateProgramWithSource", record.entry()));
  status = record.program.build({device}, options.c_str());
  std::string used = options;
  if (const std::string portable = portable_options(record.device, options);
      status != CL_SUCCESS && portable != options) {
    status = record.program.build({device}, portable.c_str());
    used = portable;
    if (status == CL_SUCCESS) {
      record.cache_file.clear();  // its key would name options that the program lacks
      report.note = fmt::format("{}: the driver refuses options of its maker; built without, and not cached",
                                record.entry());
    }
  }
  report.log = build_log(record.program, device);
  keep_log(record, used, report.log, status);
  if (status == CL_SUCCESS) return;
  if (options_are_bad(record, context, device))
    throw BuildError(fmt::format("SUNDOG_BUILD_OPTIONS '{}': {} builds nothing with them: {} ({})",
                                 value_of(record.device.environment).build_options, record.device.label(),
                                 cl_status_name(status), first_error(report.log)),
                     report.log);
  if (status != CL_BUILD_PROGRAM_FAILURE && report.log.empty())
    check_cl(status, record.device, fmt::format("{}: clBuildProgram", record.entry()));
  throw BuildError(fmt::format("{} did not build on {}: {}", record.entry(), record.device.label(),
                               first_error(report.log)),
                   report.log);
}

/// Compiles the program, without optimisation if the driver makes no kernels otherwise: Oclgrind's optimiser
/// leaves calls that its interpreter does not know (llvm.bitreverse, noalias scopes). The unoptimised program
/// is not cached, because the failure may be transient and the kernels are slow.
void compile_to_kernels(ProgramRecord& record, const cl::Context& context, const cl::Device& device,
                        const std::string& source, BuildReport& report) {
  const auto makes_kernels = [&](const std::string& options) {
    compile(record, context, device, source, options, report);
    return !fault(value_of(record.device.environment).faults, "kernels", record.device.place()) &&
           kernels_work(record.program);
  };
  if (makes_kernels(record.options)) return;
  if (!makes_kernels(record.options + " -cl-opt-disable"))
    throw BuildError(fmt::format("{} on {}: the driver built it but makes no kernels of it", record.entry(),
                                 record.device.label()),
                     report.log);
  record.cache_file.clear();
  report.note = fmt::format(
      "{}: the driver makes no kernels of the optimised program; built without optimisation, slow, and not "
      "cached",
      record.entry());
}

}  // namespace

std::shared_ptr<ProgramRecord> build_program(const cl::Context& context, const cl::Device& device,
                                             const DeviceInfo& info, ProgramSource source,
                                             const BuildWish& wish, PreparedBuilds& prepared,
                                             BuildReport& report) {
  const HostEnvironment& environment = value_of(info.environment);
  const std::string& entry = source.text.entry;
  dump_source(environment.dump_folder, source.text);
  if (fault(environment.faults, "build", info.place()))
    throw BuildError(fmt::format("{} did not build on {}: a fault was asked for", entry, info.label()), "");
  if (is_pocl(info))
    if (const std::string problem = driver_folder(environment).problem(environment); !problem.empty())
      throw BuildError(fmt::format("{} cannot be built on {}: {}", entry, info.label(), problem), "");
  auto record = std::make_shared<ProgramRecord>();
  record->device = info;
  record->options = all_build_options(info, wish, source.text);
  record->key = program_key(info, record->options, source.identity);
  record->source = std::move(source);
  record->cache_file = program_cache_file(environment, record->key);
  const bool from_source = wants_log(environment, wish);
  const auto cached = from_source ? std::nullopt : cached_program(record->cache_file, record->key, prepared);
  if (cached) {
    record->program = program_from_binary(context, device, cached->binary, record->options);
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
      report.note = *reason + "; set XDG_CACHE_HOME to a folder that can be written";
      record->cache_file.clear();
    }
  if (!from_source) record->program = program_begun(prepared, *record, context, device);
  if (record->program()) return record;
  const std::string expanded = record->source.text.expanded();
  if (from_source || !compile_beside(*record, context, device, expanded))
    compile_to_kernels(*record, context, device, expanded, report);
  return record;
}

bool is_program_cached(const DeviceInfo& info, const ProgramSource& source, const BuildWish& wish,
                       PreparedBuilds& prepared) {
  const HostEnvironment& environment = value_of(info.environment);
  if (wants_log(environment, wish)) return false;
  std::string key = program_key(info, all_build_options(info, wish, source.text), source.identity);
  std::optional<CachedProgram> program = cached_program(program_cache_file(environment, key), key, prepared);
  if (program) prepared.found = {std::move(key), std::move(*program)};
  return prepared.found.has_value();
}

bool begin_program(const DeviceInfo& info, const ProgramSource& source, const BuildWish& wish,
                   const EmptyLaunch& launch, PreparedBuilds& prepared) {
  const HostEnvironment& environment = value_of(info.environment);
  const std::string options = all_build_options(info, wish, source.text);
  std::string key = program_key(info, options, source.identity);
  if (prepared.begun && prepared.begun->key == key) return true;
  prepared.begun.reset();
  if (is_pocl(info) && !driver_folder(environment).problem(environment).empty()) return false;
  // A sub-device's build has no processors to spare.
  if (wants_log(environment, wish) || info.sub_units > 0 || is_program_cached(info, source, wish, prepared))
    return false;
  std::optional<CompileProcess> process =
      CompileProcess::start(info, source.text.expanded(), options, &launch);
  if (process) prepared.begun.emplace(PreparedBuilds::Begun{std::move(key), std::move(*process)});
  return prepared.begun.has_value();
}

void save_program(ProgramRecord& record, bool unlaunched) {
  const bool complete = std::ranges::includes(record.stored_variants, record.launched_variants);
  if (record.cache_file.empty() || (record.stored && complete)) return;
  if (record.launched_variants.empty() && !unlaunched) return;  // PoCL would have to compile it now
  cl_int status = CL_SUCCESS;
  const auto binaries = record.program.getInfo<CL_PROGRAM_BINARIES>(&status);
  check_cl(status, record.device, fmt::format("{}: CL_PROGRAM_BINARIES", record.entry()));
  if (binaries.empty() || binaries.front().empty()) return;
  record.stored_variants.insert(record.launched_variants.begin(), record.launched_variants.end());
  store_program(record.cache_file, record.key,
                {{binaries.front().begin(), binaries.front().end()}, record.stored_variants});
  record.stored = true;
}

}  // namespace sundog
