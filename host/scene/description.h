// SceneDescription: the scene as plain values, exactly what the file says after names are resolved to
// indices. The loaders of this folder make it; compile() reads it.
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

/// Where a camera is and looks.
struct View {
  dvec3 position{0, 0, 5}, target{0, 0, 0};
};

/// A thin lens: what lies at the depth `focus` along the view is sharp.
struct Lens {
  double radius = 0;            // 0: a pinhole
  std::optional<double> focus;  // without it the target's distance
  int blades = 0;               // of the aperture, 3..16; 0: round
  double rotate = 0;            // of the blades, degrees
};

/// A pinhole camera unless its lens has a radius. `fov` is the vertical angle of view in degrees, (0, 180).
/// near/far clip by depth along the view.
struct Camera {
  dvec3 position{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};
  double fov = 45;
  double near = 0, far = std::numeric_limits<double>::infinity();
  Lens lens;
  std::optional<View> moves_to;  // where it is when the shutter closes; between, it moves straight on
};

struct ImageSettings {
  int width = 640, height = 480;
  dvec3 background_bottom{0, 0, 0}, background_top{0, 0, 0};  // equal: one colour
  bool transparent = false;  // what is behind the scene is left out of the colours
  ToneMap tone_map;          // for files of 8 bits a channel; no part of the compiled scene
};

enum class Tracer { automatic, wide, compact };

/// How samples are shared out among the pixels.
struct Sampling {
  double threshold = 0;    // above 0: a pixel gets samples until its estimated error is below it (adaptive)
  int first_samples = 1;   // adaptive: that each pixel gets
  bool surfaces = false;   // adaptive: neighbours that show different surfaces or colours get more samples
  double contrast = 4;     // adaptive: by so many thresholds colours differ then
  double budget = 0;       // adaptive: samples a pixel in the mean; 0: no limit
  bool subsample = false;  // every second pixel each way gets samples, the others where they must
  double subsample_contrast = 0.1;  // difference of colours between which is not interpolated
  bool progressive = false;         // samples double pass by pass: 1, 2, 4...
};

/// A ball that matte surfaces send paths to, because light comes from there.
struct Guide {
  dvec3 center{0};
  double radius = 1;
};

enum class Filter { box, tent, gaussian, blackman_harris, mitchell };

struct RenderSettings {
  int max_depth = 8;  // 1..64, with paths 1..65536; 1 = the camera's rays alone
  int samples = 1;    // per pixel, 1..65536; 1 = the pixel's centre
  int light_samples =
      0;                 // rays to lights with an extent that each surface chooses, 0..1024; 0: to each light
  double cutoff = 1e-3;  // throughput below which a ray ends, [0, 1]
  std::string integrator = "whitted";
  int roulette = 2;                   // path: ray from which on paths end by chance, 1..65; 65: none
  u32 light_strategy = STRATEGY_MIS;  // path: a STRATEGY_* constant
  std::vector<Guide> guides;          // path
  bool caustics = false;              // path: photons bring the light behind glass and mirrors
  int photons = 65536;                // sent out for each map of them, 64..4194304
  double photon_radius = 0;           // of the first map; 0: chosen by the scene
  u32 sampler = SAMPLER_AUTO;         // a SAMPLER_* constant
  int seed = 0;                       // of the samples; another one has other noise
  Filter filter = Filter::box;
  double filter_radius = 0;  // in pixels; 0: the filter's own
  Sampling sampling;
  Tracer tracer = Tracer::automatic;
  int texture_memory = 1024;    // MiB that images may take on a device, 1..65536
  bool spatial_splits = false;  // build the BVH with cut triangles: slower, better for long thin ones
};

#define SUNDOG_LIGHT_TYPE(constant, name, placed, aimed, extent) name,
enum class LightType { ambient, LIGHTS(SUNDOG_LIGHT_TYPE) };
#undef SUNDOG_LIGHT_TYPE

/// What the keys of LIGHT_KEYS say (shared/lights.h).
struct LightDescription {
  LightType type = LightType::point;
#define SUNDOG_LIGHT_MEMBER(type, name, ...) type name __VA_ARGS__;
  LIGHT_KEYS(SUNDOG_LIGHT_MEMBER)
#undef SUNDOG_LIGHT_MEMBER
};

