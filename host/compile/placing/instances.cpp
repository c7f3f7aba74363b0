// Places all objects, joins meshes that share a BVH, takes a few large solids out of the tree, builds it, and
// stores instances in leaf order, then large solids, planes and fields.
#include "compile/placing/instances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "base/error.h"
#include "compile/bvh/wide_bvh.h"
#include "compile/placing/instance_bounds.h"
#include "compile/placing/motion.h"
#include "compile/shapes.h"
#include "compile/surfaces/lobes.h"
#include "compile/touching/near_fields.h"

namespace sundog {
namespace {

/// An instance and its world bounds. `cost`: expected cost of a ray that crosses them.
struct Placed {
  Instance instance{};
  Bounds box = Bounds::none();  // over the shutter interval
  std::vector<Bounds> parts;    // smaller boxes that together contain it; may be empty
  std::vector<Placed> sharing;  // the other meshes in its BVH
  bool follows = false;
  double cost = 1;
  float4 moves{};
  bool bounded() const { return instance.shape != SHAPE_PLANE; }
};

[[noreturn]] void fail_transform(const std::string& file, const Object& object) {
  throw SceneError(file, object.place,
                   fmt::format("object \"{}\": its transform cannot be inverted in single precision; "
                               "wanted scales that are neither zero nor extreme",
                               object.name));
}

/// Stores the inverse of `world_from_unit`; returns the transform that kernels effectively use.
dmat4 set_transform(const std::string& file, const Object& object, const dmat4& world_from_unit,
                    Instance& instance) {
  const bool identity = world_from_unit == dmat4(1) && !object.moves();
  if (identity) instance.flags |= INSTANCE_IDENTITY;
  const dmat4 inverse = glm::inverse(world_from_unit);
  dmat4 used(1);
  for (int row = 0; row < 3; ++row) {
    std::array<float, 4> values;
    for (int column = 0; column < 4; ++column) {
      const auto value = static_cast<float>(inverse[column][row]);
      if (!std::isfinite(value)) fail_transform(file, object);
      values[static_cast<std::size_t>(column)] = value;
      used[column][row] = double(value);
    }
    instance.object_from_world[row] = {values[0], values[1], values[2], values[3]};
  }
  const auto& rows = instance.object_from_world;
  const bool turned = rows[0].y != 0 || rows[0].z != 0 || rows[1].x != 0 || rows[1].z != 0 ||
                      rows[2].x != 0 || rows[2].y != 0;
  if (!identity && !turned) instance.flags |= INSTANCE_SCALES;
  const dmat4 back = glm::inverse(used);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (!std::isfinite(static_cast<float>(back[column][row]))) fail_transform(file, object);
  return back;
}

u32 surface_flags(const SurfaceFacts& material) {
  u32 flags = 0;
  if (material.flags & MATERIAL_TRANSMITS && !(material.flags & MATERIAL_SHADOW_OPAQUE))
    flags |= INSTANCE_FILTERS;
  if (material.flags & MATERIAL_TRANSMITS && !(material.flags & MATERIAL_THIN)) flags |= INSTANCE_TRANSMITS;
  return flags;
}

/// A field's interval, rounded outwards.
Bounds interval_of(const FieldInterval& field) {
  Bounds box = Bounds::none();
  for (int axis = 0; axis < 3; ++axis) {
    const auto lower = static_cast<float>(field.lower[axis]), upper = static_cast<float>(field.upper[axis]);
    box.lower[axis] = std::nextafter(lower, -std::numeric_limits<float>::infinity());
    box.upper[axis] = std::nextafter(upper, std::numeric_limits<float>::infinity());
  }
  box.lower[3] = box.upper[3] = 0;
  return box;
}

/// Converts objects to instances, and notes the kernel features that their materials need.
class Placer {
 public:
  Placer(const InstanceInputs& in, Instances& out) : in_(in), out_(out) {}

  Placed place(const Object& object, u32 index) {
    Placed placed;
    Instance& instance = placed.instance;
    UnitShape unit = unit_shape(*in_.file, object);
    instance.shape = unit.shape;
    instance.parameters = unit.parameters;
    if (unit.revolution) instance.parameters.x = add_profile(unit.revolution->arcs());
    instance.object = index;
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    const PlacedMesh* mesh = shape ? &in_.meshes->placed[static_cast<std::size_t>(shape->mesh)] : nullptr;
    if (mesh) unit.scale = dvec3(mesh->unit);
    const double size = std::cbrt(std::abs(glm::determinant(glm::dmat3(object.world_from_object))));
    instance.pattern_scale = {static_cast<float>(unit.scale.x), static_cast<float>(unit.scale.y),
                              static_cast<float>(unit.scale.z), static_cast<float>(1 / size)};
    if (mesh) {
      instance.root = mesh->root;
      instance.first_prim = mesh->first_triangle;
      placed.cost = mesh->cost;
      placed.follows = mesh->follows;
    }
    Bounds interval = Bounds::none();
    std::span<const Bounds> boxes;
    if (mesh) boxes = mesh->boxes;
    if (const auto* field = std::get_if<FieldShape>(&object.shape)) {
      instance.root = static_cast<u32>(field->field);
      interval = interval_of(in_.fields[static_cast<std::size_t>(field->field)]);
      boxes = {&interval, 1};
    }
    set_surface(object, mesh, instance);
    set_place(object, unit, boxes, placed);
    return placed;
  }

