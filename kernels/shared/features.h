// The features that a scene may use. Each scene's kernels are built with these definitions, so that only
// needed code is compiled. SceneFeatures and the -D options are generated from this list. A new feature is a
// line here, a line that sets it in host/compile, and kernel code that tests it.
//   FEATURE(type on the host, definition, member of SceneFeatures, effect on a scene without the feature)
// The effect says which kernels may draw for others (host/render/device/kernel_config.h). Kernels with the
// feature draw a scene without it: `same`: to the same bits (a test renders scenes both ways); `unlayered`:
// so without layers, whose frames surface coordinates rotate, else as `rounds`: up to rounding; `mask`: up to
// rounding, one bit for each kind; `room`: to the same bits, with room for more; `alters`: not.
#pragma once
#include "shared/lobes.h"

// A table:
// clang-format off
#define SCENE_FEATURES(FEATURE)                                                                                   \
  LOBE_FEATURES(FEATURE)                                                                                          \
  FEATURE(bool, HAS_MEDIA, media, same)                 /* some material has a medium, or the world absorbs */    \
  FEATURE(bool, HAS_TOUCHING, touching, same)           /* surfaces of solids with media may coincide */          \
  FEATURE(bool, HAS_SIDES, near_fields, same)           /* some field shows both walls: rays remember their side */ \
  FEATURE(bool, HAS_ABSORPTION, absorption, same)       /* some medium absorbs */                                 \
  FEATURE(bool, HAS_SHADOW_FILTERS, shadow_filters, same) /* shadow rays pass transmissive objects */             \
  FEATURE(bool, HAS_FRACTIONAL_EXPONENTS, fractional_exponents, same) /* some exponent is fractional */           \
  FEATURE(bool, HAS_CLEAR_GLASS, clear_glass, alters)   /* alpha leaves out what smooth glass lets through */     \
  FEATURE(bool, HAS_DISPERSION, dispersion, alters)     /* paths carry wavelengths: some medium disperses */      \
  FEATURE(bool, HAS_SCATTERING, scattering, alters)     /* paths: some medium scatters */                         \
  FEATURE(bool, HAS_GUIDES, guides, alters)             /* paths are guided to balls that light comes from */     \
  FEATURE(bool, HAS_CAUSTICS, caustics, alters)         /* paths: photons carry light through glass */            \
  FEATURE(bool, HAS_FOG, fog, alters)                   /* the world has fog */                                   \
  FEATURE(bool, HAS_GLOW, glow, same)                   /* some field glows */                                    \
  FEATURE(bool, HAS_OCCLUSION, occlusion, same)         /* some field occludes ambient light in crevices */       \
  FEATURE(bool, HAS_SOFT_SHADOWS, soft_shadows, same)   /* some field's shadow has a penumbra */                  \
  FEATURE(bool, SDF_TWO_SIDED, two_sided_fields, same)  /* rays may be inside some field, or pass it */           \
  FEATURE(bool, HAS_CHECKER, checker, rounds)           /* some material has two colours in a checkerboard */     \
  FEATURE(bool, HAS_UV, surface_coordinates, unlayered) /* some material needs surface coordinates */             \
  FEATURE(bool, HAS_FILTER, filter, alters)             /* samples are not uniform in their pixels */             \
  FEATURE(u32, SAMPLER, sampler, alters)                /* a SAMPLER_* constant */                                \
  FEATURE(u32, SAMPLE_ROOM, sample_room, alters)        /* of SAMPLER_BLUE_NOISE: log2 of a pixel's samples */    \
  FEATURE(bool, HAS_AREA_LIGHTS, area_lights, same)     /* there are area lights */                               \
  FEATURE(bool, HAS_ENVIRONMENT, environment, same)     /* there is an environment light */                       \
  FEATURE(bool, HAS_SKY, sky, same)                     /* rays that hit nothing see an environment or a sun */   \
  FEATURE(bool, HAS_LIGHT_TREE, light_tree, same)       /* surfaces sample one of many area lights */             \
  FEATURE(bool, HAS_ROUGH_GLASS, rough_glass, rounds)   /* some dielectric does */                                \
  FEATURE(bool, HAS_THIN_WALLS, thin_walls, rounds)     /* some thin wall has an index or is frosted */           \
  FEATURE(bool, HAS_LAYER_MAPS, layer_maps, rounds)     /* some has a metalness or roughness texture */           \
  FEATURE(bool, HAS_COAT_MAPS, coat_maps, rounds)       /* some has a coat weight texture */                      \
  FEATURE(bool, HAS_SPECULAR_MAPS, specular_maps, rounds) /* some has a specular texture */                       \
  FEATURE(bool, HAS_FUZZ_MAPS, fuzz_maps, rounds)       /* some has a fuzz color texture */                       \
  FEATURE(bool, HAS_LAYER_FILTERS, layer_filters, rounds) /* shadow rays go through fuzz or coats */              \
  FEATURE(bool, HAS_LENS, lens, alters)                 /* the camera has a lens */                               \
  FEATURE(bool, HAS_ORTHOGRAPHIC, orthographic, alters) /* the camera's rays are parallel */                      \
  FEATURE(bool, HAS_CAMERA_MOTION, camera_motion, rounds) /* the camera moves while the shutter is open */        \
  FEATURE(bool, HAS_OBJECT_MOTION, object_motion, alters) /* some object does */                                  \
  FEATURE(bool, HAS_TURNS, turns, alters)               /* some object turns or grows meanwhile */                \
  FEATURE(bool, HAS_EMISSION, emission, same)           /* some material emits light */                           \
  FEATURE(bool, HAS_CATCHERS, catchers, same)           /* paths: some material shows its shadows alone */        \
  FEATURE(bool, HAS_MAPS, maps, rounds)                 /* some material has a texture, emission or opacity */    \
  FEATURE(bool, HAS_RELIEF, relief, rounds)             /* some material has a normal or height map */            \
  FEATURE(bool, HAS_PARALLAX, parallax, rounds)         /* some material's heights are below its surface */       \
  FEATURE(bool, HAS_METAL_ROUGH, metal_rough, same)     /* some material is given by metalness, roughness */      \
  FEATURE(u32, TEXTURE_MAPPINGS, texture_mappings, mask) /* bit i: some texture has the mapping i */              \
  FEATURE(u32, TEXTURE_KINDS, texture_kinds, mask)      /* bit i: some texture has a node of kind i */            \
  FEATURE(u32, MAP_SLOTS_USED, map_slots, mask)         /* bit i: some material has a texture in slot i */        \
  FEATURE(u32, TEXTURE_STACK, texture_stack, room)      /* maximum stack depth of a texture */                    \
  FEATURE(u32, TEXEL_FORMATS, texel_formats, mask)      /* bit i: some image has the format i */                  \
  FEATURE(bool, HAS_TEXEL_PAGES, texel_pages, rounds)   /* images exceed texels0 */                               \
  FEATURE(u32, EXTRA_UVS, extra_uvs, alters)            /* sets of texture coordinates beside the first */        \
  FEATURE(u32, SDF_FLAGS, field_flags, mask)            /* SdfField.flags that some field has */
// clang-format on
