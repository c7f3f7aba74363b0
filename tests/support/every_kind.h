// One solid and light of each kind, from the lists in kernels/shared, so that tests over them include every
// new kind.
#pragma once
#include <string>
#include <vector>

#include "scene/description.h"

/// Each exact solid with its default sizes, in the order of Shape.
std::vector<sundog::Shape> every_solid();

/// every_solid() without unbounded ones.
std::vector<sundog::Shape> every_bounded_solid();

/// `shapes`, and one of each bounded solid that is missing among them.
std::vector<sundog::Shape> with_every_solid(std::vector<sundog::Shape> shapes);

/// Each bounded solid, most in several sizes about 1.
std::vector<sundog::Shape> solids_of_many_sizes();

/// The name in scene files.
std::string name_of(const sundog::Shape& shape);

/// Each type of light; those with a position are at (1, 3, 2), those with a direction point down.
std::vector<sundog::LightDescription> every_light();

/// The area lights of every_light().
std::vector<sundog::LightDescription> every_area_light();
