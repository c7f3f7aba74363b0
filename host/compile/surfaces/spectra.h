// Compiles the table `spectra` of a scene: colours of wavelengths, basis spectra of red and blue, and
// refractive indices of dispersive media.
#pragma once
#include <utility>
#include <vector>

#include "models/values/refraction.h"
#include "shared/spectra.h"

namespace sundog {

class SpectraMaker {
 public:
  /// Only paths carry wavelengths; else the table stays empty.
  explicit SpectraMaker(bool paths) : used_(paths) {}

  /// The offset of a medium's indices, shared by equal dispersions; NO_SPECTRUM without dispersion.
  u32 add(const Dispersion& dispersion);

  std::vector<float> take_table() { return std::move(table_); }

 private:
  bool used_;
  std::vector<Dispersion> added_;
  std::vector<float> table_;
};

}  // namespace sundog
