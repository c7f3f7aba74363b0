// Kernels that are built beside a test.
#pragma once
#include <chrono>
#include <thread>

#include "catch.h"
#include "render/device/kernel_builder.h"

/// Until it has nothing left to build.
inline void wait_for(const sundog::KernelBuilder& builder) {
  for (int i = 0; i < 8000 && builder.waiting() > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  REQUIRE(builder.waiting() == 0);
}
