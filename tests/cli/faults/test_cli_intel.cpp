// Intel's CPU runtime for OpenCL, where it is: beside sundog's own checks it is held against PoCL. Found by
// its .icd file, or by SUNDOG_INTEL_OPENCL, the path of libintelocl.so (PyPI: intel-opencl-rt,
// intel-cmplr-lib-rt).
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "catch.h"
#include "cli_scene.h"

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// libintelocl.so as an .icd file names it; empty: not here.
std::string intel_library() {
  if (const char* named = std::getenv("SUNDOG_INTEL_OPENCL"); named && *named) return named;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/etc/OpenCL/vendors", none)) {
    if (entry.path().extension() != ".icd") continue;
    const std::string library = sundog::read_file(entry.path());
    if (library.find("libintelocl") != std::string::npos) return library.substr(0, library.find('\n'));
  }
  return {};
}

}  // namespace

TEST_CASE("Intel's CPU runtime is listed, checked, and renders as PoCL does") {
  const std::string library = intel_library();
  if (library.empty()) {
    std::printf("no Intel OpenCL runtime (/etc/OpenCL/vendors or SUNDOG_INTEL_OPENCL): not tested with it\n");
    return;
  }
  const TemporaryFolder intel, pocl;
  intel.write("intel.icd", library + "\n");
  pocl.write("pocl.icd", "libpocl.so.2\n");
  CommandOptions with_intel, with_pocl;
  with_intel.timeout = 600;  // its compiler needs ten seconds of an idle core for the first picture
  with_intel.environment = {{"OCL_ICD_VENDORS", intel.path().string() + "/"},
                            {"LD_LIBRARY_PATH", fs::path(library).parent_path().string()}};
  with_pocl.environment["OCL_ICD_VENDORS"] = pocl.path().string() + "/";

  const CommandResult list = run_sundog({"devices", "--json"}, with_intel);
  CAPTURE(list.out, list.err);
  REQUIRE(list.status == 0);
  const json rows = json::parse(list.out).at("devices");
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].at("usable") == true);
  CHECK(rows[0].at("type") == "cpu");

  const CommandResult check = run_sundog({"check"}, with_intel);
  CAPTURE(check.out, check.err);
  CHECK(check.status == 0);

  const CliFolder folder;
  REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("a.pfm")}, with_intel).status == 0);
  REQUIRE(run_sundog({"render", folder.scene, "-o", folder.file("b.pfm")}, with_pocl).status == 0);
  const CommandResult same =
      run_sundog({"compare", folder.file("a.pfm"), folder.file("b.pfm"), "--tolerance", "0.001"});
  CAPTURE(same.out);
  CHECK(same.status == 0);
}
