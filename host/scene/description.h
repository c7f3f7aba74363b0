// SceneDescription: the scene file's content as plain values, with names resolved to indices. The loaders in
// this folder create it; compile() reads it.
#pragma once
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/image.h"
#include "base/tone_map.h"
#include "scene/formula/sdf.h"
#include "scene/halo.h"
#include "scene/materials/openpbr.h"
#include "scene/mesh_array.h"
#include "scene/spectra/refraction.h"
#include "scene/texture_description.h"
#include "shared/lights.h"
#include "shared/sampler.h"
#include "shared/scene.h"
#include "shared/shapes.h"

namespace sundog {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

/// Position and target of a camera.
struct View {
  dvec3 position{0, 0, 5}, target{0, 0, 0};
};

/// A thin lens; only points at depth `focus` along the view are sharp.
struct Lens {
  double radius = 0;            // 0: a pinhole
  std::optional<double> focus;  // none: the target's distance
  int blades = 0;               // of the aperture, 3..16; 0: round
  double rotate = 0;            // rotation of the blades, degrees
};

/// A pinhole camera unless its lens has a radius. `fov` is the vertical angle of view in degrees, (0, 180).
/// near/far clip by depth along the view.
struct Camera {
  dvec3 position{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};
  double fov = 45;
  double near = 0, far = std::numeric_limits<double>::infinity();
  Lens lens;
  std::optional<View> moves_to;  // position and target when the shutter closes; linear in between
  double shutter = 0;            // of a film: the part of a frame for which it is open
};

struct ImageSettings {
  int width = 640, height = 480;
  dvec3 background_bottom{0, 0, 0}, background_top{0, 0, 0};  // equal: one colour
  bool transparent = false;        // what is behind the scene is left out of the colours
  bool transparent_glass = false;  // alpha counts what is behind smooth glass as behind the scene
  ToneMap tone_map;                // for files of 8 bits a channel; no part of the compiled scene
};

enum class Tracer { automatic, wide, compact };

/// How samples are distributed over the pixels.
struct Sampling {
  double threshold = 0;    // above 0: adaptive; a pixel gets samples until its estimated error is below it
  int first_samples = 1;   // adaptive: initial samples per pixel
  bool surfaces = false;   // adaptive: more samples for neighbours that show different surfaces or colours
  double contrast = 4;     // adaptive: colours that differ by this many thresholds count as different
  double budget = 0;       // adaptive: mean samples per pixel; 0: no limit
  bool subsample = false;  // render every second pixel each way; interpolate the others where possible
  double subsample_contrast = 0.1;  // colour difference above which pixels are not interpolated
  bool progressive = false;         // samples double pass by pass: 1, 2, 4...
};

/// A sphere that light comes from; matte surfaces send some paths towards it.
struct Guide {
  dvec3 center{0};
  double radius = 1;
};

enum class Filter { box, tent, gaussian, blackman_harris, mitchell };

struct RenderSettings {
  int max_depth = 8;      // 1..64 (paths: 1..65536); 1: camera rays only
  int samples = 1;        // per pixel, 1..65536; 1 = the pixel's centre
  int light_samples = 0;  // shadow rays from each surface to random area lights, 0..1024; 0: to each light
  double cutoff = 1e-3;   // throughput below which a ray ends, [0, 1]
  double max_component = std::numeric_limits<double>::infinity();  // of a sample's light, above 0
  std::string integrator = "whitted";
  int roulette = 2;                   // path: depth at which Russian roulette starts, 1..65; 65: never
  u32 light_strategy = STRATEGY_MIS;  // path: a STRATEGY_* constant
  std::vector<Guide> guides;          // path
  bool caustics = false;              // path: photon mapping of light through glass and mirrors
  int photons = 65536;                // emitted per photon map, 64..4194304
  double photon_radius = 0;           // of the first map; 0: chosen for the scene
  u32 sampler = SAMPLER_AUTO;         // a SAMPLER_* constant
  int seed = 0;                       // changes the noise
  Filter filter = Filter::box;
  double filter_radius = 0;  // in pixels; 0: the filter's default
  Sampling sampling;
  Tracer tracer = Tracer::automatic;
  int texture_memory = 1024;    // MiB for images on a device, 1..65536
  bool spatial_splits = false;  // split triangles in the BVH build: slower, better for long thin ones
};

#define SUNDOG_LIGHT_TYPE(constant, name, placed, aimed, extent) name,
enum class LightType { ambient, LIGHTS(SUNDOG_LIGHT_TYPE) };
#undef SUNDOG_LIGHT_TYPE

/// A light; members are the keys in LIGHT_KEYS (shared/lights.h).
struct LightDescription {
  LightType type = LightType::point;
#define SUNDOG_LIGHT_MEMBER(type, name, ...) type name __VA_ARGS__;
  LIGHT_KEYS(SUNDOG_LIGHT_MEMBER)
#undef SUNDOG_LIGHT_MEMBER
};

enum class EnvironmentType { none, image, gradient, sky, halo };

/// Light from infinity. Radiance is color times intensity times the type's own radiance.
struct EnvironmentDescription {
  EnvironmentType type = EnvironmentType::none;
  dvec3 color{1};
  double intensity = 1;
  dvec3 up{0, 1, 0};
  double rotate = 0;          // degrees about `up`
  int samples = 1;            // shadow rays from each surface to it, and as many to its sun
  bool visible = true;        // whether camera rays that hit nothing show it; other rays do
  bool hidden = false;        // no ray shows it
  Image picture;              // image: equirectangular, zenith in row 0
  dvec3 bottom{0.3}, top{1};  // gradient: linear in the sine of the elevation
  // Sky, and halo, which is a sky with ice crystals:
  double sun_altitude = 40, sun_azimuth = 60;  // degrees: [0, 90], and clockwise from ahead
  double sun_size = 0.53;                      // angular diameter in degrees; 0: no sun
  double turbidity = 3;                        // 2 very clear .. 10 hazy
  dvec3 ground{0.2};                           // albedo of the ground
  HaloDescription halo;
  /// The halo as traced on a device; if null, compile() traces it on the host, to the same bits.
  std::shared_ptr<const HaloMap> halo_map;
};

/// Below the priority of every medium in a scene file (-1000..1000), so that any solid displaces the world's
/// medium.
inline constexpr int world_priority = -1'000'000;

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
  double roughness = 0;                  // of reflection and transmission, [0, 1]; GGX alpha is its square
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
  MaterialTextures textures{};  // factors on the values above
  std::optional<MetalRough> metal_rough{};  // replaces ambient, diffuse, specular and reflection
  double normal_scale = 1;                  // factor on the slopes of a normal map
  double bump = 1;                          // height of a 1 of the height texture, object space
  double bump_uv = 0;                       // likewise, in units of u and v; added
  double parallax = 0;                      // depth of height 0 below height 1, object space; 0: none
  int displaced_by = -1;                    // index into textures: height map that displaces meshes' vertices
  double displacement = 1;                  // for height 1, object space
  double displacement_middle = 0;           // height that leaves vertices in place
  double displacement_edge = 0;             // edge length of the triangles, object space; 0: about a texel
  double occlusion = 1;                     // strength of the occlusion texture, [0, 1]
  double coat = 0;                          // reflectance of a clear layer on top, [0, 1], times its texture
  std::optional<OpenPbr> layers{};          // layers over these terms, and their base: set_openpbr()
  /// The variant for path tracing, if it differs: surface_for().
  std::shared_ptr<const MaterialDescription> by_paths{};
};

