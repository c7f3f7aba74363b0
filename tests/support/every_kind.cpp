// Makes a solid and a light of each kind, from the lists in kernels/shared.
#include "every_kind.h"

#include <algorithm>

#include "scene/kinds.h"

using namespace sundog;

std::vector<Shape> every_solid() {
  return {
#define SUNDOG_SOLID(constant, type, name, effect) type##Shape{},
      SOLIDS(SUNDOG_SOLID)
#undef SUNDOG_SOLID
  };
}

std::vector<Shape> every_bounded_solid() {
  std::vector<Shape> shapes = every_solid();
  std::erase_if(shapes, [](const Shape& shape) { return std::holds_alternative<PlaneShape>(shape); });
  return shapes;
}

std::vector<Shape> with_every_solid(std::vector<Shape> shapes) {
  for (const Shape& solid : every_bounded_solid())
    if (std::ranges::none_of(shapes, [&](const Shape& shape) { return shape.index() == solid.index(); }))
      shapes.push_back(solid);
  return shapes;
}

std::vector<Shape> solids_of_many_sizes() {
  return with_every_solid({SphereShape{}, BoxShape{}, CylinderShape{1, 1, true}, CylinderShape{1, 1, false},
                           ConeShape{1, 0, 1}, ConeShape{0.4, 1, 1}, ConeShape{1, 0.3, 1, false}, DiskShape{},
                           DiskShape{1, 0.5}, RectangleShape{{1, 0.4}}, TorusShape{1, 0.3},
                           TorusShape{1, 0.6}, RoundBoxShape{{1, 0.6, 0.8}, 0.2},
                           RoundBoxShape{{1, 1, 0.5}, 0.5}});
}

std::string name_of(const Shape& shape) { return std::string(shape_names.at(shape.index())); }

std::vector<LightDescription> every_light() {
  std::vector<LightDescription> lights;
  for (const LightTypeFacts& facts : light_types) {
    LightDescription light;
    light.type = facts.value;
    light.position = {1, 3, 2};
    light.direction = {0, -1, 0};
    lights.push_back(light);
  }
  return lights;
}

std::vector<LightDescription> every_area_light() {
  std::vector<LightDescription> lights = every_light();
  std::erase_if(lights, [](const LightDescription& light) { return !facts_of(light.type).has_extent(); });
  return lights;
}
