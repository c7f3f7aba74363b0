// Shades textured points of a plane without rays: small programs that scenes share, because some drivers
// compile a frame's kernels for half a minute.
#pragma once
#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "devices.h"
#include "render/device/device_scene.h"
#include "render/device/kernel_config.h"
#include "scenes.h"

namespace surfaces {

using namespace sundog;

/// The parts of shading, each a program of its own, as small as can be: some drivers compile for long.
enum class Part { value, relief, metal_rough, parallax, projected };

/// A point of instance 0, whose outward normal is `n`, as a ray along `d` sees it, lit from `wi`.
struct Point {
  float4 p{0, 0, 0, 0};  // w: the footprint
  float4 d{0, -1, 0, 0};
  float4 wi{0, 1, 0, 0};
  float4 n{0, 1, 0, 0};
};

/// The point as shaded; values outside of the part are zero.
struct Shaded {
  float4 value;  // of the first texture that material 0 has; relief: x: how even the normals are, y and z: an
                 // exponent of 50 and a highlight of 1 on them
  float4 normal;  // relief: the shading one; w: what the terminator keeps of the light
  float4 ambient, diffuse, specular, reflection;  // metal_rough; diffuse.w: the exponent
  float4 sunk;  // parallax: x: how deep the ray went, y: u there, z: the way along x, w: of light past it
};

inline const char* const kernel_text = R"(
static float4 lane4(const REAL3* a, REAL w, u32 i) { return (float4)(get3(a, i), REAL_LANE(w, i)); }
static u32 first_texture(const Scene* scene) {
  u32 slot = 0;
  while (slot + 1u < MAP_COUNT && scene->material_maps[1].slot[slot] == NO_TEXTURE) ++slot;
  return scene->material_maps[1].slot[slot];
}
__kernel void shade_points(SCENE_PARAMETERS, __global const float4* points, __global float4* out, u32 count) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 first = get_global_id(0) * BATCH;
  if (first >= count) return;
  const MASK lanes = lanes_of((1u << min((u32)BATCH, count - first)) - 1u);
  SurfaceInteractions s;
  REAL3 d, wi, n;
  for (u32 i = 0; i < BATCH; ++i) {
    __global const float4* point = points + 4u * min(first + i, count - 1u);
    set3(&s.p, i, point[0].xyz); set3(&d, i, point[1].xyz); set3(&wi, i, point[2].xyz); set3(&n, i, point[3].xyz);
    REAL_LANE(s.footprint, i) = point[0].w;
  }
  const REAL zero = (REAL)(0.0f);
  s.entering = MASK_OF(dot3(n, d) < 0.0f);
  s.ng = select3(negate3(n), n, s.entering);
  s.ns = s.side = s.ng;
  s.offset = zero;
  s.color = all3((float3)(1.0f));
  s.instance = NO_LANES;
  s.material = NO_LANES;
  s.flags = (MASK)((int)scene.materials[0].flags);
  Hits hits = no_hits(zero);
  hits.instance = NO_LANES; hits.prim = NO_LANES; hits.ng = n;
  locate(&scene, &hits, s.p, &s, lanes);
  for (u32 i = 0; i < BATCH && first + i < count; ++i)
    for (u32 k = 0; k < 7u; ++k) out[7u * (first + i) + k] = (float4)(0.0f);
#if PART == 1
  add_relief(&scene, d, &s, lanes);
  const REAL kept = terminator(&s, wi, lanes);
  REAL exponent = (REAL)(50.0f);
  REAL3 shine = all3((float3)(1.0f));
  widen_highlight(s.even, &exponent, &shine, lanes);
  for (u32 i = 0; i < BATCH && first + i < count; ++i) {
    out[7u * (first + i)] = (float4)(REAL_LANE(s.even, i), REAL_LANE(exponent, i), REAL_LANE(shine.x, i), 0.0f);
    out[7u * (first + i) + 1u] = lane4(&s.ns, kept, i);
  }
#elif PART == 3
  add_parallax(&scene, d, &s, lanes);
  const REAL seen = relief_visibility(&scene, &s, wi, lanes);
  for (u32 i = 0; i < BATCH && first + i < count; ++i)
    out[7u * (first + i) + 6u] = (float4)(REAL_LANE(s.sunk, i), REAL_LANE(s.at.u, i), REAL_LANE(s.shift.x, i), REAL_LANE(seen, i));
#else
  const TexturePoints at = texture_points(&scene, &s, lanes);
#if PART == 0 || PART == 4
  const REAL4 value = value_of_texture(&scene, first_texture(&scene), &at, lanes);
  for (u32 i = 0; i < BATCH && first + i < count; ++i)
    out[7u * (first + i)] = (float4)(REAL_LANE(value.x, i), REAL_LANE(value.y, i), REAL_LANE(value.z, i), REAL_LANE(value.w, i));
#else
  const REAL3 none = all3((float3)(0.0f));
  Bsdfs terms;
  terms.ambient = terms.diffuse = terms.specular = terms.reflection = none;
  SlotValues values;
  read_slots(&scene, scene.material_maps + 1, ~0u, &at, &values, lanes);
  metal_rough_terms(scene.material_maps + 1, &values, s.color, &terms, lanes);
  if (scene.material_maps[1].coat > 0.0f) map_coat((REAL)(scene.material_maps[1].coat), &terms, lanes);
  for (u32 i = 0; i < BATCH && first + i < count; ++i) {
    __global float4* to = out + 7u * (first + i);
    to[2] = lane4(&terms.ambient, zero, i); to[3] = lane4(&terms.diffuse, terms.exponent, i);
    to[4] = lane4(&terms.specular, zero, i); to[5] = lane4(&terms.reflection, zero, i);
  }
#endif
#endif
}
)";

