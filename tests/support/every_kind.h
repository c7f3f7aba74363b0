// One of each kind, from the lists of kernels/shared: a new kind is in every test that runs over these.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

/// Each exact solid with the sizes that its description has from the start, in the order of Shape.
std::vector<sundog::Shape> every_solid();

/// every_solid() without those that have no bounds.
std::vector<sundog::Shape> every_bounded_solid();

/// `shapes`, and of each bounded solid that is not among them one.
std::vector<sundog::Shape> with_every_solid(std::vector<sundog::Shape> shapes);

/// Each bounded solid, most in several sizes about 1.
std::vector<sundog::Shape> solids_of_many_sizes();

/// The name in scene files.
std::string name_of(const sundog::Shape& shape);

/// Each type of light, at (1, 3, 2) and aimed down where it has a place or an aim.
std::vector<sundog::LightDescription> every_light();

/// The area lights of every_light().
std::vector<sundog::LightDescription> every_area_light();
