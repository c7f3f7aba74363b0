// Builds scenes for closed forms in code, and renders one pixel or more.
#pragma once
#include <string>
#include <vector>

#include "render/render.h"
#include "scene/description.h"

namespace scenes {

/// An empty scene: black background, no lights, world medium of index 1, a 1x1 image with a view so narrow
/// that the pixel's ray is the line from position to target.
sundog::SceneDescription line_of_sight(glm::dvec3 position, glm::dvec3 target, glm::dvec3 up = {0, 1, 0});

/// The scene scenes/NAME.json, made small: 37x26 pixels, at most 3 samples and a depth of at most 5.
sundog::SceneDescription shipped_small(const std::string& name);

/// Adds a material that glows with `color` (by the scene's ambient light of 1) and reflects and transmits
/// nothing.
int add_glow(sundog::SceneDescription& scene, glm::dvec3 color);

/// Adds a clear dielectric with a new medium.
int add_dielectric(sundog::SceneDescription& scene, double ior, glm::dvec3 absorption = {0, 0, 0},
                   int priority = 0);

/// Adds a white diffuse material, kd = 1, without other terms.
int add_white(sundog::SceneDescription& scene);

int add_mirror(sundog::SceneDescription& scene, double reflection, glm::dvec3 glow = {0, 0, 0});

/// Adds an object.
void place(sundog::SceneDescription& scene, sundog::Shape shape, int material,
           const glm::dmat4& world_from_object = glm::dmat4(1));

/// Renders on one device, which stays open for the next scene. Scenes without fields, textures, fog, lens,
/// motion and the like share general kernels, because building a scene's own takes longer than rendering it.
/// These draw the same bits (a test renders scenes both ways).
sundog::RenderResult render_on(const sundog::DeviceInfo& device, const sundog::SceneDescription& scene,
                               const sundog::RenderOptions& options = {});

/// Closes the devices. Must be called before the process ends.
void close_sessions();

/// The pixel of a line_of_sight() scene, RGB. Fails the test if the compact tracer's differs by more than
/// rounding.
glm::dvec3 pixel_on(const sundog::DeviceInfo& device, const sundog::SceneDescription& scene);

}  // namespace scenes
