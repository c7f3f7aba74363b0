// Uses of the library that need a process of their own: first use, fork(), dlclose(). Prints a line for each
// that goes as it should: `own_process first_use|copies|unload|fork [LIBRARY]...`, or
// `own_process arithmetic [other]`.
#include <dlfcn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sundog/sundog.h>
#include <bit>
#include <cfenv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <sundog/sundog.hpp>
#include <thread>
#include <vector>

namespace {

constexpr const char* ball =
    R"({"image": {"width": 32, "height": 24}, "lights": [{"type": "ambient"}], "materials": {"m": {}},
        "objects": [{"type": "sphere", "material": "m"}]})";

/// f() in so many threads at once.
void at_once(int count, const std::function<void(int)>& f) {
  std::vector<std::jthread> threads;
  for (int i = 0; i < count; ++i) threads.emplace_back([&, i] { f(i); });
}

void render_ball() { (void)sundog::render(sundog::Scene::from_json(ball)); }

int first_use() {
  at_once(4, [](int i) {
    if (i % 2 == 0) (void)sundog::devices();
    render_ball();
  });
  std::puts("rendered");
  return 0;
}

/// Prints the sum of a picture's bits, made where a program rounds up and traps divisions by 0, or does not.
int arithmetic(bool other) {
  const sundog::Scene scene = sundog::Scene::from_json(ball);
  if (other) {
    std::fesetround(FE_UPWARD);
    ::feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  }
  const sundog::Image image = sundog::render(scene).image();
  const bool kept = !other || (std::fegetround() == FE_UPWARD && ::fegetexcept() != 0);
  std::fesetenv(FE_DFL_ENV);
  std::uint64_t sum = 0;
  for (const float value : image.pixels()) sum = 31 * sum + std::bit_cast<std::uint32_t>(value);
  std::printf("%llx %s\n", static_cast<unsigned long long>(sum), kept ? "kept" : "lost");
  return 0;
}

#define FUNCTION_OF(library, name) reinterpret_cast<decltype(name)*>(::dlsym(library, #name))

/// Renders a ball by a copy of the library of its own; whether it could.
bool render_by(void* library) {
  if (!library) return false;
  sundog_scene* scene = nullptr;
  sundog_film* film = nullptr;
  FUNCTION_OF(library, sundog_scene_from_json)(ball, nullptr, &scene, nullptr);
  const bool done = FUNCTION_OF(library, sundog_render)(scene, nullptr, &film, nullptr) == SUNDOG_OK;
  FUNCTION_OF(library, sundog_film_free)(film);
  FUNCTION_OF(library, sundog_scene_free)(scene);
  return done;
}

int copies(const std::vector<const char*>& files) {
  at_once(static_cast<int>(files.size()), [&](int i) {
    if (render_by(::dlopen(files[static_cast<std::size_t>(i)], RTLD_NOW | RTLD_LOCAL))) std::puts("rendered");
  });
  return 0;
}

int unload(const char* file) {
  for (int i = 0; i < 2; ++i) {
    void* library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (render_by(library)) std::puts("rendered");
    ::dlclose(library);
    ::usleep(200'000);  // its threads go on
  }
  return 0;
}

/// Prints the error that f() throws, as a line.
void print_error_of(const char* what, const std::function<void()>& f) {
  try {
    f();
    std::printf("%s: no error\n", what);
  } catch (const sundog::Error& error) {
    std::printf("%s: kind %d: %s\n", what, static_cast<int>(error.kind()), error.what());
  }
}

/// f() in a child, which has a few seconds for it and then exits as a program does.
void in_child(const char* what, const std::function<void()>& f) {
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(10);
    f();
    std::exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  std::printf("%s: %s\n", what, WIFEXITED(status) ? "exited" : "killed");
}

int fork_before_and_after() {
  const sundog::Scene scene = sundog::Scene::from_json(ball);
  in_child("before", [&] { print_error_of("render before", [&] { (void)sundog::render(scene); }); });
  const auto devices = sundog::choose_devices();
  auto session = std::make_unique<sundog::Session>();
  session->start(scene);
  session->wait();
  in_child("after", [&] {
    print_error_of("render", [&] { (void)sundog::render(scene); });
    print_error_of("devices", [&] { (void)sundog::devices(); });
    print_error_of("check", [&] { (void)scene.check(); });
    print_error_of("snapshot", [&] { (void)session->snapshot(); });
    print_error_of("wait", [&] { session->wait(); });
    print_error_of("cancel", [&] { session->cancel(); });
    print_error_of("pick", [&] { (void)session->pick(0, 0); });
    session.reset();
  });
  in_child("idle", [] {});
  print_error_of("parent", [&] { (void)sundog::render(scene); });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  try {
    if (what == "first_use") return first_use();
    if (what == "arithmetic") return arithmetic(argc > 2);
    if (what == "copies") return copies({argv + 2, argv + argc});
    if (what == "unload" && argc == 3) return unload(argv[2]);
    if (what == "fork") return fork_before_and_after();
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
  return 2;
}
