// Compiles meshes: triangle blocks under a wide BVH, and vertices and triangles for shading.

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "base/parallel.h"
#include "compile/bvh/mesh_groups.h"
#include "compile/bvh/vertices.h"
#include "compile/bvh/wide_bvh.h"
#include "compile/steps.h"

namespace sundog {
namespace {

constexpr float farthest_vertex = 1e36f;  // beyond, sums of coordinates overflow a float

[[noreturn]] void fail(const MeshInputs& in, std::size_t mesh, const std::string& what) {
  throw SceneError(*in.file, in.places->at(mesh),
                   fmt::format("mesh \"{}\": {}", in.meshes[mesh]->name, what));
}

bool in_range(const glm::vec3& p) {
  return std::abs(p.x) <= farthest_vertex && std::abs(p.y) <= farthest_vertex &&
         std::abs(p.z) <= farthest_vertex;
}

bool attribute_fits(std::size_t count, std::size_t wanted) { return count == 0 || count == wanted; }

void check_attributes(const MeshInputs& in, std::size_t index) {
  const Mesh& mesh = *in.meshes[index];
  const std::size_t n = mesh.positions.size();
  if (!attribute_fits(mesh.normals.size(), n) || !attribute_fits(mesh.uvs.size(), n) ||
      !attribute_fits(mesh.tangents.size(), n) || !attribute_fits(mesh.colors.size(), n) ||
      !attribute_fits(mesh.alphas.size(), n) || !attribute_fits(mesh.materials.size(), mesh.triangles.size()))
    fail(in, index,
         "normals, uvs, tangents or colours are not one a vertex, or materials not one a triangle");
  for (const int material : mesh.materials)
    if (material >= static_cast<int>(in.material_count))
      fail(in, index, fmt::format("material {} of {}", material, in.material_count));
}

/// Reports the first triangle corner that has no valid box.
[[noreturn]] void fail_corner(const MeshInputs& in, std::span<const std::size_t> meshes) {
  for (const std::size_t index : meshes) {
    const Mesh& mesh = *in.meshes[index];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int corner = 0; corner < 3; ++corner) {
        const u32 vertex = mesh.triangles[t][corner];
        if (vertex >= mesh.positions.size())
          fail(in, index,
               fmt::format("triangle {} names vertex {}; wanted less than {}; mend the model", t, vertex,
                           mesh.positions.size()));
        const glm::vec3& p = mesh.positions[vertex];
        if (!in_range(p))
          fail(in, index,
               fmt::format("vertex {} is ({}, {}, {}); wanted finite numbers up to {:g}; mend the model",
                           vertex, p.x, p.y, p.z, farthest_vertex));
      }
  }
  throw std::logic_error("meshes that were refused have no bad corner");
}

/// The box of a triangle; empty if a corner is invalid or out of range.
Bounds triangle_box(const Mesh& mesh, const glm::uvec3& triangle) {
  Bounds box = Bounds::none();
  for (int corner = 0; corner < 3; ++corner) {
    if (triangle[corner] >= mesh.positions.size()) return Bounds::none();
    const glm::vec3& p = mesh.positions[triangle[corner]];
    if (!in_range(p)) return Bounds::none();
    box.extend(Lanes{p.x, p.y, p.z, 0});
  }
  return box;
}

/// Computes PlacedMesh::unit.
double table_unit(const Mesh& mesh) {
  constexpr int far = 24;  // 2^24 is 1.7e7: products of three edges of a small triangle stay normal
  const auto greatest = [&](const tbb::blocked_range<std::size_t>& range, float most) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const glm::vec3 size = glm::abs(mesh.positions[i]);
      most = std::max({most, size.x, size.y, size.z});
    }
    return most;
  };
  const float most = tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), 4096),
                                          0.0f, greatest, [](float a, float b) { return std::max(a, b); });
  if (!(most > 0 && most <= farthest_vertex)) return 1;
  const int exponent = std::clamp(std::ilogb(most), -126, 126);  // its inverse is a float too
  return std::abs(exponent) <= far ? 1 : std::ldexp(1.0, exponent);
}

/// The mesh in table units.
Mesh resized(const Mesh& mesh, double unit) {
  Mesh result = mesh;
  const double scale = 1 / unit;  // a power of two: exact, except for vanishing values
  for (glm::vec3& p : result.positions) p = glm::vec3(glm::dvec3(p) * scale);
  return result;
}