using PointKernel = SceneKernel<Buffer<float4>, Buffer<float4>, u32>;

/// A device with a program.
struct Lab {
  Device device;
  PointKernel kernel;
};

/// Features that all scenes of a part share; images or patterns, with or without pages.
inline KernelDefines defines_of(const DeviceInfo& info, Part part, bool images, bool pages) {
  SceneDescription scene = scenes::line_of_sight({0, 5, 0}, {0, 0, 0}, {0, 0, 1});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  CompiledScene flat = compile(scene);
  SceneFeatures& features = flat.features;
  features.maps = features.surface_coordinates = true;
  features.relief = part == Part::relief;
  features.parallax = part == Part::parallax;
  features.metal_rough = part == Part::metal_rough;
  const u32 patterns = (1u << TEXTURE_COUNT) - 1 - (1u << TEXTURE_IMAGE);
  features.texture_kinds = images                ? 1u << TEXTURE_IMAGE
                           : part == Part::value ? patterns
                                                 : 1u << TEXTURE_GRADIENT;
  features.map_slots = (1u << MAP_COUNT) - 1;
  features.texture_mappings = part == Part::projected ? 0x1C : images ? 1 : 2;
  features.texture_stack = !images && part == Part::value ? 4 : 1;
  const u32 few = 1u << TEXEL_GREY8 | 1u << TEXEL_RGBA8;
  features.texel_formats = !images ? 0 : part == Part::value ? 0xFFFF : few;
  features.texel_pages = pages;
  KernelDefines defines = make_kernel_config(flat, info).defines();
  defines["PART"] = std::to_string(static_cast<int>(part));
  return defines;
}

/// The part's includes stand under no #if: there each would be expanded wherever it is met, to 36 MB of text.
inline std::string text_of(Part part) {
  return fmt::format("#include \"lib/shade/bsdf.cl\"\n{}{}",
                     part == Part::parallax ? "#include \"plain/light/relief_shadow.cl\"\n" : "",
                     kernel_text);
}

/// The lab of a device and part, made once for all tests.
inline Lab& lab_of(const DeviceInfo& info, Part part, bool images, bool pages) {
  // Left to the end of the process, as drivers may be gone before.
  static auto& labs = *new std::map<std::tuple<std::string, Part, bool, bool>, std::unique_ptr<Lab>>;
  std::unique_ptr<Lab>& lab = labs[{info.label(), part, images, pages}];
  if (!lab) {
    Device device(info);
    auto kernel = scene_kernel<Buffer<float4>, Buffer<float4>, u32>(
        build_text(device, text_of(part), defines_of(info, part, images, pages)), "shade_points");
    lab = std::make_unique<Lab>(Lab{std::move(device), std::move(kernel)});
  }
  return *lab;
}

/// The points of a scene whose material 0 has textures, images or patterns alone.
inline std::vector<Shaded> shade(const DeviceInfo& info, Part part, const CompiledScene& flat,
                                 std::vector<Point> points) {
  Lab& lab = lab_of(info, part, !flat.texel_levels.empty(), flat.features.texel_pages);
  const DeviceScene tables = upload_scene(lab.device, flat);
  for (Point& point : points) {
    point.p.x -= static_cast<float>(flat.origin.x);
    point.p.y -= static_cast<float>(flat.origin.y);
    point.p.z -= static_cast<float>(flat.origin.z);
  }
  const std::span<const float4> values(reinterpret_cast<const float4*>(points.data()), 4 * points.size());
  const auto in = lab.device.upload<float4>(values);
  const auto out = lab.device.make<float4>(7 * points.size());
  run_scene_kernel<Buffer<float4>, Buffer<float4>, u32>(lab.device, lab.kernel, {.x = points.size()}, tables,
                                                        in, out, static_cast<u32>(points.size()));
  std::vector<Shaded> shaded(points.size());
  lab.device.read(out, std::span(reinterpret_cast<float4*>(shaded.data()), 7 * points.size()));
  return shaded;
}

inline Shaded shade(const DeviceInfo& info, Part part, const SceneDescription& scene, const Point& point) {
  return shade(info, part, compile(scene), {point}).front();
}

}  // namespace surfaces
