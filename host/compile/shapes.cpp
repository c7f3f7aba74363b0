// Dispatches to the static functions of a solid's struct through the table SOLIDS; meshes and fields have
// none.
#include "compile/shapes.h"

#include "base/error.h"
#include "scene/kinds.h"

namespace sundog {
namespace {

std::logic_error no_such(const UnitShape& unit, const char* what) {
  return std::logic_error(fmt::format("a {} has not {}", shape_names.at(unit.shape), what));
}

/// Calls f with a null pointer, which conveys the type of the solid's struct.
template <class Result, class F>
Result of_solid(const UnitShape& unit, F f) {
  switch (unit.shape) {
#define SUNDOG_SOLID(constant, type, name, effect) \
  case SHAPE_##constant:                           \
    return f(static_cast<const type##Shape*>(nullptr));
    SOLIDS(SUNDOG_SOLID)
#undef SUNDOG_SOLID
    case SHAPE_MESH:
    case SHAPE_SDF:
      break;
  }
  throw no_such(unit, "the geometry of a solid");
}

bool is_solid(const UnitShape& unit) { return unit.shape != SHAPE_MESH && unit.shape != SHAPE_SDF; }

}  // namespace

UnitShape unit_shape(const std::string& file, const Object& object) {
  try {
    return std::visit(
        []<class S>(const S& shape) -> UnitShape {
          if constexpr (requires { shape.unit(); })
            return shape.unit();
          else
            return {std::is_same_v<S, FieldShape> ? SHAPE_SDF : SHAPE_MESH};
        },
        object.shape);
  } catch (const std::domain_error& error) {
    throw SceneError(file, object.place, fmt::format("object \"{}\": {}", object.name, error.what()));
  }
}

double reach(const UnitShape& unit, const dvec3& d) {
  return of_solid<double>(unit, [&]<class S>(const S*) -> double {
    if constexpr (requires { S::reach(unit, d); })
      return S::reach(unit, d);
    else
      throw no_such(unit, "a reach");
  });
}

FlatFaces flat_faces(const UnitShape& unit) {
  if (!is_solid(unit)) return {};
  return of_solid<FlatFaces>(unit, [&]<class S>(const S*) { return S::faces(unit); });
}

std::optional<Curvature> curvature(const UnitShape& unit) {
  if (!is_solid(unit)) return std::nullopt;
  return of_solid<std::optional<Curvature>>(unit, [&]<class S>(const S*) { return S::curvature(unit); });
}

double unit_distance(const UnitShape& unit, const dvec3& q) {
  return of_solid<double>(unit, [&]<class S>(const S*) -> double {
    if constexpr (requires { S::distance(unit, q); })
      return S::distance(unit, q);
    else
      throw no_such(unit, "a distance");
  });
}

}  // namespace sundog