 private:
  /// The first row of a profile; equal profiles share rows.
  float add_profile(const std::vector<ProfileArc>& arcs) {
    for (const auto& [first, count] : profiles_)
      if (count == arcs.size() &&
          std::ranges::equal(arcs, std::span(out_.profiles.rows()).subspan(first, count)))
        return static_cast<float>(first);
    std::vector<ProfileArc>& all = out_.profiles.edit();
    profiles_.emplace_back(all.size(), arcs.size());
    all.insert(all.end(), arcs.begin(), arcs.end());
    return static_cast<float>(profiles_.back().first);
  }

  void set_place(const Object& object, const UnitShape& unit, std::span<const Bounds> boxes, Placed& placed) {
    const dmat4 scale(glm::dmat3(unit.scale.x, 0, 0, 0, unit.scale.y, 0, 0, 0, unit.scale.z));
    dmat4 local_from_object = object.world_from_object;
    local_from_object[3] -= glm::dvec4(in_.origin, 0);
    if (!placed.bounded()) local_from_object = in_.planes[planes_++];
    const dmat4 world_from_unit =
        set_transform(*in_.file, object, local_from_object * scale, placed.instance);
    if (object.moves()) set_motion(object, placed);
    if (!placed.bounded()) return;
    const bool exact = placed.instance.flags & INSTANCE_IDENTITY;
    placed.box = object.moves() ? moving_bounds(object, unit, boxes, world_from_unit, in_.origin)
                                : world_bounds(unit, boxes, world_from_unit, exact);
    placed.instance.world_center = sphere_around(placed.box);
    const bool solid = unit.shape != SHAPE_MESH && unit.shape != SHAPE_SDF;
    if (solid && !exact && !object.moves()) placed.parts = part_bounds(unit, world_from_unit, placed.box);
  }

  void set_motion(const Object& object, Placed& placed) {
    placed.moves = add_motion(*in_.file, object, in_.origin, out_.turns.edit());
    out_.features.object_motion = true;
    out_.features.turns |= !object.turns.empty();
  }

  void set_surface(const Object& object, const PlacedMesh* mesh, Instance& instance) {
    instance.light = NO_LIGHT;
    instance.material = object.material >= 0 ? static_cast<u32>(object.material) : NO_MATERIAL;
    if (mesh && object.material < 0) {
      for (const u32 material : mesh->materials) use(material, instance);
      return;
    }
    if (object.material < 0) instance.material = in_.default_material;
    use(instance.material, instance);
  }

  void use(u32 index, Instance& instance) {
    const SurfaceFacts& material = in_.surfaces.at(index);
    const u32 flags = surface_flags(material);
    instance.flags |= flags;
    for (const LobeRow& lobe : lobe_rows)
      if (lobe.feature && material.flags & lobe.flags) out_.features.*lobe.feature = true;
    constexpr u32 rough_glass = MATERIAL_TRANSMITS | MATERIAL_ROUGH;
    if (material.kind == MATERIAL_DIELECTRIC &&
        (material.flags & (rough_glass | MATERIAL_THIN)) == rough_glass)
      out_.features.rough_glass = true;
    if (material.flags & (MATERIAL_WALL | MATERIAL_FROSTED)) out_.features.thin_walls = true;
    if (material.shines) out_.features.emission = true;
    if (flags & INSTANCE_TRANSMITS) out_.features.media = true;
    if (material.flags & (MATERIAL_TRANSMITS | MATERIAL_CATCHER) && instance.shape == SHAPE_SDF)
      out_.features.two_sided_fields = true;
    if (flags & INSTANCE_FILTERS) out_.features.shadow_filters = true;
  }

