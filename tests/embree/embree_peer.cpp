// Builds Embree's scene from sundog's, traces rays and translates the hits.
#include "embree_peer.h"

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "base/clock.h"
#include "base/error.h"
#include "embree_mesh.h"
#include "embree_spheres.h"

namespace sundog {
namespace {

constexpr std::size_t chunk_size = 4096;

/// Calls work(begin, end) for chunks of [0, count) on `threads` threads, denormals as zero, as Embree wants
/// it.
template <class Work>
void in_chunks(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    const unsigned mode = _mm_getcsr();
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    for (std::size_t begin; (begin = next.fetch_add(chunk_size)) < count;)
      work(begin, std::min(begin + chunk_size, count));
    _mm_setcsr(mode);
  };
  std::vector<std::thread> others;
  for (unsigned i = 1; i < threads; ++i) others.emplace_back(loop);
  loop();
  for (std::thread& other : others) other.join();
}

void set_ray(RTCRay& to, const Ray& from) {
  to.org_x = from.ox, to.org_y = from.oy, to.org_z = from.oz, to.tnear = from.t_min;
  to.dir_x = from.dx, to.dir_y = from.dy, to.dir_z = from.dz, to.tfar = from.t_max;
  to.time = 0, to.mask = ~0u, to.id = 0, to.flags = 0;
}

/// Sixteen rays from `from` on; lanes beyond `count` are switched off.
void set_rays(RTCRay16& to, std::span<const Ray> from, int* valid) {
  for (std::size_t i = 0; i < 16; ++i) {
    const Ray& ray = from[i < from.size() ? i : 0];
    valid[i] = i < from.size() ? -1 : 0;
    to.org_x[i] = ray.ox, to.org_y[i] = ray.oy, to.org_z[i] = ray.oz, to.tnear[i] = ray.t_min;
    to.dir_x[i] = ray.dx, to.dir_y[i] = ray.dy, to.dir_z[i] = ray.dz, to.tfar[i] = ray.t_max;
    to.time[i] = 0, to.mask[i] = ~0u, to.id[i] = 0, to.flags[i] = 0;
  }
}

}  // namespace

struct EmbreePeer::State {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = nullptr;
  std::vector<RTCScene> meshes;
  bool instanced = false;
  u32 balls = 0;                  // the geometry of all balls
  std::vector<u32> ball_objects;  // the objects that they are
  double seconds = 0;

  ~State() {
    if (scene) rtcReleaseScene(scene);
    for (RTCScene mesh : meshes) rtcReleaseScene(mesh);
    rtcReleaseDevice(device);
  }

  RTCScene new_scene(const EmbreeOptions& options) const {
    RTCScene made = rtcNewScene(device);
    rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(made, options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return made;
  }

  void attach(RTCScene to, RTCGeometry geometry, u32 id) const {
    rtcAttachGeometryByID(to, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void attach_instance(u32 id, const Object& object, RTCScene mesh) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, mesh);
    const glm::mat4 transform(object.world_from_object);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &transform);
    rtcCommitGeometry(geometry);
    attach(scene, geometry, id);
  }

  /// Fills in the object and triangle of a hit from Embree's numbers.
  void name(EmbreeHit& hit, u32 geometry, u32 prim, u32 instance) const {
    if (geometry == RTC_INVALID_GEOMETRY_ID) return;
    const bool of_ball = instance == RTC_INVALID_GEOMETRY_ID && geometry == balls;
    hit.prim = of_ball ? 0 : prim;
    hit.object = of_ball ? ball_objects[prim] : instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry;
  }
};

