// Builds both BVHs on the host and copies their arrays; `requires` and #ifdef select the version's layout.
#define TINYBVH_IMPLEMENTATION
#include "tinybvh_tables.h"

#include <tiny_bvh.h>

#include <chrono>
#include <cstring>

namespace sundog {
namespace {

template <class T>
std::vector<T> copy(const void* data, std::size_t count) {
  std::vector<T> values(count);
  std::memcpy(static_cast<void*>(values.data()), data, count * sizeof(T));
  return values;
}

/// Versions after 1.6.8 store the vertices in leaf order, earlier ones an index of triangles.
template <class Bvh>
void add_triangles(TinyBvhTables& tables, const Bvh& bvh, std::span<const float4> corners) {
  if constexpr (requires { bvh.orderedVerts.data; }) {
    tables.vertices2 = copy<float4>(bvh.orderedVerts.data, std::size_t{3} * bvh.idxCount);
    tables.order2.assign(1, 0);
  } else {
    tables.vertices2.assign(corners.begin(), corners.end());
    tables.order2 = copy<u32>(bvh.bvh.primIdx, bvh.idxCount);
  }
}

}  // namespace

TinyBvhTables tinybvh_tables(std::span<const float4> corners) {
  TinyBvhTables tables;
  tables.version = std::to_string(TINY_BVH_VERSION_MAJOR) + "." + std::to_string(TINY_BVH_VERSION_MINOR) +
                   "." + std::to_string(TINY_BVH_VERSION_SUB);
  const auto* vertices = reinterpret_cast<const tinybvh::bvhvec4*>(corners.data());
  const auto triangles = static_cast<uint32_t>(corners.size() / 3);
  const auto start = std::chrono::steady_clock::now();
  tinybvh::BVH8_CWBVH wide;
  wide.Build(vertices, triangles);
  tinybvh::BVH_GPU binary;
  binary.Build(vertices, triangles);
  tables.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::size_t words = 3;
#ifdef CWBVH_COMPRESSED_TRIS
  tables.compressed_triangles = true;
  words = 4;
#endif
  tables.nodes = copy<float4>(wide.bvh8Data, wide.usedBlocks);
  tables.triangles = copy<float4>(wide.bvh8Tris, words * wide.bvh8.idxCount);
  tables.nodes2 = copy<float4>(binary.bvhNode, 4 * std::size_t{binary.usedNodes});
  add_triangles(tables, binary, corners);
  return tables;
}

}  // namespace sundog