  const InstanceInputs& in_;
  Instances& out_;
  std::size_t planes_ = 0;                                     // number placed so far
  std::vector<std::pair<std::size_t, std::size_t>> profiles_;  // first row and number of rows of each
};

/// Moves meshes that share a BVH into `sharing` of the first of them.
void join_sharing(std::vector<Placed> following, std::vector<Placed>& bounded) {
  std::unordered_map<u32, std::size_t> first;
  for (std::size_t i = 0; i < bounded.size(); ++i)
    if (bounded[i].instance.shape == SHAPE_MESH) first.emplace(bounded[i].instance.root, i);
  std::ranges::sort(following, {}, [](const Placed& placed) { return placed.instance.first_prim; });
  for (Placed& placed : following) {
    Placed& joined = bounded[first.at(placed.instance.root)];
    Instance& before = joined.sharing.empty() ? joined.instance : joined.sharing.back().instance;
    before.flags |= INSTANCE_SHARES;
    joined.sharing.push_back(std::move(placed));
  }
}

/// The box of an instance and of the other meshes in its BVH.
Bounds box_of_all(const Placed& placed) {
  Bounds box = placed.box;
  for (const Placed& other : placed.sharing) box.extend(other.box);
  return box;
}

/// Refs of the instances' boxes, or of their parts, which put an instance into several leaves.
std::vector<Ref> refs_of(const std::vector<Placed>& bounded) {
  constexpr std::size_t most_in_parts = 1000;  // the leaves of a CompactNode must be close together
  std::vector<Ref> refs;
  for (std::size_t i = 0; i < bounded.size(); ++i) {
    const Placed& placed = bounded[i];
    const bool in_parts = !placed.parts.empty() && bounded.size() <= most_in_parts;
    const Bounds whole = box_of_all(placed);
    for (const Bounds& box : in_parts ? std::span<const Bounds>(placed.parts) : std::span(&whole, 1))
      refs.push_back(Ref::of(box, static_cast<u32>(i)));
  }
  return refs;
}

/// Builds the scene BVH over the bounded instances, and sorts them in leaf order.
void add_scene_bvh(std::vector<Placed>& bounded, Instances& out, u32 mesh_stack) {
  const std::vector<Ref> refs = refs_of(bounded);
  WideBvhSettings settings;
  settings.block_width = 1;
  settings.block_cost = 3;  // an instance costs more than a node
  const bool shared = std::ranges::any_of(bounded, [](const Placed& one) { return !one.sharing.empty(); });
  if (shared || refs.size() > bounded.size()) settings.max_leaf_blocks = 1;  // a leaf's blocks are adjacent
  WideBvh tree =
      build_wide_bvh(refs.size(), [&](std::span<Ref> to) { std::ranges::copy(refs, to.begin()); }, settings);
  const bool alone = bounded.size() == 1;
  std::vector<Placed> sorted;
  std::vector<u32> places(bounded.size(), NO_INSTANCE), place_of_block;
  for (const WideBvh::Block& block : tree.blocks) {
    u32& place = places[tree.members[block.first]];
    if (place == NO_INSTANCE) {
      place = static_cast<u32>(sorted.size());
      sorted.push_back(bounded[tree.members[block.first]]);
      std::vector<Placed> sharing = std::move(sorted.back().sharing);
      std::ranges::move(sharing, std::back_inserter(sorted));
    }
    place_of_block.push_back(place);
  }
  bounded = std::move(sorted);
  for (Bvh8Node& node : tree.nodes)
    for (u32 slot = 0; slot < BVH_WIDTH && (node.valid >> slot & 1u); ++slot)
      if (u32& child = node.child[slot]; child & BVH_LEAF)
        child = (child & ~BVH_FIRST_MASK) | place_of_block[child & BVH_FIRST_MASK];

  const auto root = static_cast<u32>(out.nodes.size());
  std::vector<Bvh8Node>& nodes = out.nodes.edit();
  nodes.reserve(nodes.size() + tree.nodes.size());  // no excess capacity
  for (Bvh8Node node : tree.nodes) {
    for (u32& child : node.child)
      if (!(child & BVH_LEAF)) child += root;
    nodes.push_back(node);
  }

  out.tlas_root = alone ? BVH_LEAF : root;
  out.bounded_count = static_cast<u32>(bounded.size());
  out.features.bvh_stack = std::max(1u, stack_need(tree.nodes, 0) + mesh_stack);
  out.sah_cost = expected_cost(tree.nodes, 0, [&](u32 first, u32 count) {
    double sum = 0;
    for (u32 i = first; i < first + count; ++i) sum += bounded[i].cost;
    return sum;
  });
}

/// Removes a few large solids from the scene BVH and returns them: testing one for a whole batch of rays is
/// faster than taking every ray to it through the tree, and a single remaining mesh needs no scene tree at
/// all. As in SAH, the share of rays that hit a solid is its box's area relative to `scene`'s; a small solid
/// would cost each ray more than it saves, and a lathe's test is too long for rays that pass it.
std::vector<Placed> take_large_solids(std::vector<Placed>& bounded, const Bounds& scene) {
  constexpr float share = 0.05f;
  constexpr std::size_t few = 16;
  const auto is_mesh = [](const Placed& placed) { return placed.instance.shape == SHAPE_MESH; };
  const auto stays = [&](const Placed& placed) {
    return is_mesh(placed) || placed.instance.shape == SHAPE_LATHE;
  };
  if (std::none_of(bounded.begin(), bounded.end(), is_mesh)) return {};
  const Lanes edges = scene.upper - scene.lower;
  const float scale = 1 / std::max({edges[0], edges[1], edges[2], 1e-30f});
  const float least = share * half_area(scene, scale);
  std::vector<Placed> left, large;
  for (const Placed& placed : bounded)
    (stays(placed) || half_area(placed.box, scale) < least ? left : large).push_back(placed);
  bounded = std::move(left);
  if (large.size() <= few) return large;
  bounded.insert(bounded.end(), large.begin(), large.end());
  return {};
}

SurfaceFacts facts_of(const Material& material) {
  u32 known = MATERIAL_SHADOW_OPAQUE | MATERIAL_THIN | MATERIAL_WALL | MATERIAL_FROSTED | MATERIAL_CATCHER;
  for (const LobeRow& lobe : lobe_rows)
    if (lobe.feature) known |= lobe.flags;
  const float4& shines = material.emission;
  return {material.flags & known, material.kind, shines.x != 0 || shines.y != 0 || shines.z != 0};
}

}  // namespace

InstanceInputs instance_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Meshes>& meshes, const Surfaces& surfaces) {
  InstanceInputs in{.file = file_of(scene),
                    .origin = origin,
                    .meshes = meshes,
                    .default_material = surfaces.default_material,
                    .objects = scene.objects};
  for (const SdfDescription& field : scene.fields) in.fields.push_back({field.lower, field.upper});
  for (const Object& object : scene.objects)
    if (std::holds_alternative<PlaneShape>(object.shape))
      in.planes.push_back(place_of_plane(scene, object, origin));
  for (const Material& material : surfaces.materials) in.surfaces.push_back(facts_of(material));
  return in;
}

