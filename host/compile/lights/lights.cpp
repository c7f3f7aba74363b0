// Compiles the lights of the scene file, the environment and its sun, and the halo.
#include "compile/lights/lights.h"

#include <fmt/format.h>

#include "compile/halo/halo_map.h"
#include "compile/lights/environment.h"
#include "scene/kinds.h"
#include "scene/lamps.h"
#include "scene/pack.h"

namespace sundog {
namespace {

/// Fills the lights of the scene file and the ambient light.
void add_lights(const LightInputs& in, Lights& out) {
  dvec3 ambient(0);
  for (std::size_t i = 0; i < in.lights.size(); ++i) {
    const LightDescription& light = in.lights[i];
    if (light.type == LightType::ambient)
      ambient += light.color * light.intensity;
    else
      add_light(in, light, fmt::format("/lights/{}", i), out);
  }
  out.ambient = pack(ambient);
}

}  // namespace

Halo compile_halo(const HaloInputs& in) {
  const EnvironmentDescription& e = *in.environment;
  if (e.type != EnvironmentType::halo) return nullptr;
  return e.halo_map ? e.halo_map : std::make_shared<const HaloMap>(trace_halo(plan_halo(e)));
}

LightInputs light_inputs(const SceneDescription& scene, const dvec3& origin, const Known<Halo>& halo) {
  LightInputs in{.file = file_of(scene),
                 .origin = origin,
                 .lights = scene.lights,
                 .environment = &scene.environment,
                 .halo = halo};
  if (!fog_scatters(scene)) in.fog_color = scene.fog.color, in.fog_density = scene.fog.density;
  return in;
}

Lights compile_lights(const LightInputs& in) {
  Lights lights;
  add_lights(in, lights);
  add_environment(in, lights);
  lights.fog = pack(in.fog_color, in.fog_density);
  lights.features.fog = in.fog_density > 0;
  return lights;
}

void add_light(const LightInputs& in, const LightDescription& light, const std::string& place, Lights& out) {
  const Light packed = pack_light({*in.file, light, place}, in.origin);
  const bool extent = facts_of(light.type).has_extent() || packed.kind == LIGHT_SUN;
  const auto index = static_cast<u32>(out.lights.size()), rays = extent ? static_cast<u32>(light.samples) : 1;
  for (u32 ray = 0; ray < rays; ++ray) out.light_rays.push_back({index, ray, rays, 0});
  out.lights.push_back(packed);
  out.features.area_lights |= extent;
  out.features.sky |= packed.kind == LIGHT_SUN && !light.hidden;
}

}  // namespace sundog