/// A BVH and the meshes that share it.
struct Tree {
  std::vector<std::size_t> meshes;
  Mesh copy;  // positions and triangles of several meshes or of a scaled one; else empty
  WideBvh bvh;

  const Mesh& mesh(const MeshInputs& in) const {
    return copy.triangles.empty() ? *in.meshes[meshes[0]] : copy;
  }
};

/// Joins the positions and triangles of several meshes.
Mesh join_meshes(const MeshInputs& in, std::span<const std::size_t> meshes) {
  Mesh joined;
  std::vector<glm::vec3>& positions = joined.positions.values();
  std::vector<glm::uvec3>& triangles = joined.triangles.values();
  for (const std::size_t i : meshes) {
    const Mesh& mesh = *in.meshes[i];
    const auto first = static_cast<u32>(positions.size()), count = static_cast<u32>(mesh.positions.size());
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const glm::uvec3& triangle : mesh.triangles) {
      if (triangle.x >= count || triangle.y >= count || triangle.z >= count) fail_corner(in, {&i, 1});
      triangles.push_back(triangle + first);
    }
  }
  return joined;
}

/// Assigns meshes to BVHs; groups with a scaled mesh are not shared.
std::vector<Tree> plan_trees(const MeshInputs& in, const std::vector<PlacedMesh>& placed) {
  std::vector<Tree> trees;
  for (const std::vector<std::size_t>& group : in.groups) {
    const bool together = std::ranges::all_of(group, [&](std::size_t i) { return placed[i].unit == 1; });
    if (together)
      trees.push_back({group, {}, {}});
    else
      for (const std::size_t i : group) trees.push_back({{i}, {}, {}});
  }
  return trees;
}

void build_tree(const MeshInputs& in, double unit, Tree& tree) {
  for (const std::size_t i : tree.meshes) check_attributes(in, i);
  if (tree.meshes.size() > 1)
    tree.copy = join_meshes(in, tree.meshes);
  else if (unit != 1)
    tree.copy = resized(*in.meshes[tree.meshes[0]], unit);
  const Mesh& mesh = tree.mesh(in);
  const auto fill = [&](std::span<Ref> refs) {
    std::atomic<bool> bad{false};
    in_parallel(refs.size(), [&](std::size_t t) {
      const Bounds box = triangle_box(mesh, mesh.triangles[t]);
      if (box.empty()) bad = true;
      refs[t] = Ref::of(box, static_cast<u32>(t));
    });
    if (bad) fail_corner(in, tree.meshes);
  };
  WideBvhSettings settings;
  if (in.spatial_splits) settings.cut = &mesh;
  tree.bvh = build_wide_bvh(mesh.triangles.size(), fill, settings);
}

/// Computes exactly as finish_triangle does.
bool has_area(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  return glm::cross(v1 - v0, v2 - v0) != glm::vec3(0);
}

TriangleBlock make_block(const Mesh& mesh, std::span<const u32> members, u32 first_triangle) {
  TriangleBlock block{};
  std::fill(std::begin(block.prim), std::end(block.prim), NO_PRIM);
  for (std::size_t lane = 0; lane < members.size(); ++lane) {
    const glm::uvec3& triangle = mesh.triangles[members[lane]];
    const glm::vec3& v0 = mesh.positions[triangle.x];
    glm::vec3 v1 = mesh.positions[triangle.y], v2 = mesh.positions[triangle.z];
    // A point is never hit; a degenerate triangle might be, by rounding, and has no normal.
    if (!has_area(v0, v1, v2)) v1 = v2 = v0;
    block.v0_x[lane] = v0.x, block.v0_y[lane] = v0.y, block.v0_z[lane] = v0.z;
    block.v1_x[lane] = v1.x, block.v1_y[lane] = v1.y, block.v1_z[lane] = v1.z;
    block.v2_x[lane] = v2.x, block.v2_y[lane] = v2.y, block.v2_z[lane] = v2.z;
    block.prim[lane] = first_triangle + members[lane];
  }
  return block;
}

