// Perfect reflection and transmission (Whitted 1980). wo points to the viewer.
#include "plain/shade/bsdf.h"

// A surface's interface: how it divides light between the two.
typedef struct Interface {
  float3 kr, kt;
  bool branches, transmits;  // has either; transmits
  float eta, cos_i, cos_t;   // index behind over index before; cosines to ns, 1 if nothing bends
  float f;                   // Fresnel reflectance of a dielectric, else 0
} Interface;

static inline float3 reflection_of(const Bsdf* bsdf, UNIFORM __global const Material* material) {
  if (HAS_MAPS) return bsdf->reflection;
  return material->reflection.xyz;
}
static inline float3 transmission_of(const Bsdf* bsdf, UNIFORM __global const Material* material) {
  if (HAS_MAPS) return bsdf->transmission;
  return material->transmission.xyz;
}

// The relative index, behind over before, at the wavelength that decides the ray's direction.
static inline float index_across(UNIFORM const Scene* scene, const Bsdf* bsdf) {
  if (HAS_DISPERSION)
    return relative_index_at(scene, bsdf->before, bsdf->after, bsdf->row);
  else
    return relative_index(scene->media, bsdf->before, bsdf->after);
}

// Reflectance of both faces of a thin wall at the cosine c: 2 R / (1 + R), the sum of all reflections between
// them, with the reflectance R of one face (Stokes 1862, "On the Intensity of the Light Reflected from or
// Transmitted through a Pile of Plates", without polarisation).
static inline float wall_reflectance(float c, float index) {
  const float r = fresnel_reflectance(c, refracted_cosine(c, index), index);
  return 2.0f * r / (1.0f + r);
}

static inline bool is_wall(int flags) {
  return (flags & (int)(MATERIAL_THIN | MATERIAL_WALL)) == (int)(MATERIAL_THIN | MATERIAL_WALL);
}

// The reflectance of such a wall; `f` for other surfaces.
static inline float reflected_by_walls(UNIFORM const Scene* scene, int material, int flags, float c,
                                       float f) {
  float reflected = f;
  if (HAS_THIN_WALLS && is_wall(flags)) EACH_ALIKE(int, index, material)
  reflected = wall_reflectance(c, scene->materials[index].transmission.w);
  return reflected;
}

ENTRY static inline Interface make_interface(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo) {
  Interface interface = {(float3)(0.0f), (float3)(0.0f), false, false, 1.0f, 1.0f, 1.0f, 0.0f};
  bool dielectric = false;
  interface.branches = (bsdf->flags & (int)(MATERIAL_REFLECTS | MATERIAL_TRANSMITS)) != 0;
  interface.transmits = interface.branches && (bsdf->flags & (int)MATERIAL_TRANSMITS) != 0;
  if (interface.branches) EACH_ALIKE(int, index, bsdf->material) {
      __global const Material* material = scene->materials + index;
      interface.kr = reflection_of(bsdf, material);
      interface.kt = transmission_of(bsdf, material);
      dielectric = material->kind == MATERIAL_DIELECTRIC;
    }
  if (!(interface.transmits || dielectric)) return interface;
  const bool bends = interface.transmits && (bsdf->flags & (int)MATERIAL_THIN) == 0;
  interface.cos_i = real_clamp(dot(bsdf->ns, wo), 0.0f, 1.0f);
  if (bends) interface.eta = index_across(scene, bsdf);
  interface.cos_t = refracted_cosine(interface.cos_i, interface.eta);
  const float bent = bends ? fresnel_reflectance(interface.cos_i, interface.cos_t, interface.eta) : 0.0f;
  const float f = reflected_by_walls(scene, bsdf->material, bsdf->flags, interface.cos_i, bent);
  if (dielectric) {
    interface.f = f;
    interface.kr = interface.kr * f;
    interface.kt = interface.kt * (1.0f - f);
  } else if (interface.transmits && interface.cos_t <= 0.0f) {  // all is reflected
    interface.kr = interface.kr + interface.kt;
    interface.kt = (float3)(0.0f);
  }
  return interface;
}

static inline bool has_highlight(const Bsdf* bsdf) {
  if (!HAS_HIGHLIGHTS) return false;
  if (HAS_MAPS) return greatest(bsdf->specular) > 0.0f;
  return (bsdf->flags & (int)MATERIAL_SHINES) != 0;
}

// Whether the surface is absent, because its material is cut away or seen from its missing side: light goes
// straight on. Rays pass as many of them as unseen interfaces. Frosted walls that transmit all turn it.
ENTRY static inline bool cut_away(const Bsdf* bsdf, const Interface* interface) {
  if (HAS_SHADOW_FILTERS) {
    const float3 rest = interface->kr + bsdf->diffuse;
    const int kind = bsdf->flags & (int)(MATERIAL_THIN | MATERIAL_FROSTED);
    return interface->transmits && kind == (int)MATERIAL_THIN && interface->kt.x == 1.0f &&
           interface->kt.y == 1.0f && interface->kt.z == 1.0f && rest.x + rest.y + rest.z == 0.0f &&
           !has_highlight(bsdf);
  }
  return false;
}

// Direction of perfect reflection; a shading normal must not send it inside.
static inline float3 reflected_direction(const Bsdf* bsdf, float3 wo) {
  const float3 by_shading = reflect_direction(-wo, bsdf->ns);
  return dot(by_shading, bsdf->side) > 0.0f ? by_shading : reflect_direction(-wo, bsdf->side);
}

// Direction of transmission; a shading normal must not send it outside again.
ENTRY static inline float3 transmitted_direction(const Bsdf* bsdf, const Interface* interface, float3 wo) {
  const float3 d = -wo;
  const float3 by_shading =
      refract_direction(d, bsdf->ns, interface->cos_i, interface->cos_t, interface->eta);
  const float cos_g = real_clamp(dot(bsdf->side, wo), 0.0f, 1.0f);
  const float3 by_face =
      refract_direction(d, bsdf->side, cos_g, refracted_cosine(cos_g, interface->eta), interface->eta);
  const float3 bent = dot(by_shading, bsdf->side) < 0.0f ? by_shading : by_face;
  return interface->eta == 1.0f ? d : bent;
}