/// Triangles with shared vertices. `normals` (empty: flat shading), `uvs`, `tangents`, `colors` and `alphas`
/// are empty or as long as `positions`; colours are linear.
struct Mesh {
  std::string name;
  MeshArray<glm::vec3> positions;
  MeshArray<glm::vec3> normals;
  MeshArray<glm::vec2> uvs;                       // v up
  std::vector<MeshArray<glm::vec2>> further_uvs;  // sets 1, 2, ..., each empty or one per vertex
  MeshArray<glm::vec4> tangents;  // along u; w: sign of the bitangent. Empty: compile() computes them
  MeshArray<glm::vec3> colors;
  MeshArray<float> alphas;  // alpha of the colours, for TEXTURE_VERTEX_COLOR; empty: 1
  MeshArray<glm::uvec3> triangles;
  std::vector<int> materials;  // per triangle, index into SceneDescription::materials; empty: the object's
  std::size_t source_vertex_count = 0;  // in the file, before vertices are split or dropped
};

struct MeshShape {
  int mesh = 0;
};  // index into meshes
struct FieldShape {
  int field = 0;
};  // index into fields

// The exact solids of shared/shapes.h. half_size(): of the bounding box about the origin; open(): has no
// inside.
struct PlaneShape {  // y = 0, normal +y, inside below
  bool open() const { return false; }
};
struct SphereShape {
  double radius = 1;
  dvec3 half_size() const { return dvec3(radius); }
  bool open() const { return false; }
};
struct BoxShape {
  dvec3 half{1, 1, 1};
  dvec3 half_size() const { return half; }
  bool open() const { return false; }
};
struct CylinderShape {  // about y, centred
  double radius = 1, half_height = 1;
  bool capped = true;
  dvec3 half_size() const { return {radius, half_height, radius}; }
  bool open() const { return !capped; }
};
struct ConeShape {
  double bottom_radius = 1, top_radius = 0, half_height = 1;
  bool capped = true;
  dvec3 half_size() const {
    const double radius = bottom_radius > top_radius ? bottom_radius : top_radius;
    return {radius, half_height, radius};
  }
  bool open() const { return !capped; }
};
struct DiskShape {  // in y = 0
  double radius = 1, inner_radius = 0;
  dvec3 half_size() const { return {radius, 0, radius}; }
  bool open() const { return true; }
};
struct RectangleShape {  // in y = 0; half sizes along x and z
  dvec2 half{1, 1};
  dvec3 half_size() const { return {half.x, 0, half.y}; }
  bool open() const { return true; }
};
struct TorusShape {  // about y
  double major_radius = 1, minor_radius = 0.25;
  dvec3 half_size() const { return {major_radius + minor_radius, minor_radius, major_radius + minor_radius}; }
  bool open() const { return false; }
};
struct RoundBoxShape {  // outer half sizes, edge radius
  dvec3 half{1, 1, 1};
  double radius = 0.1;
  dvec3 half_size() const { return half; }
  bool open() const { return false; }
};

