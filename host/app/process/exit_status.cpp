// Maps each exception type to its exit status, and says how to avoid the error.
#include "app/process/exit_status.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "app/process/warnings.h"
#include "base/error.h"
#include "scene/load.h"

namespace sundog {
namespace {

/// Prints the error in one line, and replaces control characters that a file or library put into it.
void write_message(std::string message) {
  std::ranges::replace(message, '\n', ' ');
  std::ranges::replace_if(message, [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  tell(fmt::format("sundog: {}\n", message));
}

/// The end of a message: how to avoid the error.
std::string mend_of(Remedy remedy) {
  switch (remedy) {
    case Remedy::none:
      break;
    case Remedy::outside_files:
      return " (--allow-outside-files)";
    case Remedy::native_code:
      return " (--allow-native-code)";
    case Remedy::part:
      return " (--tiles)";
    case Remedy::start_anew:
      return "; remove it to start anew";
    case Remedy::same_version:
      return "; finish the frame with that version, or remove the file to start anew";
    case Remedy::same_settings:
      return ": give the settings that it was made with, or remove it to start anew";
    case Remedy::in_passes:
      return ": give the --time-limit, --noise-threshold, --adaptive or --subsample that it was made with, "
             "or "
             "remove it to start anew";
    case Remedy::not_in_passes:
      return ": leave out --time-limit, --noise-threshold, --adaptive and --subsample, or remove it to start "
             "anew";
  }
  return "";
}

/// The end of a message about memory: the process's limit on address space, if any.
std::string memory_limit() {
  rlimit space = {};
  if (::getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return "";
  return fmt::format(": the limit on address space (`ulimit -v`, or a batch system's) is {} MiB: raise it",
                     space.rlim_cur >> 20);
}

/// The end of a message: advice, if the message means that a thread could not be started.
std::string thread_limit(std::string_view message) {
  if (message.find(std::strerror(EAGAIN)) == std::string_view::npos) return "";
  return ": no thread can be started: raise the limits on them (`ulimit -u`, or the container's) and on "
         "address space (`ulimit -v`)";
}

}  // namespace

int exit_status_of(const std::function<int()>& command, bool speaks) {
  const auto fail = [&](ExitStatus status, const std::string& message) {
    if (speaks) write_message(message);
    return status;
  };
  try {
    return command();
  } catch (const UsageError& error) {
    return fail(exit_usage, error.what() + mend_of(error.remedy));
  } catch (const SettingError& error) {
    return fail(exit_usage, error.what() + mend_of(error.remedy));
  } catch (const SceneError& error) {
    return fail(exit_scene, error.what() + mend_of(error.remedy));
  } catch (const DeviceError& error) {
    return fail(exit_device, error.what());
  } catch (const BuildError& error) {
    fail(exit_build, error.what());
    if (speaks && !error.log.empty()) tell(error.log + (error.log.ends_with('\n') ? "" : "\n"));
    return exit_build;
  } catch (const std::bad_alloc&) {
    return fail(exit_failure, "out of memory" + memory_limit());
  } catch (const std::exception& error) {
    return fail(exit_failure, error.what() + thread_limit(error.what()));
  }
}

}  // namespace sundog
