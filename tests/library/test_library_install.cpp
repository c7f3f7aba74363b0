// The installed library: the examples are built and run against it, outside of the build folder.
#include <filesystem>
#include <map>
#include <regex>

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
  // Where only that file is found, as on a system without other libraries' development packages:
  const std::string source = (fs::path(SUNDOG_SOURCE_DIR) / "examples/plain_c.c").string(),
                    program = (folder / "c").string();
  const std::string flags =
      "$(PKG_CONFIG_LIBDIR=" + fs::path(file).parent_path().string() + " pkg-config --cflags --libs sundog)";
  must({"sh", "-c", "cc " + source + " -o " + program + " " + flags});
  CommandOptions options;
  options.environment["LD_LIBRARY_PATH"] =
      fs::path(find_below(prefix, "libsundog.so")).parent_path().string();
  const CommandResult usage = run_command({program}, options);
  CHECK(usage.status == 2);
  CHECK(usage.err.find("usage") != std::string::npos);
}

TEST_CASE("./run.sh builds what `cmake --install` takes from the build folder") {
  const std::string script = file_bytes(fs::path(SUNDOG_SOURCE_DIR) / "cmake/prepare.sh"),
                    install = file_bytes(fs::path(SUNDOG_BINARY).parent_path() / "host/cmake_install.cmake");
  std::smatch targets;
  REQUIRE(std::regex_search(script, targets, std::regex(R"(targets=\(([^)]*)\))")));
  // The program has MPI's library built with it.
  const std::map<std::string, std::string> target_of{{"sundog", "sundog"},
                                                     {"sundog_mpi.so", "sundog"},
                                                     {"libsundog.so", "sundog_shared"},
                                                     {"libsundog.a", "sundog_static"}};
  const std::regex taken(R"re(TYPE (?:EXECUTABLE|MODULE|SHARED_LIBRARY|STATIC_LIBRARY) FILES\s+"([^"]+)")re");
  int files = 0;
  for (std::sregex_iterator it(install.begin(), install.end(), taken), end; it != end; ++it, ++files) {
    std::string name = fs::path((*it)[1].str()).filename().string();
    if (const std::size_t version = name.find(".so."); version != std::string::npos) name.resize(version + 3);
    CAPTURE(name);
    REQUIRE(target_of.contains(name));
    CHECK(std::regex_search(targets[1].str(), std::regex("\\b" + target_of.at(name) + "\\b")));
  }
  CHECK(files > 3);
}

TEST_CASE("a project that has sundog's sources in itself links sundog::sundog, and gets no tests") {
  const TemporaryFolder folder;
  folder.write("main.cpp", "#include <sundog/sundog.hpp>\nint main() { sundog::Scene scene; }\n");
  folder.write("CMakeLists.txt",
               "cmake_minimum_required(VERSION 3.22)\nproject(host_app LANGUAGES C CXX)\n"
               "set(CMAKE_CXX_STANDARD 17)\nadd_subdirectory(\"" SUNDOG_SOURCE_DIR
               "\" sundog)\n"
               "foreach(library sundog sundog_static)\n  add_executable(with_${library} main.cpp)\n"
               "  target_link_libraries(with_${library} PRIVATE sundog::${library})\nendforeach()\n");
  const std::string build = (folder / "build").string();
  must({"cmake", "-G", "Ninja", "-S", folder.path().string(), "-B", build});
  const std::string rules = file_bytes(folder / "build/build.ninja");
  CHECK(rules.find("-std=gnu++20") != std::string::npos);  // of the project's own sources
  CHECK(rules.find("tests/") == std::string::npos);
  CHECK_FALSE(fs::exists(folder / "build/CPackConfig.cmake"));
}
