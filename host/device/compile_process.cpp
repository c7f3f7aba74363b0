// Starts the compiling process and serves its side. Source and binary are passed in memory files, so that
// neither process blocks on reading.
#include "device/compile_process.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "base/file.h"
#include "base/memory_file.h"
#include "device/cl_status.h"
#include "device/driver_folder.h"
#include "device/empty_launch.h"

namespace sundog {
namespace {

constexpr double longest_wait = 30;  // seconds; longer means that something hangs

/// Whether the driver is PoCL on a CPU, whose slow start this works around.
bool reads_a_library(const DeviceInfo& device) { return is_pocl(device) && device.type == "cpu"; }

std::string contents(int file) {
  struct stat size = {};
  if (::fstat(file, &size) != 0 || size.st_size <= 0) return {};
  std::string text(static_cast<std::size_t>(size.st_size), '\0');
  std::size_t got = 0;
  while (got < text.size()) {
    const ssize_t part = ::pread(file, text.data() + got, text.size() - got, static_cast<off_t>(got));
    if (part == 0 || (part < 0 && errno != EINTR)) return {};
    if (part > 0) got += static_cast<std::size_t>(part);
  }
  return text;
}

cl::Device device_at(const EnvironmentPtr& environment, const std::string& place) {
  for (const DeviceInfo& info : enumerate_devices(environment))
    if (info.usable() && place == info.place())
      return cl::Device(static_cast<cl_device_id>(info.handle), true);
  throw DeviceError(fmt::format("no device {} to compile for", place));
}

/// Removes and returns the first line.
std::string take_line(std::string& text) {
  const std::size_t end = text.find('\n');
  const std::string line = text.substr(0, end);
  text.erase(0, end == std::string::npos ? end : end + 1);
  return line;
}

/// Builds the program, including machine code for the launch. Throws BuildError, DeviceError.
void build_for_launch(cl::Program& program, const cl::Context& context, const cl::Device& device,
                      const std::string& options, const EmptyLaunch& launch) {
  if (program.build({device}, options.c_str()) != CL_SUCCESS)
    throw BuildError("the program does not build", "");
  cl_int status = CL_SUCCESS;
  cl::Kernel kernel(program, launch.kernel.c_str(), &status);
  if (status != CL_SUCCESS) throw BuildError("the program has no such kernel", "");
  const cl::CommandQueue queue(context, device, 0, &status);
  if (status == CL_SUCCESS) status = launch_nothing(context, queue, kernel, launch);
  if (status != CL_SUCCESS) throw DeviceError("the kernel cannot be launched", status);
}

}  // namespace

std::optional<CompileProcess> CompileProcess::start(const DeviceInfo& device, const std::string& source,
                                                    const std::string& options,
                                                    const EmptyLaunch* launch) noexcept {
  const StartProgram& start_program = value_of(device.environment).start_program;
  if (!start_program || !reads_a_library(device) || std::thread::hardware_concurrency() < 2)
    return std::nullopt;
  int in = -1;
  const int out = memory_file("");
  std::optional<CompileProcess> process;
  try {
    in = memory_file(fmt::format("{}\n{}\n{}", options, launch ? to_line(*launch) : "", source));
    if (in >= 0 && out >= 0) {
      process.emplace(
          CompileProcess(start_program({"compile", device.place()},
                                       {{in, STDIN_FILENO}, {out, STDOUT_FILENO}, {nowhere, STDERR_FILENO}}),
                         out));
    }
  } catch (const std::exception&) {
    // no process can be started
  }
  if (in >= 0) ::close(in);
  if (out >= 0 && !process) ::close(out);
  return process;
}

CompileProcess::CompileProcess(std::unique_ptr<StartedProgram> process, int result)
    : process_(std::move(process)), result_(result) {}

CompileProcess::CompileProcess(CompileProcess&& other) noexcept
    : process_(std::move(other.process_)), result_(std::exchange(other.result_, -1)) {}

CompileProcess::~CompileProcess() {
  if (process_) {
    process_->end();
    wait_for_end(*process_, longest_wait);
  }
  if (result_ >= 0) ::close(result_);
}

std::string CompileProcess::wait() noexcept {
  const std::optional<ProgramEnd> end = wait_for_end(*process_, longest_wait);
  if (!end) return {};
  process_.reset();
  return end->signal == 0 && end->status == 0 ? contents(result_) : std::string();
}

void serve_compile(const EnvironmentPtr& environment, const std::string& place, int in, int out) {
  const std::shared_ptr<Faults>& faults = value_of(environment).faults;
  if (fault(faults, "compile", place)) throw BuildError("a fault was asked for", "");
  if (faults) faults->end_process("kill", "compile", 0);
  std::string source = contents(in);
  const std::string options = take_line(source), launch = take_line(source);
  const cl::Device device = device_at(environment, place);
  cl_int status = CL_SUCCESS;
  const cl::Context context(device, nullptr, nullptr, nullptr, &status);
  if (status != CL_SUCCESS) throw DeviceError("no context", status);
  cl::Program program(context, source, false);
  if (!launch.empty())
    build_for_launch(program, context, device, options, empty_launch_of(launch));
  else if (program.compile(options.c_str()) != CL_SUCCESS)
    throw BuildError("the program does not compile", "");
  const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
  if (binaries.empty() || binaries.front().empty()) throw BuildError("the driver gives no binary", "");
  const std::vector<unsigned char>& binary = binaries.front();
  if (!write_all(out, {reinterpret_cast<const char*>(binary.data()), binary.size()}))
    throw IoError(std::strerror(errno));
}

}  // namespace sundog
