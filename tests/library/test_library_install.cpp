// The installed library: the examples are built and run against it, outside of the build folder.
#include <filesystem>

#include "file_bytes.h"
#include "installed.h"
#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace fs = std::filesystem;

TEST_CASE("the examples build and run from an installed tree") {
  const TemporaryFolder folder;
  const fs::path prefix = install_library(folder.path());
  fs::copy(fs::path(SUNDOG_SOURCE_DIR) / "examples", folder / "examples");
  const std::string build = (folder / "build").string();
  must({"cmake", "-G", "Ninja", "-S", (folder / "examples").string(), "-B", build,
        "-DCMAKE_PREFIX_PATH=" + prefix.string()});
  must({"cmake", "--build", build, "--parallel", "2"});
  const std::string scene = shipped_scene("spheres").string();
  // A scene in 640x480 is too much for a test.
  sundog::Scene small = sundog::Scene::load(scene);
  small.set_size(40, 30);
  const std::string file = folder.write("scene.json", small.to_json()).string();
  const auto run = [&](const std::string& name, std::vector<std::string> arguments, const std::string& out) {
    arguments.insert(arguments.begin(), (fs::path(build) / name).string());
    if (!test_spec().empty()) arguments.push_back(test_spec());
    must(arguments);
    CHECK(file_bytes(out).starts_with("\x89PNG"));
  };
  const auto out = [&](const std::string& name) { return (folder / name).string(); };
  run("minimal", {file, out("minimal.png")}, out("minimal.png"));
  if (fs::exists(fs::path(build) / "minimal_static"))
    run("minimal_static", {file, out("static.png")}, out("static.png"));
  run("mesh", {out("mesh.png")}, out("mesh.png"));
  run("editor", {file, out("editor.png")}, out("editor.png"));
  run("plain_c", {out("c.png")}, out("c.png"));
  sundog::render(small, {.devices = test_device()}).save(folder / "ours.png");
  CHECK(file_bytes(out("minimal.png")) == file_bytes(out("ours.png")));
}

TEST_CASE("pkg-config finds the installed library, wherever its prefix is moved") {
  if (run_command({"pkg-config", "--version"}).status != 0) {
    WARN("there is no pkg-config here (pkg-config or pkgconf): its file is not tried");
    return;
  }
  const TemporaryFolder folder;
  const fs::path prefix = install_library(folder.path());
  const std::string file = find_below(prefix, "sundog.pc");
  const std::string source = (fs::path(SUNDOG_SOURCE_DIR) / "examples/plain_c.c").string(),
                    program = (folder / "c").string();
  const std::string flags =
      "$(PKG_CONFIG_PATH=" + fs::path(file).parent_path().string() + " pkg-config --cflags --libs sundog)";
  must({"sh", "-c", "cc " + source + " -o " + program + " " + flags});
  CommandOptions options;
  options.environment["LD_LIBRARY_PATH"] =
      fs::path(find_below(prefix, "libsundog.so")).parent_path().string();
  const CommandResult usage = run_command({program}, options);
  CHECK(usage.status == 2);
  CHECK(usage.err.find("usage") != std::string::npos);
}
