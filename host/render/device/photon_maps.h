// The maps of photons that samples look at (kernels/shared/photons.h), made by a device when its samples come
// to them: each is a function of the scene and its number, whoever makes it and when.
#pragma once
#include <cstddef>
#include <vector>

#include "compile/compiled_scene.h"
#include "render/device/frame_kernels.h"
#include "render/device/launch_watch.h"
#include "render/frame/tile_server.h"

namespace sundog {

/// What photons are traced by.
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
        lights_(scene.lights.size()) {}

  /// The samples [first, last) are to be made: puts their maps into `tracer.kernels.tables`, as far as there
  /// is room. Returns false when it was stopped. Throws DeviceError.
  bool prepare(const PhotonTracer& tracer, const StopFlags& flags, u32 first, u32 last);

  /// The end of those of the samples [first, last) that have their maps in the tables, one after another.
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
  u32 targets_ = 0;  // rows of the scene's photon_targets; 0: it has no photons
  std::size_t lights_ = 0;
  u32 first_map_ = 0, end_map_ = 0;  // those in the tables
  u32 wanted_end_ = 0;
  bool full_ = false;        // there was no room for more
  Buffer<u32> light_media_;  // the MediaStack at each light, low word first
  bool traced_ = false;      // the kernel has run before
  Buffer<float4> landed_;
  Buffer<u32> cells_;
};

/// The radius of map `number`, over that of map 0 (Knaus and Zwicker 2011, equation 18).
double shrunk_radius(u32 number);

}  // namespace sundog
