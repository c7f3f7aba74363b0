// Scenes around a model, clocks and JSON figures for the programs that measure against a peer.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/clock.h"
#include "bench/report/samples.h"
#include "scene/description.h"

namespace sundog {

/// One model's meshes where they lie, without lights; or a .json scene as it is.
SceneDescription scene_of_model(const std::string& path, bool spatial_splits);

/// Seconds by the wall clock, and by the processor's of all threads together.
struct Elapsed {
  double wall = 0, processor = 0;

  /// Seconds per thread. The processor's clock is steadier on a machine that others use too.
  double of_thread(unsigned threads, bool by_wall) const { return by_wall ? wall : processor / threads; }
};

template <class Work>
Elapsed elapsed(const Work& work) {
  const double start = processor_seconds();
  const Stopwatch clock;
  work();
  return {clock.seconds(), processor_seconds() - start};
}

/// {"median", "min", "max"}.
nlohmann::json to_json(const Spread& spread);

}  // namespace sundog
