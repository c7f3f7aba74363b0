// Searches the log for lines like these (older compilers indent the second with spaces only):
//     ptxas info    : Compiling entry function 'trace_rays' for 'sm_90'
//     ptxas info    : Function properties for trace_rays
//     ptxas         .     512 bytes stack frame, 16 bytes spill stores, 24 bytes spill loads
//     ptxas info    : Used 96 registers, 8 bytes cumulative stack size, 400 bytes cmem[0]
#include "device/nvidia.h"

#include <algorithm>
#include <regex>
#include <sstream>

namespace sundog {
namespace {

// Registers are allocated like this since compute capability 3.0.
constexpr std::uint64_t register_step = 256, schedulers = 4;

/// The number before `words` in the line.
std::optional<std::uint64_t> number_before(const std::string& line, const char* words) {
  std::smatch match;
  if (!std::regex_search(line, match, std::regex(std::string("(\\d{1,18}) ") + words))) return std::nullopt;
  return std::stoull(match[1]);
}

void add(std::optional<std::uint64_t>& sum, const std::optional<std::uint64_t>& more) {
  if (more) sum = sum.value_or(0) + *more;
}

}  // namespace

std::map<std::string, PtxasFigures> read_ptxas_log(const std::string& log) {
  static const auto& entry = *new const std::regex(R"(Compiling entry function '([^']+)')");
  std::map<std::string, PtxasFigures> kernels;
  PtxasFigures* kernel = nullptr;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, entry)) {
      kernel = &kernels[match[1]];
      *kernel = {};  // several devices: keep the last one's figures
    }
    if (!kernel) continue;
    add(kernel->stack, number_before(line, "bytes stack frame"));
    add(kernel->spill_stores, number_before(line, "bytes spill stores"));
    add(kernel->spill_loads, number_before(line, "bytes spill loads"));
    if (const auto used = number_before(line, "registers")) kernel->registers = used;
    if (const auto whole = number_before(line, "bytes cumulative stack size")) kernel->stack = whole;
  }
  return kernels;
}

unsigned NvidiaLimits::threads() const {
  if (major == 7 && minor == 5) return 1024;
  const bool small = (major == 8 && minor > 0) || (major == 12);
  return small ? 1536 : 2048;
}

unsigned resident_threads(std::uint64_t registers, const NvidiaLimits& limits) {
  if (registers == 0) return limits.threads();
  const std::uint64_t of_warp = (registers * limits.warp + register_step - 1) / register_step * register_step;
  const std::uint64_t warps = limits.registers / schedulers / of_warp * schedulers;
  return static_cast<unsigned>(std::min<std::uint64_t>(warps * limits.warp, limits.threads()));
}

}  // namespace sundog
