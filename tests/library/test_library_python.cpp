// The Python package: pip builds it over the installed library in a virtual environment of its own.
#include <filesystem>

#include "file_bytes.h"
#include "installed.h"
#include "library_testing.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace fs = std::filesystem;

namespace {

std::vector<std::string> joined(std::vector<std::string> command, const std::vector<std::string>& arguments) {
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

}  // namespace

TEST_CASE("pip installs the Python package, which renders, stops for Ctrl-C and shares its pixels") {
  const char* here =
      "import ensurepip, os, sysconfig; assert os.path.exists(sysconfig.get_path('include') + '/Python.h')";
  if (run_command({"python3", "-c", here}).status != 0) {
    WARN(
        "there is no Python with headers and venv here (python3-dev, python3-venv): its package is not "
        "tried");
    return;
  }
  const TemporaryFolder folder;
  const fs::path environment = folder / "environment";
  must({"python3", "-m", "venv", "--without-pip", environment.string()});
  const std::string python = (environment / "bin/python").string();
  // The pip that is here, where it can install elsewhere (since 22.3): to install another takes three
  // seconds.
  std::vector<std::string> pip{"python3", "-m", "pip", "--python", python};
  if (run_command(joined(pip, {"--version"})).status != 0) {
    must({python, "-m", "ensurepip"});
    pip = {python, "-m", "pip"};
  }
  CommandOptions patient;
  patient.timeout = 600;
  // A compiler cache finds what it has, though the folder has another name each time.
  patient.environment["CCACHE_BASEDIR"] = folder.path().string();
  patient.environment["CCACHE_NOHASHDIR"] = "1";
  const CommandResult fetched = run_command(
      joined(pip, {"install", "--quiet", "--retries", "1", "--no-compile", "scikit-build-core", "nanobind",
                   "ninja", "numpy", "matplotlib", "anywidget", "nbclient", "ipykernel", "mypy"}),
      patient);
  if (fetched.status != 0) {
    WARN("pip cannot fetch what builds the package, so it is not tried: " << fetched.err);
    return;
  }
  const fs::path prefix = install_library(folder.path());
  const std::string config = fs::path(find_below(prefix, "sundogConfig.cmake")).parent_path().string();
  const CommandResult built =
      // pip 23.0, Debian 12's, knows the long name of -C alone.
      run_command(joined(pip, {"install", "--quiet", "--no-build-isolation", SUNDOG_SOURCE_DIR,
                               "--config-settings=cmake.define.sundog_DIR=" + config,
                               "--config-settings=cmake.define.CMAKE_CXX_FLAGS_RELEASE=-O0",
                               // Most of nanobind's sources are headers: in one each is read once.
                               "--config-settings=cmake.define.CMAKE_UNITY_BUILD=ON",
                               "--config-settings=cmake.define.CMAKE_UNITY_BUILD_BATCH_SIZE=0",
                               "--config-settings=build-dir=" + (folder / "build").string()}),
                  patient);
  CAPTURE(built.out, built.err);
  REQUIRE(built.status == 0);
  std::vector<std::string> check{python, std::string(SUNDOG_SOURCE_DIR) + "/tests/library/check_python.py",
                                 shipped_scene("spheres").string()};
  std::vector<std::string> sweep{python,
                                 std::string(SUNDOG_SOURCE_DIR) + "/examples/sweep.py",
                                 shipped_scene("spheres").string(),
                                 "--size",
                                 "32x24",
                                 "--repeat",
                                 "1",
                                 "--plot",
                                 (folder / "plot.png").string()};
  std::vector<std::string> notebook{python,
                                    std::string(SUNDOG_SOURCE_DIR) + "/examples/work_groups.py",
                                    shipped_scene("spheres").string(),
                                    test_spec(),
                                    "32x24",
                                    "1"};
  if (!test_spec().empty()) {
    check.push_back(test_spec());
    sweep.insert(sweep.end(), {"--device", test_spec()});
  }
  const CommandResult checked = run_command(check, patient);
  CAPTURE(checked.out, checked.err);
  CHECK(checked.status == 0);
  const CommandResult swept = run_command(sweep, patient);
  CAPTURE(swept.out, swept.err);
  CHECK(swept.status == 0);
  CHECK(swept.out.find("| 64x1 |") != std::string::npos);
  CHECK(file_bytes(folder / "plot.png").starts_with("\x89PNG"));
  patient.environment["MPLBACKEND"] = "Agg";
  const CommandResult noted = run_command(notebook, patient);
  CAPTURE(noted.out, noted.err);
  CHECK(noted.status == 0);
  CHECK(noted.out.find("| 16x16 |") != std::string::npos);
  const CommandResult live =
      run_command({python, "-c",
                   "import nbclient, nbformat, sys; "
                   "nbclient.NotebookClient(nbformat.read(sys.argv[1], 4), timeout=300, "
                   "resources={'metadata': {'path': sys.argv[2]}}).execute()",
                   SUNDOG_SOURCE_DIR "/examples/view.ipynb", folder.path().string()},
                  patient);
  CAPTURE(live.out, live.err);
  CHECK(live.status == 0);
  CHECK(file_bytes(folder / "view.png").starts_with("\x89PNG"));
  const CommandResult typed =
      run_command({python, "-m", "mypy", "--strict", "--cache-dir=" + (folder / "mypy").string(),
                   SUNDOG_SOURCE_DIR "/tests/library/typed_python.py"},
                  patient);
  CAPTURE(typed.out, typed.err);
  CHECK(typed.status == 0);
}
