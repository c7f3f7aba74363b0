// The kinds of solids and lights: each one of the lists has its name in scene files, its place in the schema,
// its geometry.
#include <random>

#include "bench/plain/any_solid.h"
#include "bench/plain/solids.h"
#include "catch.h"
#include "every_kind.h"
#include "formula/evaluate.h"
#include "json_schema.h"
#include "scene/kinds.h"
#include "scene/read/parts.h"
#include "scene_text.h"

using namespace sundog;
using glm::dvec3;
using nlohmann::json;

namespace {

bool is_listed(const json& list, const json& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

UnitShape unit_of(const Shape& shape) {
  Object object;
  object.shape = shape;
  return unit_shape("", object);
}

std::span<const ProfileArc> rows_of(const UnitShape& unit) {
  return unit.revolution ? std::span(unit.revolution->arcs()) : std::span<const ProfileArc>{};
}

bool is_open(const Shape& shape) {
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.open(); }) return s.open();
        return true;
      },
      shape);
}

}  // namespace

TEST_CASE("the tests run over every solid and every light that a scene can hold") {
  const std::vector<Shape> solids = every_solid();
  REQUIRE(solids.size() + 2 == std::variant_size_v<Shape>);  // a mesh before, a field behind
  REQUIRE(solid_types().size() == solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    CHECK(solids[i].index() == i + 1);
    CHECK(unit_of(solids[i]).shape == static_cast<ShapeKind>(i + 1));
    CHECK(solid_types()[i] == name_of(solids[i]));
  }
  const std::vector<LightDescription> lights = every_light();
  for (std::size_t i = 0; i < lights.size(); ++i) {
    CHECK(lights[i].type == static_cast<LightType>(i));
    CHECK(facts_of(lights[i].type).value == lights[i].type);
    if (i > 0) CHECK(&facts_of_kind(static_cast<u32>(i - 1)) == &facts_of(lights[i].type));
  }
}

TEST_CASE("the schema has each solid and each light, and scene files have it by that name") {
  const json& definitions = scene_schema().at("$defs");
  const auto has = [&](const char* place, const std::string& name, const std::string& definition) {
    INFO(place << ": " << name);
    CHECK(definitions.contains(definition));
    const json wanted = {{"if", {{"properties", {{"type", {{"const", name}}}}}}},
                         {"then", {{"$ref", "#/$defs/" + definition}}}};
    CHECK(is_listed(definitions.at(place).at("allOf"), wanted));
  };
  json solids, lights;
  for (const Shape& solid : every_solid()) {
    solids.push_back(name_of(solid));
    has("solid", name_of(solid), name_of(solid));
  }
  for (const LightTypeFacts& facts : light_types) {
    lights.push_back(facts.name);
    has("light", std::string(facts.name), std::string(facts.name) + "_light");
  }
  CHECK(std::ranges::is_permutation(definitions.at("solid_type").at("enum"), solids));
  CHECK(std::ranges::is_permutation(definitions.at("/light/properties/type/enum"_json_pointer), lights));
}

TEST_CASE("a solid as a field has its inside where the solid has it") {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  // Sizes that differ, so that none can take another's place.
  for (const Shape& shape :
       with_every_solid({BoxShape{{0.5, 0.8, 1.2}}, CylinderShape{0.7, 1.3}, ConeShape{1, 0.3, 0.6},
                         TorusShape{0.9, 0.3}, RoundBoxShape{{0.9, 0.6, 0.7}, 0.2}})) {
    const std::optional<FormulaField> field = field_of_solid(shape);
    INFO(name_of(shape));
    if (std::holds_alternative<LatheShape>(shape)) continue;  // no formula has its profile
    REQUIRE(field.has_value() == !is_open(shape));
    if (!field) continue;
    const UnitShape unit = unit_of(shape);
    FormulaEvaluator evaluator(*field);
    int inside = 0, outside = 0;
    for (int i = 0; i < 2000; ++i) {
      const dvec3 p = 1.5 * dvec3(uniform(), uniform(), uniform());
      const double by_shape = unit_distance(unit, p / unit.scale), by_field = evaluator.at(p).distance;
      if (std::abs(by_shape) < 1e-6) continue;
      CHECK((by_shape < 0) == (by_field < 0));
      ++(by_shape < 0 ? inside : outside);
    }
    CHECK(inside > 50);
    CHECK(outside > 50);
  }
}

TEST_CASE("by its distance a solid is crossed where its equations have it") {
  std::mt19937 random(11);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-31 - 1; };
  for (const Shape& shape : every_bounded_solid()) {
    if (is_open(shape)) continue;
    const UnitShape unit = unit_of(shape);
    INFO(name_of(shape));
    std::size_t found = 0, others = 0;
    for (int i = 0; i < 1500; ++i) {
      const dvec3 o = 3.0 * dvec3(uniform(), uniform(), uniform()),
                  d = dvec3(uniform(), uniform(), uniform()) - 0.5 * o;
      const auto expected = plain::solid_crossings({unit.shape, unit.parameters, rows_of(unit)}, o, d);
      const auto crossings = crossings_by_distance(unit, o, d);
      others += crossings.size() != expected.size();  // by rounding, along a surface
      for (std::size_t k = 0; k < std::min(crossings.size(), expected.size()); ++k, ++found) {
        CHECK(crossings[k].t == Approx(expected[k].t).epsilon(1e-6).margin(1e-6));
        CHECK(glm::dot(glm::normalize(crossings[k].ng), glm::normalize(expected[k].ng)) > 0.999);
      }
    }
    CHECK(found > 200);  // of 3000 for a solid that fills its box
    CHECK(others <= 1);
  }
}
