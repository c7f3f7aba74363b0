// Reads recipes of generated meshes and calls their generators.
#include "scene/procedural/procedural.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/image_io.h"
#include "base/json_text.h"
#include "scene/json/members.h"
#include "scene/procedural/extrusion.h"
#include "scene/procedural/ice_block.h"
#include "scene/procedural/lathe.h"
#include "scene/procedural/terrain.h"
#include "scene/read/field_formulas.h"

namespace sundog {

namespace {

IceSurface read_cavity(JsonObject& object, const IceSurface& outer) {
  // By default, the cavity is like the outside at 0.6 of its size.
  IceSurface cavity = outer;
  cavity.size *= 0.6;
  read_members(object, cavity);
  return cavity;
}

/// Reads a recipe's block, except "level" and "wall".
IceBlock read_block(JsonObject& object) {
  IceBlock block;
  read_members(object, block);
  read_members(object, block.outer);
  if (const auto cavity = object.find("cavity")) {
    block.hollow = true;
    block.cavity = cavity->object("generate_ice_cavity",
                                  [&](JsonObject& inner) { return read_cavity(inner, block.outer); });
  }
  return block;
}

// Returns an empty mesh if it only checks the recipe.
Mesh read_ice_block(JsonObject& object, bool checks) {
  const IceBlock block = read_block(object);
  std::string part;
  object.read("part", part);
  if (part == "ice") return checks ? Mesh() : make_ice(block);
  const double level = object.at("level").number();
  double wall = 0;
  object.read("wall", wall);
  return checks ? Mesh() : make_ice_liquid(block, level, wall);
}

std::vector<procedural::ProfilePoint> read_profile(const JsonValue& value) {
  std::vector<procedural::ProfilePoint> points;
  for (const JsonValue& item : value.items("points")) {
    const JsonItems numbers = item.items("numbers");
    points.push_back({{numbers[0].number(), numbers[1].number()}});
    if (numbers.size() > 2) points.back().rounding = numbers[2].number();
    if (points.back().rounding < 0) numbers[2].wanted("a rounding of 0 or more");
  }
  return points;
}

Lathe read_lathe(JsonObject& object) {
  Lathe lathe;
  lathe.profile = read_profile(object.at("profile"));
  read_members(object, lathe);
  return lathe;
}

Extrusion read_extrusion(JsonObject& object) {
  Extrusion extrusion;
  extrusion.outline = read_profile(object.at("outline"));
  read_members(object, extrusion);
  return extrusion;
}

Sweep read_sweep(JsonObject& object) {
  Sweep sweep;
  read_members(object, sweep);
  return sweep;
}

/// A picture's levels as stored in its file: heights are not light, so images for screens are not linearised.
Image levels_of(const JsonValue& file, const ReadPicture& read_picture) {
  Image picture = read_picture(file);
  if (is_for_screens(file.text()))
    for (float& value : picture.data) value = srgb_from_linear(value);
  return picture;
}

/// Reads a formula of p that yields a number.
LoweredPattern read_heights(JsonObject& object) {
  try {
    LoweredPattern formula = lower_pattern({read_text(object, "formula"), {}});
    if (formula.values.size() != 1) object.at("formula").fail("a height is a number, found a vec3");
    return formula;
  } catch (const FormulaError& error) {
    FormulaError placed = error;
    placed.section = "formula";
    fail_formula(object.value(), placed);
  }
}

Terrain read_terrain(JsonObject& object, const ReadPicture& read_picture) {
  Terrain terrain;
  read_members(object, terrain);
  if (const auto file = object.find("file"); file && read_picture)
    terrain.picture = levels_of(*file, read_picture);
  if (object.has("formula")) terrain.formula = read_heights(object);
  return terrain;
}

/// The recipe of the mesh that the key "vessel" names.
JsonValue find_vessel(const JsonValue& name, const JsonValue& meshes) {
  static const nlohmann::json::json_pointer place("/generate/type");
  const auto mesh = meshes.json().find(name.text());
  const bool typed = mesh != meshes.json().end() && mesh->contains(place) && mesh->at(place).is_string();
  const std::string type = typed ? mesh->at(place).get<std::string>() : "";
  if (type != "lathe" && type != "ice_block")
    name.fail(fmt::format(
        "\"{}\" is no vessel; wanted the name of a mesh that a \"lathe\" or an \"ice_block\" generates",
        name.text()));
  return meshes.member(name.text(), "a mesh").member("generate", "a recipe");
}

Mesh read_fill(JsonObject& object, const JsonValue& meshes, bool checks) {
  const JsonValue recipe = find_vessel(object.at("vessel"), meshes), to = object.at("to");
  double meniscus = 0;
  object.read("meniscus", meniscus);
  const bool ice = recipe.type() == "ice_block";
  if (ice && meniscus > 0) object.at("meniscus").fail("only the liquid in a lathe has a meniscus");
  if (checks) return {};
  if (!ice) return make_lathe_liquid(recipe.object("generate", read_lathe), to.number(), meniscus);
  const IceBlock block = recipe.object("generate", [](JsonObject& vessel) {
    for (const char* key : {"part", "level", "wall"}) vessel.check(key);
    return read_block(vessel);
  });
  return make_ice_liquid(block, to.number());
}

/// The exact solid of a lathe's recipe, or of a recipe that fills a lathe.
ExactLathe follow_exactly(const JsonValue& recipe, const JsonValue& meshes) {
  if (recipe.type() == "lathe") return exact_lathe(recipe.object("generate", read_lathe));
  return recipe.object("generate", [&](JsonObject& object) {
    const JsonValue vessel = find_vessel(object.at("vessel"), meshes);
    if (vessel.type() != "lathe")
      object.at("vessel").fail("only what fills a lathe is a surface of revolution");
    double meniscus = 0;
    object.read("meniscus", meniscus);
    return exact_lathe_liquid(vessel.object("generate", read_lathe), object.at("to").number(), meniscus);
  });
}

template <class Shape>
Mesh made(const Shape& shape, Mesh (*make)(const Shape&), bool checks) {
  return checks ? Mesh() : make(shape);
}

/// Generates the mesh; without `read_picture`, only checks the recipe.
Mesh follow(const JsonValue& recipe, const JsonValue& meshes, const ReadPicture& read_picture) {
  const bool checks = !read_picture;
  const std::string type = recipe.type();
  try {
    return recipe.object("generate", [&](JsonObject& object) {
      if (type == "lathe") return made(read_lathe(object), make_lathe, checks);
      if (type == "extrusion") return made(read_extrusion(object), make_extrusion, checks);
      if (type == "sweep") return made(read_sweep(object), make_sweep, checks);
      if (type == "terrain") return made(read_terrain(object, read_picture), make_terrain, checks);
      if (type == "fill") return read_fill(object, meshes, checks);
      return read_ice_block(object, checks);
    });
  } catch (const GenerateError& error) {
    recipe.fail(error.what());
  }
}

}  // namespace

Mesh generate_mesh(const JsonValue& recipe, const JsonValue& meshes, const ReadPicture& read_picture) {
  return follow(recipe, meshes, read_picture);
}

ExactLathe read_exact_lathe(JsonObject& object, const JsonValue* meshes) {
  const auto name = object.find("mesh");
  Lathe lathe;
  object.read("curve", lathe.curve);
  try {
    if (!name) {
      lathe.profile = read_profile(object.at("profile"));
      return exact_lathe(lathe);
    }
    const auto mesh = meshes ? meshes->json().find(name->text()) : nlohmann::json::const_iterator();
    static const nlohmann::json::json_pointer place("/generate/type");
    const bool generated = meshes && mesh != meshes->json().end() && mesh->contains(place);
    if (!generated || (mesh->at(place) != "lathe" && mesh->at(place) != "fill"))
      name->fail(fmt::format(
          "\"{}\" is no lathe; wanted the name of a mesh that a \"lathe\" or its \"fill\" generates",
          name->text()));
    return follow_exactly(meshes->member(name->text(), "a mesh").member("generate", "a recipe"), *meshes);
  } catch (const GenerateError& error) {
    (name ? *name : object.value()).fail(error.what());
  }
}

void check_recipe(const JsonValue& recipe, const JsonValue& meshes) { follow(recipe, meshes, {}); }

std::string recipe_key(const JsonValue& recipe, const JsonValue& meshes) {
  std::string key = json_text(recipe.json());
  if (recipe.type() == "fill")
    key += json_text(find_vessel(recipe.member("vessel", "a mesh"), meshes).json());
  return key;
}

}  // namespace sundog
