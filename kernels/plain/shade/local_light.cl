// Light of lamps that surfaces return other than by perfect reflection and transmission, for which Whitted's
// integrator sends rays.
#include "plain/shade/facets.cl"
#include "plain/shade/lobes/"

// pi times the BSDF times the cosine of the local lobes, in the classical units where a white surface that
// faces a light of intensity 1 has radiance 1. For n.l > 0.
static inline float3 local_light(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, float3 wi,
                                 bool met) {
  float3 light = (float3)(0.0f);
#define ADD_LOCAL(feature, name, flags) \
  if (feature) local_##name(scene, bsdf, wo, wi, met, &light);
  LOCAL_LOBES(ADD_LOCAL)
  return light;
}

// Adds the layers' share that a reflected ray stands for, and attenuates the interface below them.
static inline void mirror_layers(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo,
                                 Interface* interface) {
  if (HAS_LAYERS && is_layered(bsdf)) EACH_ALIKE(int, index, bsdf->material) {
      __global const Layers* m = scene->layers + index;
      const float c = dot(bsdf->ns, wo);
      cover_interface(scene, m, bsdf, c, interface);
      interface->kr = along(interface->kr, bsdf->there, mirrored_by_layers(scene, m, bsdf, c));
    }
}
