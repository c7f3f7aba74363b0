// See embree_finder.h.
#include "embree_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "embree_mesh.h"

namespace sundog {
namespace {

void set_ray(RTCRay& to, const plain::Ray& from) {
  to.org_x = from.o.x, to.org_y = from.o.y, to.org_z = from.o.z;
  to.dir_x = from.d.x, to.dir_y = from.d.y, to.dir_z = from.d.z;
  // Embree's interval is closed, the integrator's open below: it continues behind its hits.
  to.tnear = from.t_min > 0 ? std::nextafter(from.t_min, std::numeric_limits<float>::infinity()) : from.t_min;
  to.tfar = from.t_max;
  to.time = 0, to.mask = ~0u, to.id = 0, to.flags = 0;
}

/// Throws SceneError unless there is one mesh, and that in world space.
void check_meshes(const SceneDescription& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects) {
    if (!std::holds_alternative<MeshShape>(object.shape)) continue;
    if (++count > 1 || object.world_from_object != dmat4(1))
      throw SceneError(scene.file.string(), object.place,
                       "a second mesh or one that is moved, where one in place was wanted");
  }
  if (count == 0) throw SceneError(scene.file.string(), "/objects", "no mesh, where one was wanted");
}

/// An exact solid with what tells cheaply that a ray passes it by.
struct Solid {
  u32 index = 0;
  Instance instance;
  glm::vec3 center{0};
  float radius2 = 0;  // of a sphere around it; 0: it has none

  bool is_passed(const plain::Ray& ray) const {
    if (radius2 == 0) return false;
    const glm::vec3 to = center - ray.o;
    const float along = glm::dot(to, ray.d), distance2 = glm::dot(to, to);
    return distance2 > radius2 && (along < 0 || distance2 - along * along > radius2);
  }
};

Solid make_solid(u32 index, const Instance& instance) {
  Solid solid{index, instance, {}, 0};
  if (instance.shape != SHAPE_SPHERE) return solid;
  glm::mat3 object_from_world;
  glm::vec3 shift;
  for (int row = 0; row < 3; ++row) {
    const float4& m = instance.object_from_world[row];
    object_from_world[0][row] = m.x, object_from_world[1][row] = m.y, object_from_world[2][row] = m.z;
    shift[row] = m.w;
  }
  const glm::mat3 axes = glm::inverse(object_from_world);
  solid.center = -(axes * shift);
  for (int i = 0; i < 3; ++i) solid.radius2 = std::max(solid.radius2, 1.0001f * glm::dot(axes[i], axes[i]));
  return solid;
}

/// Shrinks the ray to the nearest hit of a solid.
bool closest_in_solids(const std::vector<Solid>& solids, plain::Ray& ray, plain::Hit& hit) {
  bool found = false;
  for (const Solid& solid : solids) {
    if (solid.is_passed(ray)) continue;
    const plain::Ray object{plain::object_point(solid.instance, ray.o),
                            plain::object_vector(solid.instance, ray.d), ray.t_min, ray.t_max};
    plain::SolidHit met;
    if (!plain::closest_in_solid(solid.instance.shape, solid.instance.parameters, object, met)) continue;
    ray.t_max = met.t;
    hit = {met.t, 0, 0, 0, solid.index, met.ng};
    found = true;
  }
  return found;
}

}  // namespace

struct EmbreeFinder::State {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  u32 mesh_instance = 0;
  std::vector<Solid> solids;

  ~State() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

EmbreeFinder::EmbreeFinder(const SceneDescription& scene, const CompiledScene& compiled)
    : state_(std::make_unique<State>()) {
  check_meshes(scene);
  for (u32 i = 0; i < compiled.instances.size(); ++i) {
    if (compiled.instances[i].shape == SHAPE_MESH)
      state_->mesh_instance = i;
    else
      state_->solids.push_back(make_solid(i, compiled.instances[i]));
  }
  rtcSetSceneBuildQuality(state_->scene, RTC_BUILD_QUALITY_MEDIUM);
  RTCGeometry geometry = embree_mesh(state_->device, scene.meshes.at(0), RTC_BUILD_QUALITY_MEDIUM);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(state_->scene);
}

EmbreeFinder::~EmbreeFinder() = default;

bool EmbreeFinder::closest(const plain::Ray& ray, plain::Hit& hit) const {
  plain::Ray left = ray;  // t_max shrinks to the nearest hit
  const bool found = closest_in_solids(state_->solids, left, hit);
  RTCRayHit met;
  set_ray(met.ray, left);
  met.hit.geomID = met.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  EmbreeQuery(false).intersect(state_->scene, met);
  if (met.hit.geomID == RTC_INVALID_GEOMETRY_ID) return found;
  hit = {met.ray.tfar,
         met.hit.u,
         met.hit.v,
         met.hit.primID,
         state_->mesh_instance,
         {met.hit.Ng_x, met.hit.Ng_y, met.hit.Ng_z}};
  return true;
}

bool EmbreeFinder::any(const plain::Ray& ray) const {
  plain::Ray left = ray;
  plain::Hit hit;
  if (closest_in_solids(state_->solids, left, hit)) return true;
  RTCRay shadow;
  set_ray(shadow, ray);
  EmbreeQuery(false).occluded(state_->scene, shadow);
  return shadow.tfar < 0;
}

}  // namespace sundog
