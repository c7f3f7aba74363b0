// Picks variables by prefix, and the libraries that .icd files name.
#include "app/process/variables.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace sundog {
namespace {

namespace fs = std::filesystem;

constexpr const char* prefixes[] = {"POCL_",    "RUSTICL_", "OCL_",   "OPENCL_", "CL_",   "SUNDOG_",
                                    "CUDA_",    "GPU_",     "HSA_",   "ROCR_",   "LP_",   "MESA_",
                                    "GALLIUM_", "OMP_",     "LIBGL_", "TBB_",    "HWLOC_"};

}  // namespace

std::vector<std::pair<std::string, std::string>> driver_variables() {
  std::vector<std::pair<std::string, std::string>> all;
  for (char** each = ::environ; each && *each; ++each) {
    const std::string text = *each;
    const std::size_t equals = text.find('=');
    const bool wanted =
        std::ranges::any_of(prefixes, [&](const char* prefix) { return text.starts_with(prefix); });
    if (wanted && equals != std::string::npos)
      all.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  const char* folder = std::getenv("OCL_ICD_VENDORS");
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder ? folder : "/etc/OpenCL/vendors", none)) {
    if (entry.path().extension() != ".icd") continue;
    std::ifstream in(entry.path());
    std::string library;
    std::getline(in, library);
    all.emplace_back("ICD " + entry.path().filename().string(), library);
  }
  std::ranges::sort(all);
  return all;
}

}  // namespace sundog