/// Copies the tree to the tables with absolute indices.
void append_tree(const WideBvh& tree, const Mesh& mesh, u32 first_triangle, std::span<Bvh8Node> nodes,
                 u32 first_node, std::span<TriangleBlock> blocks, u32 first_block) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree.nodes.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      nodes[i] = tree.nodes[i];
      for (u32& child : nodes[i].child)
        if (child != BVH_EMPTY) child += child & BVH_LEAF ? first_block : first_node;
    }
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree.blocks.size(), 512), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      blocks[i] = make_block(
          mesh, std::span(tree.members).subspan(tree.blocks[i].first, tree.blocks[i].count), first_triangle);
  });
}

/// Sets each triangle's `place`: a lane of the first block that contains it.
void note_places(std::span<const TriangleBlock> blocks, u32 first_block,
                 std::span<TriangleShading> all_triangles) {
  for (std::size_t i = blocks.size(); i-- > 0;)
    for (u32 lane = 0; lane < 8; ++lane)
      if (blocks[i].prim[lane] != NO_PRIM)
        all_triangles[blocks[i].prim[lane]].place = (first_block + static_cast<u32>(i)) * 8 + lane;
}

/// Row counts of the tables, or a mesh's first rows.
struct Rows {
  std::size_t nodes = 0, blocks = 0, triangles = 0, vertices = 0;
};

void check_rows(const MeshInputs& in, const Rows& sum) {
  if (sum.blocks > BVH_FIRST_MASK || sum.nodes >= BVH_LEAF || sum.triangles >= NO_PRIM ||
      sum.vertices >= NO_PRIM)
    throw SceneError(
        *in.file, "",
        fmt::format("{} triangles in {} blocks are more than the tables can index; use smaller meshes",
                    sum.triangles, sum.blocks));
}

/// Returns the first rows of each tree, then the totals. Also sets the first rows of meshes in `placed`.
std::vector<Rows> lay_out(const MeshInputs& in, const std::vector<Tree>& trees,
                          std::vector<PlacedMesh>& placed) {
  std::vector<Rows> first(1);
  for (const Tree& tree : trees) {
    Rows next = first.back();
    for (const std::size_t i : tree.meshes) {
      placed[i].follows = i != tree.meshes[0];
      placed[i].root = static_cast<u32>(first.back().nodes);
      placed[i].first_vertex = static_cast<u32>(next.vertices);
      placed[i].first_triangle = static_cast<u32>(next.triangles);
      placed[i].triangle_count = static_cast<u32>(in.meshes[i]->triangles.size());
      next.triangles += in.meshes[i]->triangles.size();
      next.vertices += vertex_count(*in.meshes[i]);
    }
    next.nodes += tree.bvh.nodes.size();
    next.blocks += tree.bvh.blocks.size();
    first.push_back(next);
  }
  check_rows(in, first.back());
  return first;
}

void resize_tables(const Rows& rows, Meshes& out) {
  tbb::parallel_invoke([&] { out.nodes.resize(rows.nodes); }, [&] { out.blocks.resize(rows.blocks); },
                       [&] { out.triangles.resize(rows.triangles); },
                       [&] { out.vertices.resize(rows.vertices); });
}

std::vector<Bounds> grandchildren(const std::vector<Bvh8Node>& nodes) {
  std::vector<Bounds> boxes;
  const auto visit = [&](const auto& self, u32 index, int level) -> void {
    const Bvh8Node& node = nodes[index];
    for (u32 slot = 0; slot < BVH_WIDTH && (node.valid >> slot & 1u); ++slot)
      if (level == 0 || node.child[slot] & BVH_LEAF)
        boxes.push_back(child_bounds(node, slot));
      else
        self(self, node.child[slot], level - 1);
  };
  visit(visit, 0, 1);
  return boxes;
}

/// Boxes of parts of a mesh in a shared tree: runs of its triangles, which lie close together.
std::vector<Bounds> boxes_of_rows(const Mesh& mesh) {
  constexpr std::size_t parts = 32;
  const std::size_t step = (mesh.triangles.size() + parts - 1) / parts;
  std::vector<Bounds> boxes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % step == 0) boxes.push_back(Bounds::none());
    boxes.back().extend(triangle_box(mesh, mesh.triangles[t]));
  }
  return boxes;
}

