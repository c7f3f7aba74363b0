// The lobes of surfaces, in the order in which a sample's number chooses among them. A lobe is a row here and
// a file of plain/shade/lobes/.
//   LOBE(feature of scenes that have it, name, flags of a Material: one that has the lobe has one of them)
// It defines, for light from wi to wo:
//   share_NAME(scene, bsdf, wo, &lobes)      about the most that it returns: its share of samples
//   sample_NAME(..., lobes, wo, u, &below)   a direction; below: behind the surface
//   scatter_NAME(..., lobes, wo, wi, &sum)   scattering lobes: adds value and density
//   local_NAME(..., wo, wi, met, &light)     local lobes: adds what they return of a lamp, which a reflected
//                                            ray also sees if `met`
//   send_NAME(bsdf, lobes, wo, &part)        perfect lobes: the direction, and the part of light that it gets
//   albedo_NAME(scene, bsdf, lobes, wo)      about what it returns of white surroundings
//   drop_narrow_NAME(&bsdf, &lobes)          scattering lobes: takes away what is too narrow for photons;
//                                            returns whether that is any
//   matte_NAME(lobes)                        matte lobes: the share that is matte
//   drop_matte_NAME(&bsdf, &lobes)           matte lobes: takes that away
#pragma once

// The scene's features that lobes need, as in features.h, which includes these.
// clang-format off
#define LOBE_FEATURES(FEATURE)                                                                          \
  FEATURE(bool, HAS_SECONDARY, secondary_rays, same)    /* some material reflects or transmits */       \
  FEATURE(bool, HAS_ROUGH, rough, same)                 /* some material reflects or transmits roughly */\
  FEATURE(bool, HAS_LAYERS, layers, rounds)             /* some material has layers: shared/layers.h */ \
  FEATURE(bool, HAS_HIGHLIGHTS, highlights, same)       /* some material has a highlight */
// clang-format on

#define PERFECT_LOBES(LOBE)                      \
  LOBE(HAS_SECONDARY, mirror, MATERIAL_REFLECTS) \
  LOBE(HAS_SECONDARY, refraction, MATERIAL_TRANSMITS)

#define SCATTERING_LOBES(LOBE)         \
  LOBE(HAS_ROUGH, ggx, MATERIAL_ROUGH) \
  LOCAL_LOBES(LOBE)

// Those that Whitted's integrator has lamps light.
#define LOCAL_LOBES(LOBE) \
  MATTE_LOBES(LOBE)       \
  LOBE(HAS_HIGHLIGHTS, highlight, MATERIAL_SHINES | MATERIAL_METAL_ROUGH)

// Those that scatter evenly, at least in part: their albedo is the colour of a surface in AOVs, guides aim
// their paths, and their light is the diffuse part.
#define MATTE_LOBES(LOBE)                     \
  LOBE(HAS_LAYERS, layered, MATERIAL_LAYERED) \
  LOBE(HAS_SURFACES, diffuse, ~0u)
