// SceneDescription: the scene file's content as plain values, with names resolved to indices. The loaders in
// this folder create it; compile() reads it.
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "formula/definition.h"
#include "formula/sdf.h"
#include "models/values/camera.h"
#include "models/values/light.h"
#include "models/values/material.h"
#include "models/values/mesh.h"
#include "models/values/object.h"
#include "scene/halo.h"
#include "shared/light_parts.h"
#include "shared/sampler.h"
#include "shared/scene.h"

namespace sundog {

enum class Tracer { automatic, wide, compact };

/// How samples are distributed over the pixels.
struct Sampling {
  double threshold = 0;    // above 0: adaptive; a pixel is sampled until its estimated error is below this
  int first_samples = 1;   // adaptive: initial samples per pixel
  bool surfaces = false;   // adaptive: more samples for neighbours that show different surfaces or colours
  double contrast = 4;     // adaptive: colours that differ by this many thresholds count as different
  double budget = 0;       // adaptive: mean samples per pixel; 0: no limit
  bool subsample = false;  // render every second pixel each way; interpolate the others where possible
  double subsample_contrast = 0.1;  // colour difference above which pixels are not interpolated
  bool progressive = false;         // samples double pass by pass: 1, 2, 4...
};

/// A sphere from which light comes; matte surfaces send some paths towards it.
struct Guide {
  dvec3 center{0};
  double radius = 1;
};

enum class Filter { box, tent, gaussian, blackman_harris, mitchell };

struct RenderSettings {
  int max_depth = 8;      // 1: camera rays only
  int samples = 1;        // per pixel; 1 = the pixel's centre
  int light_samples = 0;  // shadow rays from each surface to random area lights; 0: to each light
  double cutoff = 1e-3;   // throughput below which a ray ends, [0, 1]
  double max_component = std::numeric_limits<double>::infinity();  // upper limit of a sample's light
  std::string integrator = "whitted";
  int roulette = 2;                   // path: depth at which Russian roulette starts; 65: never
  u32 light_strategy = STRATEGY_MIS;  // path: a STRATEGY_* constant
  std::vector<Guide> guides;          // path: spheres to aim at
  bool caustics = false;              // path: photon mapping of light through glass and mirrors
  int photons = 65536;                // photons emitted per map
  double photon_radius = 0;           // radius of the first map; 0: chosen for the scene
  u32 sampler = SAMPLER_AUTO;         // a SAMPLER_* constant
  int seed = 0;                       // changes the noise
  Filter filter = Filter::box;
  double filter_radius = 0;  // in pixels; 0: the filter's default
  Sampling sampling;
  Tracer tracer = Tracer::automatic;
  int texture_memory = 1024;    // MiB for images on a device
  bool spatial_splits = false;  // split triangles in the BVH build: slower, better for long thin ones
};

enum class EnvironmentType { none, image, gradient, sky, halo };

/// Light from infinity. Radiance is color times intensity times the type's own radiance.
struct EnvironmentDescription {
  EnvironmentType type = EnvironmentType::none;
  dvec3 color{1};
  double intensity = 1;
  dvec3 up{0, 1, 0};
  double rotate = 0;    // degrees about `up`
  int samples = 1;      // shadow rays from each surface to the environment, and as many again to its sun
  bool visible = true;  // whether camera rays that hit nothing show it; other rays always do
  bool hidden = false;  // no ray shows it
  std::string group;    // light group, for AOVs; empty: none
  Image picture;        // image: equirectangular, zenith in row 0
  dvec3 bottom{0.3}, top{1};  // gradient: linear in the sine of the elevation
  // Sky, and halo, which is a sky with ice crystals:
  double sun_altitude = 40, sun_azimuth = 60;  // degrees, from -18 (halo: 0); clockwise from ahead
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
  double unit = 0.1;                  // length of a scene unit in metres
  double frames_per_second = 24;
  bool has_models = false;  // has model files, whose materials were read for the integrator
  bool plays = false;       // changes with the frame by itself, as a model's animation does
};

}  // namespace sundog
