// Converts the host's exceptions to the public Error.
#include <new>

#include "api/impl.h"

namespace sundog {
inline namespace v0 {

static_assert(SUNDOG_VERSION_MAJOR == SUNDOG_BUILT_MAJOR && SUNDOG_VERSION_MINOR == SUNDOG_BUILT_MINOR &&
                  SUNDOG_VERSION_PATCH == SUNDOG_BUILT_PATCH,
              "CMakeLists.txt and include/sundog/version.h name different versions");

#define SUNDOG_TEXT_OF(number) #number
#define SUNDOG_VERSION_OF(major, minor, patch) \
  SUNDOG_TEXT_OF(major) "." SUNDOG_TEXT_OF(minor) "." SUNDOG_TEXT_OF(patch)
const char* version_text() noexcept {
  return SUNDOG_VERSION_OF(SUNDOG_VERSION_MAJOR, SUNDOG_VERSION_MINOR, SUNDOG_VERSION_PATCH);
}

std::string version() { return version_text(); }

Error::Error(ErrorKind kind, const std::string& what, ErrorFacts facts)
    : std::runtime_error(what), kind_(kind), facts_(std::move(facts)) {
  if (facts_.reason.empty()) facts_.reason = what;
}
Error::Error(const Error&) = default;
Error& Error::operator=(const Error&) = default;
Error::~Error() = default;

void throw_public() {
  try {
    throw;
  } catch (const UsageError& error) {
    throw Error(ErrorKind::usage, error.what());
  } catch (const SceneError& error) {
    const bool has_file = std::filesystem::path(error.file).filename() != no_file;
    throw Error(ErrorKind::scene, error.what(),
                {.file = has_file ? error.file : std::string(),
                 .place = error.place,
                 .reason = error.reason,
                 .log = {}});
  } catch (const DeviceError& error) {
    throw Error(ErrorKind::device, error.what(),
                {.file = {}, .place = {}, .reason = {}, .log = {}, .status = error.status});
  } catch (const BuildError& error) {
    throw Error(ErrorKind::build, error.what(), {.file = {}, .place = {}, .reason = {}, .log = error.log});
  } catch (const IoError& error) {
    throw Error(ErrorKind::io, error.what(),
                {.file = error.file, .place = {}, .reason = error.reason, .log = {}});
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::internal, "out of memory");
  } catch (const std::exception& error) {
    throw Error(ErrorKind::internal, error.what());
  }
}

}  // namespace v0
}  // namespace sundog
