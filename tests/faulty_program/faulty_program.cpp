// A program that uses the library on a device that fails, as SUNDOG_FAULTS says, which the library reads once
// a process. Prints what it sees, a value a line: `faulty_program launch|pick DEVICE_SPEC SCENE`.
#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <sundog/sundog.hpp>

namespace {

void print_error_of(const char* what, const std::function<void()>& act) {
  try {
    act();
    std::printf("%s: no error\n", what);
  } catch (const sundog::Error& error) {
    std::printf("%s: kind %d, status %d\n", what, static_cast<int>(error.kind()), error.status());
  }
}

void fail_launches(const sundog::Scene& scene, const std::vector<sundog::Device>& devices) {
  print_error_of("render", [&] { (void)sundog::render(scene, {.devices = devices}); });
  sundog::Session session(devices);
  session.start(scene);
  print_error_of("finish", [&] { (void)session.finish(); });
  std::printf("snapshot: %s\n", session.snapshot().error.c_str());
}

void fail_pick(const sundog::Scene& scene, const std::vector<sundog::Device>& devices) {
  sundog::Session session(devices);
  session.start(scene);
  session.wait();
  print_error_of("pick", [&] { (void)session.pick(1, 1); });
  std::printf("picture: %d\n", static_cast<int>(session.finish().width()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  try {
    const std::string spec = argv[2];  // empty: the default device
    const auto devices = spec.empty() ? sundog::choose_devices() : sundog::choose_devices({spec});
    const sundog::Scene scene = sundog::Scene::load(argv[3]);
    (std::string(argv[1]) == "launch" ? fail_launches : fail_pick)(scene, devices);
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
