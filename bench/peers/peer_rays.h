// A model on a device, and its rays by kind, for programs that trace them with both sundog and a peer.
#pragma once

#include "base/arguments.h"
#include "bench/rays/ray_sets.h"
#include "bench/rays/ray_tracer.h"
#include "peer_program.h"

namespace sundog {

struct RayOptions : PeerOptions {
  std::string device = "cpu";   // SPEC
  unsigned threads = 0;         // compute units of a CPU to use; 0: all
  std::string tracer = "auto";  // or wide, compact
  unsigned size = 1024;
  std::vector<std::string> kinds;
};

/// Adds add_peer_options() and --device --size --kinds.
void add_ray_options(Arguments& app, RayOptions& options);

/// A compiled model, and sundog's tracer for it on the device that the options name.
struct PeerModel {
  PeerModel(const std::string& model, const RayOptions& options);

  std::string path;
  SceneDescription description;
  CompiledScene scene;
  Device device;
  RayTracer tracer;

  /// The class of sundog's tracer: "wide" or "compact".
  const char* tracer_name() const;
  /// The rays of a frame in which 65 % of the camera rays hit the model.
  std::vector<RaySet> rays(const RayOptions& options);
  /// The model, the device and the tracer, for JSON.
  nlohmann::json facts() const;
};

}  // namespace sundog