Instances compile_instances(const InstanceInputs& in) {
  Instances out;
  out.nodes = in.meshes->nodes;
  std::vector<Placed> bounded, following, unbounded, fields, shown;  // shown: fields whose walls both show
  u32 mesh_stack = 0;
  Placer placer(in, out);
  for (std::size_t i = 0; i < in.objects.size(); ++i) {
    const Object& object = in.objects[i];
    if (const auto* shape = std::get_if<MeshShape>(&object.shape)) {
      const PlacedMesh& mesh = in.meshes->placed[static_cast<std::size_t>(shape->mesh)];
      if (mesh.triangle_count == 0) continue;
      mesh_stack = std::max(mesh_stack, mesh.stack);
    }
    const Placed placed = placer.place(object, static_cast<u32>(i));
    out.features.shapes[placed.instance.shape] = true;
    if (placed.instance.shape == SHAPE_SDF)
      (shows_both_walls(in.surfaces[placed.instance.material]) ? shown : fields).push_back(placed);
    else
      (placed.follows ? following : placed.bounded() ? bounded : unbounded).push_back(placed);
  }
  join_sharing(std::move(following), bounded);
  for (const Placed& placed : bounded) out.box.extend(box_of_all(placed));
  out.scene_center = bounded.empty() ? float4{} : sphere_around(out.box);
  const std::vector<Placed> large = take_large_solids(bounded, out.box);
  add_scene_bvh(bounded, out, mesh_stack);
  std::vector<Instance> instances;
  std::vector<float4> moves;
  const auto append = [&](const std::vector<Placed>& list) {
    for (const Placed& placed : list) {
      instances.push_back(placed.instance);
      moves.push_back(placed.moves);
      out.boxes.push_back(placed.box);
    }
  };
  append(bounded);
  append(large);
  append(unbounded);
  out.instance_count = static_cast<u32>(instances.size());
  append(shown);  // first, because rays remember the sides of the first fields
  append(fields);
  out.field_end = static_cast<u32>(instances.size());
  const auto boxes = std::span(out.boxes).subspan(out.instance_count);
  if (mark_near_fields(boxes, in.surfaces, std::span(instances).subspan(out.instance_count)))
    out.features.near_fields = out.features.media = true;  // media resolve rays at touching surfaces
  out.instances = std::move(instances);
  if (out.features.object_motion) out.moves = std::move(moves);
  out.features.unbounded = !unbounded.empty();
  return out;
}

}  // namespace sundog
