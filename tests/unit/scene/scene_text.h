// Scenes written in tests: text to a file in a folder of its own, and what the loader makes of it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scene/description.h"
#include "temporary_folder.h"

/// Loads this text as a scene file; beside it lies tetra.ply, a tetrahedron without normals or materials.
sundog::SceneDescription load_scene_text(std::string_view text,
                                         const std::vector<std::string>& overrides = {});

/// The error that load_scene() throws for this text; fails the test if there is none.
sundog::SceneError error_of(std::string_view text, const std::vector<std::string>& overrides = {});

/// A scene whose only content is these members beside one sphere of material "m".
std::string scene_with(std::string_view members);
/// A scene with the material "m" and this object.
std::string scene_of(std::string_view object);

/// Four triangles on the corners (0 0 0) (1 0 0) (0 1 0) (0 0 1).
extern const std::string_view tetrahedron_ply;

/// Every value of a description, as lines: equal for equal scenes.
std::string all_values(const sundog::SceneDescription& scene);
