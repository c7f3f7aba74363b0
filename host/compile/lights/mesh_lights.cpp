// Appends a light per triangle and notes the first on the mesh's instances; meshes that move, shine unevenly
// or have too many triangles get none.
#include "compile/lights/mesh_lights.h"

#include "scene/light_groups.h"

#include <algorithm>
#include <cmath>

#include "scene/pack.h"

namespace sundog {
namespace {

/// The radiance emitted outside by a material's triangles, if uniform.
dvec3 even_emission(const AllLightsInputs& in, int material) {
  if (material < 0) return dvec3(0);
  const MaterialDescription& of = in.materials[static_cast<std::size_t>(material)];
  const bool even = of.textures.emission < 0 && of.textures.opacity < 0 && of.opacity == 1;
  return even ? of.emission : dvec3(0);
}

int material_of(const Object& object, const Mesh& mesh, std::size_t triangle) {
  if (object.material >= 0 || mesh.materials.empty()) return object.material;
  return mesh.materials[triangle];
}

Light light_of(const Object& object, const Mesh& mesh, const glm::uvec3& corners, const dvec3& emission,
               const dvec3& origin) {
  const auto world = [&](unsigned i) {
    return dvec3(object.world_from_object * glm::dvec4(dvec3(mesh.positions[i]), 1)) - origin;
  };
  const dvec3 a = world(corners.x), u = world(corners.y) - a, v = world(corners.z) - a;
  dvec3 across = glm::cross(u, v);
  // A mirroring transform reverses the winding, but not the outside.
  if (glm::determinant(glm::dmat3(object.world_from_object)) < 0) across = -across;
  const double twice = glm::length(across);
  Light light{};
  light.kind = LIGHT_TRIANGLE;
  light.position = pack(a);
  light.edge_u = pack(u, glm::length(u));
  light.edge_v = pack(v, glm::length(v));
  if (!(twice > 0) || !std::isfinite(twice)) return light;
  light.direction = pack(across / twice, twice / 2);
  light.color = pack(emission);
  return light;
}

bool shines_somewhere(const AllLightsInputs& in, const Object& object, const Mesh& mesh) {
  if (object.material >= 0 || mesh.materials.empty()) return even_emission(in, object.material) != dvec3(0);
  return std::ranges::any_of(mesh.materials,
                             [&](int material) { return even_emission(in, material) != dvec3(0); });
}

/// For each object, the row of the light that it shows, or NO_LIGHT. Ambient lights have no row.
std::vector<u32> lamps_of(const AllLightsInputs& in) {
  std::vector<u32> rows, lamps;
  u32 row = 0;
  for (const LightDescription& light : in.lights)
    rows.push_back(light.type == LightType::ambient ? NO_LIGHT : row++);
  for (const Object& object : in.objects)
    lamps.push_back(object.light < 0 ? NO_LIGHT : rows.at(static_cast<std::size_t>(object.light)));
  return lamps;
}

}  // namespace

MeshLights add_mesh_lights(const AllLightsInputs& in) {
  MeshLights out{in.of_scene.lights, in.instances};
  std::vector<u32> first = lamps_of(in);
  for (std::size_t i = 0; i < in.objects.size(); ++i) {
    const Object& object = in.objects[i];
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    if (!shape || object.light >= 0) continue;
    const Mesh& mesh = in.meshes[static_cast<std::size_t>(shape->mesh)];
    if (object.moves()) continue;  // found by rays, not sampled
    if (mesh.triangles.size() > most_shining || !shines_somewhere(in, object, mesh)) continue;
    first[i] = static_cast<u32>(out.lights.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const int material = material_of(object, mesh, t);
      Light light = light_of(object, mesh, mesh.triangles[t], even_emission(in, material), in.origin);
      if (material >= 0)
        light.color.w = static_cast<float>(
            number_of_group(in.groups, in.materials[static_cast<std::size_t>(material)].group));
      out.lights.push_back(light);
    }
    out.any = true;
  }
  if (std::ranges::all_of(first, [](u32 light) { return light == NO_LIGHT; })) return out;
  for (Instance& instance : out.instances.edit())
    if (instance.object < first.size() && first[instance.object] != NO_LIGHT)
      instance.light = first[instance.object];
  return out;
}

}  // namespace sundog
