// What a scene may use. Each scene's kernels are built with these definitions, so that only what it needs is
// compiled. From this list come SceneFeatures and the -D options. A new feature is a line here, the line that
// sets it in host/compile, and the kernel code that asks for it.
//   FEATURE(type on the host, definition, member of SceneFeatures)
#ifndef SUNDOG_SHARED_FEATURES_H
#define SUNDOG_SHARED_FEATURES_H

// A table:
// clang-format off
#define SCENE_FEATURES(FEATURE)                                                                         \
  FEATURE(bool, HAS_SECONDARY, secondary_rays)      /* some material reflects or transmits */           \
  FEATURE(bool, HAS_MEDIA, media)                   /* some material has a medium, or the world absorbs */ \
  FEATURE(bool, HAS_TOUCHING, touching)             /* surfaces of solids with media may lie on others */ \
  FEATURE(bool, HAS_ABSORPTION, absorption)         /* some medium absorbs */                           \
  FEATURE(bool, HAS_SHADOW_FILTERS, shadow_filters) /* shadow rays look through transmissive things */  \
  FEATURE(bool, HAS_FRACTIONAL_EXPONENTS, fractional_exponents) /* some highlight's exponent is no integer */ \
  FEATURE(bool, HAS_DISPERSION, dispersion)         /* paths carry wavelengths: some medium disperses */ \
  FEATURE(bool, HAS_SCATTERING, scattering)         /* paths: some medium scatters */                   \
  FEATURE(bool, HAS_GUIDES, guides)                 /* paths are sent to balls where light comes from */ \
  FEATURE(bool, HAS_CAUSTICS, caustics)             /* paths: photons bring the light behind glass */   \
  FEATURE(bool, HAS_FOG, fog)                       /* the world has fog */                             \
  FEATURE(bool, HAS_GLOW, glow)                     /* some field glows */                              \
  FEATURE(bool, HAS_OCCLUSION, occlusion)           /* some field darkens ambient light in its crevices */ \
  FEATURE(bool, HAS_SOFT_SHADOWS, soft_shadows)     /* some field's shadow has a penumbra */            \
  FEATURE(bool, SDF_TWO_SIDED, two_sided_fields)    /* some field transmits: rays may be inside it */   \
  FEATURE(bool, HAS_CHECKER, checker)               /* some material has two colours in a checkerboard */ \
  FEATURE(bool, HAS_UV, surface_coordinates)        /* some material asks for surface coordinates */    \
  FEATURE(bool, HAS_FILTER, filter)                 /* samples lie elsewhere than evenly in their pixels */ \
  FEATURE(u32, SAMPLER, sampler)                    /* a SAMPLER_* constant */                          \
  FEATURE(u32, SAMPLE_ROOM, sample_room)            /* of SAMPLER_BLUE_NOISE: log2 of a pixel's samples */ \
  FEATURE(bool, HAS_AREA_LIGHTS, area_lights)       /* some light has an extent */                      \
  FEATURE(bool, HAS_ENVIRONMENT, environment)       /* there is light from all around */                \
  FEATURE(bool, HAS_SKY, sky)                       /* rays that meet nothing see an environment or a sun */ \
  FEATURE(bool, HAS_LIGHT_TREE, light_tree)         /* surfaces choose among the lights with an extent */ \
  FEATURE(bool, HAS_ROUGH, rough)                   /* some material reflects or transmits roughly */   \
  FEATURE(bool, HAS_ROUGH_GLASS, rough_glass)       /* some dielectric does */                          \
  FEATURE(bool, HAS_THIN_WALLS, thin_walls)         /* some thin wall has an index or is frosted */     \
  FEATURE(bool, HAS_LAYERS, layers)                 /* some material has layers: shared/layers.h */     \
  FEATURE(bool, HAS_LAYER_MAPS, layer_maps)         /* some has metalness or roughness from a texture */ \
  FEATURE(bool, HAS_COAT_MAPS, coat_maps)           /* some has the weight of its coat from a texture */ \
  FEATURE(bool, HAS_SPECULAR_MAPS, specular_maps)   /* some has what it reflects from a texture */      \
  FEATURE(bool, HAS_FUZZ_MAPS, fuzz_maps)           /* some has the color of its fuzz from one */       \
  FEATURE(bool, HAS_LAYER_FILTERS, layer_filters)   /* paths: shadow rays go through fuzz or coats */   \
  FEATURE(bool, HAS_LENS, lens)                     /* the camera has a lens */                         \
  FEATURE(bool, HAS_CAMERA_MOTION, camera_motion)   /* the camera moves while the shutter is open */    \
  FEATURE(bool, HAS_OBJECT_MOTION, object_motion)   /* some object does */                              \
  FEATURE(bool, HAS_TURNS, turns)                   /* some object turns or grows meanwhile */          \
  FEATURE(bool, HAS_EMISSION, emission)             /* some material shines by itself */                \
  FEATURE(bool, HAS_MAPS, maps)                     /* some material has a texture, emission or opacity */ \
  FEATURE(bool, HAS_RELIEF, relief)                 /* some material has a normal or height map */      \
  FEATURE(bool, HAS_PARALLAX, parallax)             /* some material's heights are below its surface */ \
  FEATURE(bool, HAS_METAL_ROUGH, metal_rough)       /* some material has metalness and roughness of its own */ \
  FEATURE(u32, TEXTURE_MAPPINGS, texture_mappings)  /* bit i: some texture has the mapping i */         \
  FEATURE(u32, TEXTURE_KINDS, texture_kinds)        /* bit i: some texture has a node of kind i */      \
  FEATURE(u32, TEXTURE_STACK, texture_stack)        /* values that a texture keeps at a time, at most */ \
  FEATURE(u32, TEXEL_FORMATS, texel_formats)        /* bit i: some image has the format i */            \
  FEATURE(bool, HAS_TEXEL_PAGES, texel_pages)       /* images take more than texels0 */                 \
  FEATURE(u32, EXTRA_UVS, extra_uvs)                /* sets of texture coordinates beside the first */  \
  FEATURE(u32, SDF_FLAGS, field_flags)              /* SdfField.flags that some field has */
// clang-format on

#endif
