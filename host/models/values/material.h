// Materials and media, as a scene file or a model describes them.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "models/values/openpbr.h"
#include "models/values/refraction.h"
#include "models/values/textures.h"

namespace sundog {

using glm::dvec3;

struct MediumDescription {
  std::string name;
  double ior = 1;             // at the d line
  dvec3 absorption{0, 0, 0};  // per unit of world length
  int priority = 0;
  Dispersion dispersion{};    // path: index of refraction by wavelength
  dvec3 scattering{0, 0, 0};  // per unit of world length; whitted treats it as absorption
  double anisotropy = 0;      // path: mean cosine of the scattering angle
};

enum class MaterialType { phong, dielectric };

/// Phong coefficients ka, kd, ks in [0, inf), kr and kt in [0, 1], each times a colour.
struct MaterialDescription {
  std::string name;
  MaterialType type = MaterialType::phong;
  dvec3 ambient{0.1}, diffuse{0.8}, specular{0};  // colour times coefficient
  double exponent = 32;
  bool blinn = false;
  dvec3 emission{0};                     // radiance emitted to the outside
  dvec3 reflection{0}, transmission{0};  // tints of a dielectric default to 1 (set by the loader)
  double roughness = 0;                  // of what reflects and transmits, by the GGX distribution
  bool multiple_scattering = true;       // compensate for light lost between facets of a rough surface
  int medium = -1;      // index into media of the inside; -1: thin, transmits without bending
  double wall_ior = 0;  // above 0, with medium -1: dielectric thin wall of this index
  bool shadow_opaque = false;
  bool shadow_filter = false;  // path: shadow rays pass straight through a refracting interface
  bool checker = false;
  bool off_camera = false;                       // a lamp that camera rays pass through
  dvec3 checker_ambient{0}, checker_diffuse{0};  // ka and kd in odd cells: colour times coefficient
  double checker_size = 1;                       // edge of a cell, object space
  bool vertex_color = false;
  double opacity = 1;           // [0, 1]; the rest shows what lies behind; 1 with a medium
  double cutoff = 0;            // above 0: alpha test, opacity becomes 0 below it and 1 from there on
  bool one_sided = false;       // invisible from behind
  bool shadow_catcher = false;  // path: the camera sees through it, darker by its shadows
  MaterialTextures textures{};  // factors on the values above
  std::optional<MetalRough> metal_rough{};  // replaces ambient, diffuse, specular and reflection
  double normal_scale = 1;                  // factor on the slopes of a normal map
  double bump = 1;                          // height of texture value 1, object space
  double bump_uv = 0;                       // likewise, in units of u and v; added
  double parallax = 0;                      // depth of height 0 below height 1, object space; 0: none
  int displaced_by = -1;                    // index into textures: height map that displaces meshes' vertices
  double displacement = 1;                  // for height 1, object space
  double displacement_middle = 0;           // height that leaves vertices in place
  double displacement_edge = 0;             // edge length of the triangles, object space; 0: about a texel
  double occlusion = 1;                     // strength of the occlusion texture, [0, 1]
  double coat = 0;                          // reflectance of a clear layer on top, [0, 1], times its texture
  std::string group{};                      // light group of its emission; empty: none
  std::optional<OpenPbr> layers{};          // layers over these terms, and their base: set_openpbr()
};

}  // namespace sundog
