// Reads build logs of NVIDIA's compiler, and computes how many threads their figures allow.
#include "catch.h"
#include "device/nvidia.h"

using namespace sundog;

TEST_CASE("registers, stack and spills are read from a build log of several kernels") {
  const auto kernels = read_ptxas_log(
      "\n"
      "ptxas info    : 0 bytes gmem\n"
      "ptxas info    : Compiling entry function 'occluded_rays' for 'sm_90'\n"
      "ptxas info    : Function properties for occluded_rays\n"
      "ptxas         .     512 bytes stack frame, 16 bytes spill stores, 24 bytes spill loads\n"
      "ptxas info    : Used 96 registers, 416 bytes cmem[0]\n"
      "ptxas info    : Compiling entry function 'trace_rays' for 'sm_90'\n"
      "ptxas info    : Function properties for trace_rays\n"
      "    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads\n"
      "ptxas info    : Used 128 registers, used 1 barriers, 416 bytes cmem[0], 8 bytes cmem[2]\n");
  REQUIRE(kernels.size() == 2);
  const PtxasFigures& occluded = kernels.at("occluded_rays");
  CHECK(occluded.registers == 96u);
  CHECK(occluded.stack == 512u);
  CHECK(occluded.spill_stores == 16u);
  CHECK(occluded.spill_loads == 24u);
  const PtxasFigures& trace = kernels.at("trace_rays");
  CHECK(trace.registers == 128u);
  CHECK(trace.stack == 0u);
  CHECK(trace.spill_stores == 0u);
}

TEST_CASE("functions that a kernel calls count with it, and a cumulative stack is the whole") {
  const auto kernels = read_ptxas_log(
      "ptxas info    : Compiling entry function 'render' for 'sm_80'\n"
      "ptxas info    : Function properties for render\n"
      "ptxas         .     800 bytes stack frame, 4 bytes spill stores, 8 bytes spill loads\n"
      "ptxas info    : Function properties for shade\n"
      "ptxas         .     96 bytes stack frame, 12 bytes spill stores, 12 bytes spill loads\n"
      "ptxas info    : Used 255 registers, 1024 bytes cumulative stack size, 400 bytes cmem[0]\n"
      "ptxas info    : Compiling entry function 'aov' for 'sm_80'\n"
      "ptxas info    : Function properties for aov\n"
      "ptxas         .     100 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads\n"
      "ptxas info    : Function properties for shade\n"
      "ptxas         .     96 bytes stack frame, 12 bytes spill stores, 12 bytes spill loads\n"
      "ptxas info    : Used 40 registers, 400 bytes cmem[0]\n");
  const PtxasFigures& render = kernels.at("render");
  CHECK(render.registers == 255u);
  CHECK(render.stack == 1024u);
  CHECK(render.spill_stores == 16u);
  CHECK(render.spill_loads == 20u);
  CHECK(kernels.at("aov").stack == 196u);
}

TEST_CASE("a log that tells no figures gives none, not zeros") {
  CHECK(read_ptxas_log("").empty());
  CHECK(read_ptxas_log("warning: 12 registers were mentioned, 3 bytes stack frame\n").empty());
  const auto kernels = read_ptxas_log("ptxas info    : Compiling entry function 'f' for 'sm_90'\n");
  CHECK(!kernels.at("f").registers);
  CHECK(!kernels.at("f").stack);
}

TEST_CASE("registers limit the resident threads of a multiprocessor") {
  const NvidiaLimits h200{9, 0, 65536, 32};
  CHECK(resident_threads(16, h200) == 2048);
  CHECK(resident_threads(32, h200) == 2048);
  CHECK(resident_threads(33, h200) == 1536);  // 40 after rounding: 12 warps a scheduler
  CHECK(resident_threads(64, h200) == 1024);
  CHECK(resident_threads(128, h200) == 512);
  CHECK(resident_threads(168, h200) == 384);
  CHECK(resident_threads(255, h200) == 256);
  CHECK(resident_threads(0, h200) == 2048);
  CHECK((NvidiaLimits{7, 5}.threads() == 1024));
  CHECK((NvidiaLimits{8, 6}.threads() == 1536));
  CHECK((NvidiaLimits{8, 0}.threads() == 2048));
}