EmbreePeer::EmbreePeer(const SceneDescription& scene, const EmbreeOptions& options)
    : state_(std::make_unique<State>()) {
  const RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
  State& state = *state_;
  std::vector<Ball> balls;
  std::vector<u32> placed;  // the objects that are meshes
  for (u32 i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (const std::optional<Ball> ball = as_ball(object)) {
      balls.push_back(*ball);
      state.ball_objects.push_back(i);
    } else if (std::holds_alternative<MeshShape>(object.shape)) {
      placed.push_back(i);
    } else {
      throw SceneError(scene.file.string(), object.place,
                       "an exact solid that Embree does not know; use a scene of meshes and balls");
    }
  }
  state.instanced = placed.size() != 1 || scene.objects[placed[0]].world_from_object != dmat4(1);
  const auto shape = [](const Object& object) {
    return static_cast<std::size_t>(std::get<MeshShape>(object.shape).mesh);
  };
  state.scene = state.new_scene(options);
  std::vector<RTCGeometry> geometries;
  for (const Mesh& mesh : scene.meshes) geometries.push_back(embree_mesh(state.device, mesh, quality));
  const Stopwatch clock;
  if (state.instanced) {
    for (RTCGeometry geometry : geometries) {
      state.meshes.push_back(state.new_scene(options));
      state.attach(state.meshes.back(), geometry, 0);
      rtcCommitScene(state.meshes.back());
    }
    for (const u32 i : placed)
      state.attach_instance(i, scene.objects[i], state.meshes[shape(scene.objects[i])]);
  } else {
    const std::size_t used = shape(scene.objects[placed[0]]);
    for (std::size_t i = 0; i < geometries.size(); ++i)
      if (i != used) rtcReleaseGeometry(geometries[i]);
    state.attach(state.scene, geometries[used], placed[0]);
  }
  state.balls = static_cast<u32>(scene.objects.size());
  if (!balls.empty()) state.attach(state.scene, embree_spheres(state.device, balls), state.balls);
  rtcCommitScene(state.scene);
  state.seconds = clock.seconds();
}

EmbreePeer::~EmbreePeer() = default;

double EmbreePeer::build_seconds() const { return state_->seconds; }

void EmbreePeer::intersect(std::span<const Ray> rays, std::span<EmbreeHit> hits, unsigned threads,
                           EmbreeWidth width, bool coherent) const {
  const auto single = [&](std::size_t begin, std::size_t end) {
    EmbreeQuery query(coherent);
    for (std::size_t i = begin; i < end; ++i) {
      RTCRayHit ray;
      set_ray(ray.ray, rays[i]);
      ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      query.intersect(state_->scene, ray);
      hits[i] = {ray.ray.tfar, ray.hit.u, ray.hit.v, NO_PRIM, NO_INSTANCE};
      state_->name(hits[i], ray.hit.geomID, ray.hit.primID, ray.hit.instID[0]);
    }
  };
  const auto packets = [&](std::size_t begin, std::size_t end) {
    EmbreeQuery query(coherent);
    for (std::size_t i = begin; i < end; i += 16) {
      RTCRayHit16 packet;
      alignas(64) int valid[16];
      set_rays(packet.ray, rays.subspan(i, std::min<std::size_t>(16, end - i)), valid);
      for (int k = 0; k < 16; ++k) packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      query.intersect(state_->scene, valid, packet);
      for (std::size_t k = 0; k < 16 && i + k < end; ++k) {
        hits[i + k] = {packet.ray.tfar[k], packet.hit.u[k], packet.hit.v[k], NO_PRIM, NO_INSTANCE};
        state_->name(hits[i + k], packet.hit.geomID[k], packet.hit.primID[k], packet.hit.instID[0][k]);
      }
    }
  };
  if (width == EmbreeWidth::single)
    in_chunks(rays.size(), threads, single);
  else
    in_chunks(rays.size(), threads, packets);
}

void EmbreePeer::occluded(std::span<const Ray> rays, std::span<u32> result, unsigned threads,
                          EmbreeWidth width, bool coherent) const {
  const auto single = [&](std::size_t begin, std::size_t end) {
    EmbreeQuery query(coherent);
    for (std::size_t i = begin; i < end; ++i) {
      RTCRay ray;
      set_ray(ray, rays[i]);
      query.occluded(state_->scene, ray);
      result[i] = ray.tfar < 0;
    }
  };
  const auto packets = [&](std::size_t begin, std::size_t end) {
    EmbreeQuery query(coherent);
    for (std::size_t i = begin; i < end; i += 16) {
      RTCRay16 packet;
      alignas(64) int valid[16];
      set_rays(packet, rays.subspan(i, std::min<std::size_t>(16, end - i)), valid);
      query.occluded(state_->scene, valid, packet);
      for (std::size_t k = 0; k < 16 && i + k < end; ++k) result[i + k] = packet.tfar[k] < 0;
    }
  };
  if (width == EmbreeWidth::single)
    in_chunks(rays.size(), threads, single);
  else
    in_chunks(rays.size(), threads, packets);
}

}  // namespace sundog
