// A model on a device, and its rays by kind, for programs that trace them with sundog and a peer.
#pragma once

#include "base/arguments.h"
#include "bench/rays/ray_sets.h"
#include "bench/rays/ray_tracer.h"
#include "peer_program.h"

namespace sundog {

struct RayOptions : PeerOptions {
  std::string device = "cpu";   // SPEC
  unsigned threads = 0;         // compute units of a CPU that are used; 0: all
  std::string tracer = "auto";  // or wide, compact
  unsigned size = 1024;
  std::vector<std::string> kinds;
};

/// add_peer_options() and --device --size --kinds.
void add_ray_options(Arguments& app, RayOptions& options);

/// A model, compiled, and sundog's tracer of it on the device that the options name.
struct PeerModel {
  PeerModel(const std::string& model, const RayOptions& options);

  std::string path;
  SceneDescription description;
  CompiledScene scene;
  Device device;
  RayTracer tracer;

  /// The class of sundog's tracer: "wide" or "compact".
  const char* tracer_name() const;
  /// The rays of a frame in which 65 % of them meet the model.
  std::vector<RaySet> rays(const RayOptions& options);
  /// The model, the device and the tracer, for JSON.
  nlohmann::json facts() const;
};

}  // namespace sundog
