// Scenes built in code, for closed forms: short makers of the description's values, and a render of one pixel
// or more.
#pragma once
#include <string>
#include <vector>

#include "render/render.h"
#include "scene/description.h"

namespace scenes {

/// An empty scene: black background, no lights, world medium of index 1, a 1x1 image with a view so narrow
/// that the pixel's ray is the line from position to target.
sundog::SceneDescription line_of_sight(glm::dvec3 position, glm::dvec3 target, glm::dvec3 up = {0, 1, 0});

/// The scene of that name among scenes/, small: 37x26 pixels, at most 3 samples and a depth of 5.
sundog::SceneDescription shipped_small(const std::string& name);

/// Shines with `color` by itself (the scene has one ambient light of 1), reflects and transmits nothing.
int add_glow(sundog::SceneDescription& scene, glm::dvec3 color);

/// A clear dielectric over a new medium.
int add_dielectric(sundog::SceneDescription& scene, double ior, glm::dvec3 absorption = {0, 0, 0},
                   int priority = 0);

/// A white diffuse material, kd = 1, without other terms.
int add_white(sundog::SceneDescription& scene);

int add_mirror(sundog::SceneDescription& scene, double reflection, glm::dvec3 glow = {0, 0, 0});

/// Places a shape with the transform.
void place(sundog::SceneDescription& scene, sundog::Shape shape, int material,
           const glm::dmat4& world_from_object = glm::dmat4(1));

/// Renders on one device, which stays open for the next scene. Scenes without fields, textures, fog, lens and
/// motion are drawn by general kernels, which they share: building a scene's own takes longer than drawing
/// it. They draw the same bits (a test renders scenes both ways).
sundog::RenderResult render_on(const sundog::DeviceInfo& device, const sundog::SceneDescription& scene,
                               const sundog::RenderOptions& options = {});

/// Lets go of the devices: to be called before the process ends.
void close_sessions();

/// The one pixel of a line_of_sight scene, RGB. Fails where the compact tracer's is another but for rounding.
glm::dvec3 pixel_on(const sundog::DeviceInfo& device, const sundog::SceneDescription& scene);

}  // namespace scenes
