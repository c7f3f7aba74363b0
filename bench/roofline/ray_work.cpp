// Counts the plain tracer's visits and charges each the operations and bytes of the device's tracer
// (kernels/lib/trace/nodes.cl and triangles.cl).
#include "bench/roofline/ray_work.h"

#include <algorithm>
#include <bit>

#include "bench/plain/tracer.h"

namespace sundog {
namespace {

struct Cost {
  double operations = 0, bytes = 0;
};

constexpr double box_operations = 6 * 2;     // six planes
constexpr double grid_operations = 39;       // make_slab_ray() for the grid of a compact node
constexpr double triangle_operations = 49;   // test_block() without its divisions
constexpr double start_operations = 39 + 4;  // make_slab_ray(), make_shear_ray()
constexpr double transform_operations = 33;  // of a point and a vector

Cost node_cost(const Bvh8Node& node, bool compact) {
  if (!compact) return {BVH_WIDTH * box_operations, sizeof(Bvh8Node)};
  return {grid_operations + std::popcount(node.valid) * box_operations, sizeof(CompactNode)};
}

Cost block_cost(const TriangleBlock& block, bool compact) {
  if (!compact) return {BVH_WIDTH * triangle_operations, sizeof(TriangleBlock)};
  const auto filled =
      static_cast<double>(BVH_WIDTH - std::count(block.prim, block.prim + BVH_WIDTH, NO_PRIM));
  return {filled * triangle_operations, filled * sizeof(TriangleBlock) / BVH_WIDTH};
}

Cost instance_cost(const Instance& instance, bool) {
  const bool mesh = instance.shape == SHAPE_MESH;
  return {transform_operations + (mesh ? start_operations : 0), sizeof(Instance)};
}

/// Adds the work of all visits of a table and returns their number.
template <class Entry>
double add_visits(RayWork& work, const std::vector<u32>& visits, const SharedTable<Entry>& table,
                  Cost (*cost_of)(const Entry&, bool), bool compact) {
  double count = 0;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (visits[i] == 0) continue;
    const Cost cost = cost_of(table[i], compact);
    count += visits[i];
    work.operations += visits[i] * cost.operations;
    work.bytes += visits[i] * cost.bytes;
    work.least_bytes += cost.bytes;
  }
  return count;
}

}  // namespace

RayWork ray_work(const CompiledScene& scene, const RaySet& set, bool compact) {
  plain::Visits visits(scene);
  plain::Hit hit;
  for (const Ray& given : set.rays) {
    const plain::Ray ray{
        {given.ox, given.oy, given.oz}, {given.dx, given.dy, given.dz}, given.t_min, given.t_max};
    if (set.any)
      plain::any_hit(scene, ray, &visits);
    else
      plain::closest_hit(scene, ray, hit, &visits);
  }
  RayWork work;
  work.nodes = add_visits(work, visits.nodes, scene.nodes, node_cost, compact);
  work.blocks = add_visits(work, visits.blocks, scene.blocks, block_cost, compact);
  work.instances = add_visits(work, visits.instances, scene.instances, instance_cost, compact);
  const auto rays = static_cast<double>(std::max<std::size_t>(1, set.rays.size()));
  for (double* all :
       {&work.nodes, &work.blocks, &work.instances, &work.operations, &work.bytes, &work.least_bytes})
    *all /= rays;
  const double in_and_out = sizeof(Ray) + (set.any ? sizeof(u32) : sizeof(Hit));
  work.operations += start_operations;
  work.bytes += in_and_out;
  work.least_bytes += in_and_out;
  return work;
}

}  // namespace sundog
