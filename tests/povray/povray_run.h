// Runs POV-Ray, when it is installed, on a scene text, and reads the picture and the figures it reports.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/image.h"

namespace sundog::povray {

/// "3.7.0.10", or empty when POV-Ray is not installed.
std::string installed_version();

struct Run {
  Image image;             // linear, clamped to [0, 1] (16 bits a channel)
  double seconds = 0;      // wall time of tracing, without parsing
  double cpu_seconds = 0;  // of all threads, tracing
  double parse_seconds = 0;
  std::uint64_t rays = 0, shadow_tests = 0;
};

/// Renders one sample a pixel, at its centre. Files go to `folder` (made if missing) as `name`.pov,
/// .png and .log. Throws std::runtime_error with the end of POV-Ray's log when it fails.
Run run(const std::string& scene, int width, int height, int threads, const std::filesystem::path& folder,
        const std::string& name);

}  // namespace sundog::povray
