#include "app/process/exit_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "app/process/warnings.h"
#include "base/error.h"

namespace sundog {
namespace {

/// Prints the error in one line without control characters, whatever a file or a library put into it.
void write_message(std::string message) {
  std::ranges::replace(message, '\n', ' ');
  std::ranges::replace_if(message, [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  tell(fmt::format("sundog: {}\n", with_option_names(std::move(message))));
}

}  // namespace

int exit_status_of(const std::function<int()>& command, bool speaks) {
  const auto fail = [&](ExitStatus status, const char* message) {
    if (speaks) write_message(message);
    return status;
  };
  try {
    return command();
  } catch (const UsageError& error) {
    return fail(exit_usage, error.what());
  } catch (const SceneError& error) {
    return fail(exit_scene, error.what());
  } catch (const DeviceError& error) {
    return fail(exit_device, error.what());
  } catch (const BuildError& error) {
    fail(exit_build, error.what());
    if (speaks && !error.log.empty()) tell(error.log + (error.log.ends_with('\n') ? "" : "\n"));
    return exit_build;
  } catch (const std::bad_alloc&) {
    return fail(exit_failure, "out of memory");
  } catch (const std::exception& error) {
    return fail(exit_failure, error.what());
  }
}

}  // namespace sundog
