// Writes a POV-Ray 3.7 scene that shows what a SceneDescription does, so that pictures and times can be
// compared.
#pragma once
#include <stdexcept>
#include <string>

#include "scene/description.h"

namespace sundog::povray {

/// Absorption in POV-Ray: as participating media, which is right wherever solids lie in each other, or by
/// `fade_power`, which is cheaper but forgets a stretch that ends at another solid's surface.
enum class Absorption { media, fade };

/// Thrown for a feature of the scene that POV-Ray cannot express.
struct Unsupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The POV-Ray scene. POV-Ray knows no priorities, so each exact solid is cut by the solids of higher
/// priority that reach into it, shrunk by 1/1000 so that no surfaces coincide: the thin overlap is the
/// medium entered last, and its second interface bends nothing. Meshes are not cut (slow there); where they
/// overlap, too, the one entered last counts. A material with "shadow": "opaque" becomes one that casts no
/// shadow and an invisible double that does. Throws Unsupported.
std::string from_scene(const SceneDescription& scene, Absorption absorption);

}  // namespace sundog::povray