enum class EnvironmentType { none, image, gradient, sky, halo };

/// Light from all around, infinitely far away. Radiance is colour times intensity times that of the type.
struct EnvironmentDescription {
  EnvironmentType type = EnvironmentType::none;
  dvec3 color{1};
  double intensity = 1;
  dvec3 up{0, 1, 0};
  double rotate = 0;          // degrees about `up`
  int samples = 1;            // shadow rays that a surface sends to it, and as many to its sun
  bool visible = true;        // the camera's rays that meet nothing see it, where others do
  bool hidden = false;        // no ray sees it
  Image picture;              // image: equirectangular, the sky's top in row 0
  dvec3 bottom{0.3}, top{1};  // gradient: linear in the elevation's sine
  // Sky and halo, which is a sky with ice crystals in it:
  double sun_altitude = 40, sun_azimuth = 60;  // degrees, [0, 90], and from ahead to the right
  double sun_size = 0.53;                      // degrees across; 0: no sun
  double turbidity = 3;                        // 2 very clear .. 10 hazy
  dvec3 ground{0.2};                           // the part of light that the ground throws back
  HaloDescription halo;
  /// What a device has traced of the halo beforehand; without it compile() traces on the host, the same bits.
  std::shared_ptr<const HaloMap> halo_map;
};

/// The world's medium gives way to every other where solids overlap; a scene file's priorities are
/// -1000..1000.
inline constexpr int world_priority = -1'000'000;

struct MediumDescription {
  std::string name;
  double ior = 1;             // at the d line
  dvec3 absorption{0, 0, 0};  // per unit of world length
  int priority = 0;
  Dispersion dispersion{};    // path tracing: the index by the wavelength
  dvec3 scattering{0, 0, 0};  // per unit of world length; whitted takes it as absorption
  double anisotropy = 0;      // path tracing: the mean cosine of scattered light's turns
};

enum class MaterialType { phong, dielectric };

/// ka, kd, ks, kr, kt in [0, inf), kr and kt in [0, 1], each times a colour.
struct MaterialDescription {
  std::string name;
  MaterialType type = MaterialType::phong;
  dvec3 ambient{0.1}, diffuse{0.8}, specular{0};  // colour times coefficient
  double exponent = 32;
  bool blinn = false;
  dvec3 emission{0};                     // radiance that the outside sends out
  dvec3 reflection{0}, transmission{0};  // a dielectric's tints default to 1 (set by the loader)
  double roughness = 0;  // of reflection and transmission, [0, 1]; the GGX distribution's alpha is its square
  bool multiple_scattering = true;  // light that meets several facets of a rough surface is given back
  int medium = -1;                  // index into media of the inside; -1: thin, transmits straight through
  double wall_ior = 0;              // above 0, with medium -1: a dielectric thin wall of this index
  bool shadow_opaque = false;
  bool shadow_filter = false;  // path tracing: shadow rays go straight through an interface that bends light
  bool checker = false;
  bool off_camera = false;                       // of a lamp: the camera's rays pass it
  dvec3 checker_ambient{0}, checker_diffuse{0};  // ka and kd in odd cells: colour times coefficient
  double checker_size = 1;                       // edge of a cell, object space
  bool vertex_color = false;
  double opacity = 1;      // [0, 1]: the rest is what lies behind, seen straight through; with a medium 1
  double cutoff = 0;       // above 0: opacity from there on is 1, else 0
  bool one_sided = false;  // from behind it is not there
  MaterialTextures textures{};              // factors on the values here
  std::optional<MetalRough> metal_rough{};  // takes the place of ambient, diffuse, specular and reflection
  double normal_scale = 1;                  // factor on the slopes of a normal map
  double bump = 1;                          // height of a 1 of the height texture, object space
  double bump_uv = 0;                       // the same in units of u and v, added
  double parallax = 0;              // depth of a height of 0 below a height of 1, object space; 0: none
  int displaced_by = -1;            // index into textures: heights that move the vertices of meshes
  double displacement = 1;          // the distance for a height of 1, object space
  double displacement_middle = 0;   // the height that leaves vertices in place
  double displacement_edge = 0;     // of the triangles, object space; 0: about a texel's
  double occlusion = 1;             // how much of the occlusion texture counts, [0, 1]
  double coat = 0;                  // a clear layer's mirror above all else, [0, 1], times its texture
  std::optional<OpenPbr> layers{};  // what stands over these terms, and its base: set_openpbr()
  /// The same surface for integrators that follow paths, where it differs: surface_for().
  std::shared_ptr<const MaterialDescription> by_paths{};
};

