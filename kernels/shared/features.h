// The features that a scene may use. Each scene's kernels are built with these definitions, so that only
// needed code is compiled. SceneFeatures and the -D options are generated from this list. A new feature is a
// line here, a line that sets it in host/compile, and kernel code that tests it.
//   FEATURE(type on the host, definition, member of SceneFeatures)
#pragma once

// A table:
// clang-format off
#define SCENE_FEATURES(FEATURE)                                                                         \
  FEATURE(bool, HAS_SECONDARY, secondary_rays)      /* some material reflects or transmits */           \
  FEATURE(bool, HAS_MEDIA, media)                   /* some material has a medium, or the world absorbs */ \
  FEATURE(bool, HAS_TOUCHING, touching)             /* surfaces of solids with media may coincide */    \
  FEATURE(bool, HAS_ABSORPTION, absorption)         /* some medium absorbs */                           \
  FEATURE(bool, HAS_SHADOW_FILTERS, shadow_filters) /* shadow rays pass transmissive objects */         \
  FEATURE(bool, HAS_FRACTIONAL_EXPONENTS, fractional_exponents) /* some highlight has a fractional exponent */ \
  FEATURE(bool, HAS_CLEAR_GLASS, clear_glass)       /* alpha leaves out what smooth glass lets through */ \
  FEATURE(bool, HAS_DISPERSION, dispersion)         /* paths carry wavelengths: some medium disperses */ \
  FEATURE(bool, HAS_SCATTERING, scattering)         /* paths: some medium scatters */                   \
  FEATURE(bool, HAS_GUIDES, guides)                 /* paths are guided to balls that light comes from */ \
  FEATURE(bool, HAS_CAUSTICS, caustics)             /* paths: photons carry light through glass */      \
  FEATURE(bool, HAS_FOG, fog)                       /* the world has fog */                             \
  FEATURE(bool, HAS_GLOW, glow)                     /* some field glows */                              \
  FEATURE(bool, HAS_OCCLUSION, occlusion)           /* some field occludes ambient light in crevices */ \
  FEATURE(bool, HAS_SOFT_SHADOWS, soft_shadows)     /* some field's shadow has a penumbra */            \
  FEATURE(bool, SDF_TWO_SIDED, two_sided_fields)    /* some field transmits: rays may be inside it */   \
  FEATURE(bool, HAS_CHECKER, checker)               /* some material has two colours in a checkerboard */ \
  FEATURE(bool, HAS_UV, surface_coordinates)        /* some material needs surface coordinates */       \
  FEATURE(bool, HAS_FILTER, filter)                 /* samples are not uniform in their pixels */       \
  FEATURE(u32, SAMPLER, sampler)                    /* a SAMPLER_* constant */                          \
  FEATURE(u32, SAMPLE_ROOM, sample_room)            /* of SAMPLER_BLUE_NOISE: log2 of a pixel's samples */ \
  FEATURE(bool, HAS_AREA_LIGHTS, area_lights)       /* there are area lights */                         \
  FEATURE(bool, HAS_ENVIRONMENT, environment)       /* there is an environment light */                 \
  FEATURE(bool, HAS_SKY, sky)                       /* rays that hit nothing see an environment or a sun */ \
  FEATURE(bool, HAS_LIGHT_TREE, light_tree)         /* surfaces sample one of many area lights */       \
  FEATURE(bool, HAS_ROUGH, rough)                   /* some material reflects or transmits roughly */   \
  FEATURE(bool, HAS_ROUGH_GLASS, rough_glass)       /* some dielectric does */                          \
  FEATURE(bool, HAS_THIN_WALLS, thin_walls)         /* some thin wall has an index or is frosted */     \
  FEATURE(bool, HAS_LAYERS, layers)                 /* some material has layers: shared/layers.h */     \
  FEATURE(bool, HAS_LAYER_MAPS, layer_maps)         /* some has a metalness or roughness texture */     \
  FEATURE(bool, HAS_COAT_MAPS, coat_maps)           /* some has a coat weight texture */                \
  FEATURE(bool, HAS_SPECULAR_MAPS, specular_maps)   /* some has a specular texture */                   \
  FEATURE(bool, HAS_FUZZ_MAPS, fuzz_maps)           /* some has a fuzz color texture */                 \
  FEATURE(bool, HAS_LAYER_FILTERS, layer_filters)   /* paths: shadow rays go through fuzz or coats */   \
  FEATURE(bool, HAS_LENS, lens)                     /* the camera has a lens */                         \
  FEATURE(bool, HAS_ORTHOGRAPHIC, orthographic)     /* the camera's rays are parallel */                 \
  FEATURE(bool, HAS_CAMERA_MOTION, camera_motion)   /* the camera moves while the shutter is open */    \
  FEATURE(bool, HAS_OBJECT_MOTION, object_motion)   /* some object does */                              \
  FEATURE(bool, HAS_TURNS, turns)                   /* some object turns or grows meanwhile */          \
  FEATURE(bool, HAS_EMISSION, emission)             /* some material emits light */                     \
  FEATURE(bool, HAS_MAPS, maps)                     /* some material has a texture, emission or opacity */ \
  FEATURE(bool, HAS_RELIEF, relief)                 /* some material has a normal or height map */      \
  FEATURE(bool, HAS_PARALLAX, parallax)             /* some material's heights are below its surface */ \
  FEATURE(bool, HAS_METAL_ROUGH, metal_rough)       /* some material is given by metalness, roughness */ \
  FEATURE(u32, TEXTURE_MAPPINGS, texture_mappings)  /* bit i: some texture has the mapping i */         \
  FEATURE(u32, TEXTURE_KINDS, texture_kinds)        /* bit i: some texture has a node of kind i */      \
  FEATURE(u32, TEXTURE_STACK, texture_stack)        /* maximum stack depth of a texture */              \
  FEATURE(u32, TEXEL_FORMATS, texel_formats)        /* bit i: some image has the format i */            \
  FEATURE(bool, HAS_TEXEL_PAGES, texel_pages)       /* images exceed texels0 */                         \
  FEATURE(u32, EXTRA_UVS, extra_uvs)                /* sets of texture coordinates beside the first */  \
  FEATURE(u32, SDF_FLAGS, field_flags)              /* SdfField.flags that some field has */
// clang-format on
