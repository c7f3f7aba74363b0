// Marches rays through fields on a device, for tests.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "sdf_testing.h"
#include "shared/bvh.h"

inline const char* const march_kernel = R"(
#include "lib/sdf/surface.cl"
#include "shared/bvh.h"
// mode bit 0: inside, bit 1: leaving. A Hit: t, steps in u, taken back in v, flags (1 hit, 2 cut, 4 limited) in prim, the normal.
__kernel void march(__global const SdfField* fields, __global const float* q, __global const Ray* rays,
                    __global Hit* hits, u32 field, u32 mode, float footprint, float spread, u32 count) {
  const u32 item = get_global_id(0);
  if (item * LANES >= count) return;
  MarchRays r;
  for (u32 i = 0; i < LANES; ++i) {
    const Ray ray = rays[item * LANES + i];
    REAL_LANE(r.origin.x, i) = ray.ox; REAL_LANE(r.origin.y, i) = ray.oy; REAL_LANE(r.origin.z, i) = ray.oz;
    REAL_LANE(r.direction.x, i) = ray.dx; REAL_LANE(r.direction.y, i) = ray.dy; REAL_LANE(r.direction.z, i) = ray.dz;
    REAL_LANE(r.t_min, i) = ray.t_min; REAL_LANE(r.t_max, i) = ray.t_max;
  }
  r.footprint = (REAL)(footprint);
  r.spread = (REAL)(spread);
  r.active = ALL_LANES;
  r.step_limit = fields[field].step_limit;
  r.inside = (mode & 1u) ? ALL_LANES : NO_LANES;
  r.leaving = (mode & 2u) ? ALL_LANES : NO_LANES;
  const Scene scene = {.sdf_fields = fields, .sdf_parameters = q};
  MarchHits h = march_rays(&scene, field, &r);
  REAL3 normal = sdf_normal(&scene, field, along3(r.origin, h.t, r.direction), h.threshold, h.hit, h.cut);
  for (u32 i = 0; i < LANES; ++i) {
    __global Hit* hit = hits + item * LANES + i;  // assigned whole, Mesa 25 keeps the last one alone
    hit->t = REAL_LANE(h.t, i);
    hit->u = (float)MASK_LANE(h.steps, i);
    hit->v = (float)MASK_LANE(h.taken_back, i);
    hit->prim = (MASK_LANE(h.hit, i) ? 1u : 0u) | (MASK_LANE(h.cut, i) ? 2u : 0u) | (MASK_LANE(h.limited, i) ? 4u : 0u);
    hit->instance = 0;
    hit->ng_x = REAL_LANE(normal.x, i); hit->ng_y = REAL_LANE(normal.y, i); hit->ng_z = REAL_LANE(normal.z, i);
  }
}
)";

inline sundog::Ray make_ray(const glm::dvec3& o, const glm::dvec3& d, double t_min = 0, double t_max = 1e20) {
  const auto f = [](double v) { return static_cast<float>(v); };
  return {f(o.x), f(o.y), f(o.z), f(t_min), f(d.x), f(d.y), f(d.z), f(t_max)};
}

struct MarchOptions {
  int lanes = 0;  // 0: as the renderer would choose them
  sundog::u32 mode = 0;
  float footprint = 0, spread = 0;
  sundog::u32 field = 0;
};

inline std::vector<sundog::Hit> march(sundog::Device& device, const sundog::CompiledFields& fields,
                                      std::vector<sundog::Ray> rays, MarchOptions options = {}) {
  using namespace sundog;
  if (options.lanes == 0) options.lanes = usual_lanes(device.info());
  const std::size_t count = rays.size();
  while (rays.size() % 16) rays.push_back(rays.back());
  auto kernel =
      build_fields(device, march_kernel, fields, options.lanes, true)
          .kernel<Buffer<SdfField>, Buffer<float>, Buffer<Ray>, Buffer<Hit>, u32, u32, float, float, u32>(
              "march");
  const auto records = device.upload<SdfField>(fields.fields);
  const auto q = device.upload<float>(fields.parameters);
  const auto in = device.upload<Ray>(rays);
  auto out = device.make<Hit>(rays.size());
  device.run(kernel, {.x = rays.size() / static_cast<std::size_t>(options.lanes), .local_x = 16}, records, q,
             in, out, options.field, options.mode, options.footprint, options.spread,
             static_cast<u32>(rays.size()));
  std::vector<Hit> hits(rays.size());
  device.read(out, std::span<Hit>(hits));
  device.finish();
  hits.resize(count);
  return hits;
}

inline sundog::CompiledFields compiled(const sundog::SdfDescription& field) {
  return sundog::compile_fields(std::span(&field, 1));
}

/// A ray in double precision.
struct Plain {
  glm::dvec3 o, d;
  explicit Plain(const sundog::Ray& r) : o(r.ox, r.oy, r.oz), d(r.dx, r.dy, r.dz) {}
};
