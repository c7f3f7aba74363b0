// The shared library twice in one process, as two plug-ins that bring their own would have it.
#include <dlfcn.h>
#include <sundog/sundog.h>

#include <filesystem>

#include "file_bytes.h"
#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace fs = std::filesystem;

namespace {

/// One copy of the library. It stays loaded: drivers keep threads that run its code.
class Loaded {
 public:
  explicit Loaded(const fs::path& file) : handle_(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!handle_) FAIL(::dlerror());
  }
  template <class F>
  F* function(F&, const char* name) const {
    return reinterpret_cast<F*>(::dlsym(handle_, name));
  }

 private:
  void* handle_;
};
#define FUNCTION_OF(loaded, name) (loaded).function(name, #name)

/// A session of one copy, and what it draws.
class CSession {
 public:
  CSession(const Loaded& library, const std::string& scene, int width, int height) : library_(library) {
    sundog_devices* devices = nullptr;
    ok(FUNCTION_OF(library, sundog_devices_choose)(test_spec().empty() ? nullptr : test_spec().c_str(),
                                                   &devices, error_));
    ok(FUNCTION_OF(library, sundog_session_open)(devices, &session_, error_));
    sundog_scene* loaded = nullptr;
    ok(FUNCTION_OF(library, sundog_scene_load)(scene.c_str(), &loaded, error_));
    const auto set = FUNCTION_OF(library, sundog_scene_set);
    ok(set(loaded, "/image/width", std::to_string(width).c_str(), error_));
    ok(set(loaded, "/image/height", std::to_string(height).c_str(), error_));
    ok(FUNCTION_OF(library, sundog_session_start)(session_, loaded, error_));
    FUNCTION_OF(library, sundog_scene_free)(loaded);
    FUNCTION_OF(library, sundog_devices_free)(devices);
  }
  ~CSession() {
    FUNCTION_OF(library_, sundog_session_free)(session_);
    FUNCTION_OF(library_, sundog_error_free)(error_);
  }
  CSession(const CSession&) = delete;
  CSession& operator=(const CSession&) = delete;

  sundog::Image finish() {
    sundog_state state = SUNDOG_IDLE;
    ok(FUNCTION_OF(library_, sundog_session_wait)(session_, -1, &state, error_));
    CHECK(state == SUNDOG_SETTLED);
    std::vector<float> pixels(std::size_t{1} << 16);
    int width = 0, height = 0;
    ok(FUNCTION_OF(library_, sundog_session_picture)(session_, pixels.data(), pixels.size(), &width, &height,
                                                     error_));
    pixels.resize(std::size_t(width) * std::size_t(height) * 4);
    return {width, height, 4, pixels};
  }

 private:
  void ok(sundog_status status) const {
    CAPTURE(FUNCTION_OF(library_, sundog_error_line)(error_));
    REQUIRE(status == SUNDOG_OK);
  }
  const Loaded& library_;
  sundog_error* const error_ = FUNCTION_OF(library_, sundog_error_new)();
  sundog_session* session_ = nullptr;
};

}  // namespace

TEST_CASE("the library loaded twice in a process draws in two sessions at once what the command line draws") {
  const TemporaryFolder folder;
  for (const char* name : {"first.so", "second.so"})
    fs::copy_file(SUNDOG_SHARED_LIBRARY, folder / name, fs::copy_options::overwrite_existing);
  const Loaded first(folder / "first.so"), second(folder / "second.so");
  REQUIRE(FUNCTION_OF(first, sundog_version) != FUNCTION_OF(second, sundog_version));
  const std::string scene = shipped_scene("spheres").string(), theirs = (folder / "theirs.pfm").string(),
                    ours = (folder / "ours.pfm").string();
  std::vector<std::string> arguments{"render", scene, "-o", theirs, "--size", "48x32"};
  if (!test_spec().empty()) arguments.insert(arguments.end(), {"--device", test_spec()});
  REQUIRE(run_sundog(arguments).status == 0);
  CSession one(first, scene, 48, 32), other(second, scene, 48, 32);
  for (CSession* session : {&one, &other}) {
    session->finish().save(ours);
    CHECK(file_bytes(ours) == file_bytes(theirs));
  }
}
