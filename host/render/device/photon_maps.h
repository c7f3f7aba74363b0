// Photon maps (kernels/shared/photons.h), which a device makes when its samples need them. Each map depends
// only on the scene and the map's number.
#pragma once
#include <cstddef>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/device/frame_kernels.h"
#include "render/device/launch_watch.h"
#include "render/values/tile.h"

namespace sundog {

/// The device and kernels that trace photons.
struct PhotonTracer {
  Device& device;
  FrameKernels& kernels;
  LaunchWatch& watch;
};

class PhotonMaps {
 public:
  explicit PhotonMaps(const CompiledScene& scene)
      : plan_(scene.photons_by),
        targets_(static_cast<u32>(scene.photon_targets.size())),
        scatters_(scene.features.scattering),
        lights_(scene.lights.size()) {}

  /// Makes the maps for samples [first, last) and stores them in `tracer.kernels.tables`, as many as fit.
  /// Returns false if stopped. Throws DeviceError.
  bool prepare(const PhotonTracer& tracer, const StopFlags& flags, u32 first, u32 last);

  /// The end of the leading samples of [first, last) whose maps are in the tables.
  u32 end_of_maps(u32 first, u32 last) const;

 private:
  struct Made {
    PhotonMap map{};
    std::vector<float4> photons;
    std::vector<u32> cells;
    std::size_t bytes() const { return photons.size() * sizeof(float4) + cells.size() * sizeof(u32); }
  };
  bool holds(u32 number) const { return number >= first_map_ && number < end_map_; }
  void make_room(const PhotonTracer& tracer);
  void trace(const PhotonTracer& tracer, const PhotonLaunch& launch);
  Made make(const PhotonTracer& tracer, u32 number);
  bool fill(const PhotonTracer& tracer, const StopFlags& flags, u32 number);

  PhotonPlan plan_;
  u32 targets_ = 0;        // rows of the scene's photon_targets; 0: no photons
  bool scatters_ = false;  // photons leave beams in media
  std::size_t lights_ = 0;
  u32 first_map_ = 0, end_map_ = 0;  // maps in the tables
  u32 wanted_end_ = 0;
  bool full_ = false;        // no room for more maps
  Buffer<u32> light_media_;  // MediaStack at each light, low word first
  bool traced_ = false;      // the kernel has run before
  Buffer<float4> landed_;
  Buffer<u32> cells_;
};

/// The radius of map `number` relative to map 0 (Knaus and Zwicker 2011, equation 18).
double shrunk_radius(u32 number);

}  // namespace sundog