#define SUNDOG_SHAPE_TYPE(constant, type, name) type##Shape,
/// Alternatives are in the order of the SHAPE_* constants.
using Shape = std::variant<MeshShape, SOLIDS(SUNDOG_SHAPE_TYPE) FieldShape>;
#undef SUNDOG_SHAPE_TYPE
static_assert(std::variant_size_v<Shape> == SHAPE_COUNT);

/// A rotation about a point and scaling from it while the shutter is open, in the parent's space `frame`.
struct TurnDescription {
  glm::dmat3 frame{1};  // parent to world
  dvec3 axis{0, 1, 0};  // in the parent's space
  double degrees = 0;
  dvec3 about{0};     // in world space, before any motion
  double growth = 1;  // scale factor when the shutter closes
  dvec3 moves_by{0};  // translation within this turn, as in Object
};

/// A placed shape. Groups are flattened: the transform is the product of the groups' and the object's.
struct Object {
  std::string name;
  Shape shape = SphereShape{};
  int material = -1;  // -1: the mesh's own materials
  dmat4 world_from_object{1};
  std::string place;                     // JSON pointer, for messages
  int light = -1;                        // index of the area light that it shows; -1: none
  dvec3 moves_by{0};                     // translation while the shutter is open, linear
  std::vector<TurnDescription> turns{};  // applied before moves_by; the outermost group's first
  bool moves() const { return moves_by != dvec3(0) || !turns.empty(); }
};

/// Fog: over a distance d, a fraction exp(-density d) of the light passes; fog color replaces the rest. Only
/// in the world's medium.
struct FogDescription {
  dvec3 color{0};
  double density = 0;                // per unit of world length
  std::optional<double> anisotropy;  // path: the fog is a medium with scattering albedo `color`
};

struct SceneDescription {
  std::filesystem::path file;
  Camera camera;
  ImageSettings image;
  RenderSettings render;
  FogDescription fog;
  EnvironmentDescription environment;
  std::vector<LightDescription> lights;
  std::vector<MediumDescription> media;  // [0] is the world's, with world_priority
  std::vector<ImageDescription> images;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<Mesh> meshes;
  std::vector<SdfDescription> fields;
  std::vector<Object> objects;
  std::vector<std::string> warnings;  // one line each: features of model files that were ignored
  double unit = 0.1;                  // of length, in metres
  double frames_per_second = 24;
  bool plays = false;  // a part changes with the frame by itself: a model's animation
};

}  // namespace sundog