std::vector<u32> distinct_materials(std::span<const TriangleShading> triangles) {
  std::vector<u32> materials;
  for (const TriangleShading& triangle : triangles) {
    if (!materials.empty() && materials.back() == triangle.material) continue;
    if (std::find(materials.begin(), materials.end(), triangle.material) == materials.end())
      materials.push_back(triangle.material);
  }
  return materials;
}

/// Writes a tree's meshes to the tables, in parallel.
void fill_tables(const MeshInputs& in, const Tree& tree, const Rows& first, Meshes& out) {
  std::vector<PlacedMesh>& placed = out.placed;
  const Mesh& mesh = tree.mesh(in);
  const WideBvh& bvh = tree.bvh;
  double cost = 0;
  u32 stack = 0;
  tbb::parallel_invoke(
      [&] { cost = expected_cost(bvh.nodes, 0, [](u32, u32 count) { return double(count); }); },
      [&] { stack = stack_need(bvh.nodes, 0); },
      [&] {
        append_tree(bvh, mesh, static_cast<u32>(first.triangles),
                    std::span(out.nodes.edit()).subspan(first.nodes), static_cast<u32>(first.nodes),
                    std::span(out.blocks.edit()).subspan(first.blocks), static_cast<u32>(first.blocks));
      },
      [&] {
        tbb::parallel_for(std::size_t{0}, tree.meshes.size(), [&](std::size_t k) {
          const Mesh& own = tree.meshes.size() > 1 ? *in.meshes[tree.meshes[k]] : mesh;
          PlacedMesh& one = placed[tree.meshes[k]];
          const auto triangles =
              std::span(out.triangles.edit()).subspan(one.first_triangle, one.triangle_count);
          fill_vertices(own, one.first_vertex, in.default_material,
                        std::span(out.vertices.edit()).subspan(one.first_vertex, vertex_count(own)),
                        triangles);
          one.materials = distinct_materials(triangles);
          one.boxes = tree.meshes.size() > 1 ? boxes_of_rows(own) : grandchildren(bvh.nodes);
        });
      });
  for (const std::size_t i : tree.meshes) placed[i].cost = cost, placed[i].stack = stack;
  note_places(std::span(out.blocks.rows()).subspan(first.blocks, bvh.blocks.size()),
              static_cast<u32>(first.blocks), out.triangles.edit());
}

double mean_fill(const std::vector<Tree>& trees) {
  std::size_t members = 0, blocks = 0;
  for (const Tree& tree : trees) {
    members += tree.bvh.members.size();
    blocks += tree.bvh.blocks.size();
  }
  return blocks > 0 ? static_cast<double>(members) / static_cast<double>(blocks) : 0;
}

}  // namespace

MeshInputs mesh_inputs(const SceneDescription& scene, const Surfaces& surfaces) {
  MeshInputs in{.file = file_of(scene),
                .spatial_splits = scene.render.spatial_splits,
                .default_material = surfaces.default_material,
                .material_count = scene.materials.size(),
                .meshes = placed_meshes(scene),
                .groups = mesh_groups(scene)};
  in.places.value.resize(scene.meshes.size());
  for (std::size_t i = scene.objects.size(); i-- > 0;)
    if (const auto* shape = std::get_if<MeshShape>(&scene.objects[i].shape))
      in.places.value[static_cast<std::size_t>(shape->mesh)] = scene.objects[i].place;
  return in;
}

Meshes compile_meshes(const MeshInputs& in) {
  Meshes out;
  out.placed.resize(in.meshes.size());
  for (std::size_t i = 0; i < in.meshes.size(); ++i)
    if (in.meshes[i]) out.placed[i].used = true, out.placed[i].unit = table_unit(*in.meshes[i]);
  std::vector<Tree> trees = plan_trees(in, out.placed);
  tbb::parallel_for(std::size_t{0}, trees.size(),
                    [&](std::size_t i) { build_tree(in, out.placed[trees[i].meshes[0]].unit, trees[i]); });
  const std::vector<Rows> first = lay_out(in, trees, out.placed);
  resize_tables(first.back(), out);
  tbb::parallel_for(std::size_t{0}, trees.size(),
                    [&](std::size_t i) { fill_tables(in, trees[i], first[i], out); });
  out.mean_block_fill = mean_fill(trees);
  return out;
}

}  // namespace sundog
