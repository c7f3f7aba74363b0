// The table `spectra` of a scene: what wavelengths add to colours, the spectra of red and blue, and the
// indices of refraction of the media that disperse.
#pragma once
#include <utility>
#include <vector>

#include "scene/description.h"
#include "shared/spectra.h"

namespace sundog {

class SpectraMaker {
 public:
  /// Only paths carry wavelengths: with another integrator the table stays empty.
  explicit SpectraMaker(const SceneDescription& scene);

  /// Where the indices of a medium begin; the same for the same dispersion. NO_SPECTRUM without one.
  u32 add(const Dispersion& dispersion);

  std::vector<float> take_table() { return std::move(table_); }

 private:
  bool used_;
  std::vector<Dispersion> added_;
  std::vector<float> table_;
};

}  // namespace sundog
