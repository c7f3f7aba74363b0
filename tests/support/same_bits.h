// Whether two pictures are the same to the bit.
#pragma once
#include <cstring>

#include "base/image.h"

inline bool same_bits(const sundog::Image& a, const sundog::Image& b) {
  return a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}