/// Triangles with shared vertices. `normals` (empty: flat shading), `uvs`, `tangents`, `colors` and `alphas`
/// are empty or as long as `positions`; all colours linear.
struct Mesh {
  std::string name;
  MeshArray<glm::vec3> positions;
  MeshArray<glm::vec3> normals;
  MeshArray<glm::vec2> uvs;                       // v up
  std::vector<MeshArray<glm::vec2>> further_uvs;  // sets 1, 2, ..., each empty or as long as `positions`
  MeshArray<glm::vec4> tangents;  // along u; w: the bitangent's sign. Empty: compile() makes them
  MeshArray<glm::vec3> colors;
  MeshArray<float> alphas;  // of the colours, for TEXTURE_VERTEX_COLOR; empty: 1
  MeshArray<glm::uvec3> triangles;
  std::vector<int> materials;  // per triangle, index into SceneDescription::materials; empty: the object's
  std::size_t source_vertex_count = 0;  // as the file stores them: before vertices are split or dropped
};

struct MeshShape {
  int mesh = 0;
};  // index into meshes
struct FieldShape {
  int field = 0;
};  // index into fields

// The exact solids of shared/shapes.h. half_size(): of the box about the origin; open(): without an inside.
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
struct RectangleShape {  // in y = 0: half of its size along x and z
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
/// Its index is the SHAPE_* constant.
using Shape = std::variant<MeshShape, SOLIDS(SUNDOG_SHAPE_TYPE) FieldShape>;
#undef SUNDOG_SHAPE_TYPE
static_assert(std::variant_size_v<Shape> == SHAPE_COUNT);

/// A turn about a point, and growth from it, while the shutter is open: all as in the space around, `frame`.
struct TurnDescription {
  glm::dmat3 frame{1};  // from there to the world
  dvec3 axis{0, 1, 0};  // there
  double degrees = 0;
  dvec3 about{0};     // in the world, before any move
  double growth = 1;  // how many times its first size when the shutter closes
  dvec3 moves_by{0};  // how far it moves within this turn, as in Object
};

/// One placed thing. Groups are already flattened: the transform is the product of the group's and the
/// object's.
struct Object {
  std::string name;
  Shape shape = SphereShape{};
  int material = -1;  // -1: the mesh's own materials
  dmat4 world_from_object{1};
  std::string place;                     // JSON pointer, for messages
  int light = -1;                        // index of the light that it shows; -1: none
  dvec3 moves_by{0};                     // how far it moves, straight on, while the shutter is open
  std::vector<TurnDescription> turns{};  // before that; the outermost group's first
  bool moves() const { return moves_by != dvec3(0) || !turns.empty(); }
};

/// What lies between all things: light over a distance d keeps exp(-density d) of its own and gets the rest
/// from the fog. Only in the world's medium.
struct FogDescription {
  dvec3 color{0};
  double density = 0;                // per unit of world length
  std::optional<double> anisotropy;  // path tracing: the fog is a medium that scatters the part `color`
};

struct SceneDescription {
  std::filesystem::path file;
  Camera camera;
  ImageSettings image;
  RenderSettings render;
  FogDescription fog;
  EnvironmentDescription environment;
  std::vector<LightDescription> lights;
  std::vector<MediumDescription> media;  // [0] is the world's, of priority world_priority
  std::vector<ImageDescription> images;
  std::vector<TextureDescription> textures;
  std::vector<MaterialDescription> materials;
  std::vector<Mesh> meshes;
  std::vector<SdfDescription> fields;
  std::vector<Object> objects;
  std::vector<std::string> warnings;  // one line each: what a model file held that was read past
};

}  // namespace sundog
