// sundog's command line: the command does its work; what goes wrong becomes one line and an exit status here.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <future>
#include <new>
#include <string>

#include "app/commands.h"
#include "app/devices_command.h"
#include "app/options.h"
#include "base/error.h"
#include "render/render.h"

namespace sundog {
namespace {

int run(const RenderCommand& command) { return render_command(command); }
int run(const DevicesOptions& command) { return devices_command(command); }
int run(const InfoCommand& command) { return info_command(command); }
int run(const MergeCommand& command) { return merge_command(command); }
int run(const CompareCommand& command) { return compare_command(command); }
/// In a thread of its own: drivers that work in the caller's thread need more stack than the first one has.
int run(const RunLater& command) { return std::async(std::launch::async, command.run).get(); }
int run(const ShowText& command) {
  fmt::print("{}", command.text);
  return exit_done;
}

int run_command_line(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "worker") return worker_command(argc, argv);
  const Command command = parse_command_line(argc, argv);
  const int status = std::visit([](const auto& chosen) { return run(chosen); }, command);
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw IoError("the standard output cannot be written");
  return status;
}

/// Prints the error in one line, whatever a library's message holds.
int fail(ExitStatus status, std::string message) {
  std::ranges::replace(message, '\n', ' ');
  fmt::print(stderr, "sundog: {}\n", message);
  return status;
}

int status_of(int argc, char** argv) {
  try {
    return run_command_line(argc, argv);
  } catch (const UsageError& error) {
    return fail(exit_usage, error.what());
  } catch (const SceneError& error) {
    return fail(exit_scene, error.what());
  } catch (const DeviceError& error) {
    return fail(exit_device, error.what());
  } catch (const BuildError& error) {
    fail(exit_build, error.what());
    fmt::print(stderr, "{}{}", error.log, error.log.ends_with('\n') ? "" : "\n");
    return exit_build;
  } catch (const std::bad_alloc&) {
    return fail(exit_failure, "out of memory");
  } catch (const std::exception& error) {
    return fail(exit_failure, error.what());
  }
}

}  // namespace
}  // namespace sundog

int main(int argc, char** argv) {
  const int status = sundog::status_of(argc, argv);
  if (sundog::threads_left_behind() == 0) return status;
  // A driver that is still at work would find its own globals destroyed by a return.
  std::fflush(nullptr);
  ::_exit(status);
}
