// Reads recipes of generated meshes and calls their generators.
#include "scene/procedural/procedural.h"

#include "scene/procedural/ice_block.h"

namespace sundog {

namespace {

IceSurface read_surface(JsonObject& object, IceSurface surface) {
  surface.size = object.vec3("size", surface.size, {.low = 1e-6, .high = 1e6});
  surface.chips = object.integer("chips", surface.chips, 0, 1000);
  surface.dents = object.integer("dents", surface.dents, 0, 1000);
  surface.softness = object.integer("softness", surface.softness, 0, 4);
  surface.tilt = object.number("tilt", surface.tilt, {.low = 0, .high = 0.5});
  surface.roughness = object.number("roughness", surface.roughness, {.low = 0, .high = 0.2});
  return surface;
}

IceSurface read_cavity(JsonObject& object, const IceSurface& outer) {
  // By default the cavity is like the outside, at 0.6 of its size.
  IceSurface cavity = outer;
  cavity.size *= 0.6;
  cavity = read_surface(object, cavity);
  cavity.offset = object.vec3("offset", cavity.offset);
  return cavity;
}

/// Of a recipe that is only checked the mesh is empty.
Mesh read_ice_block(JsonObject& object, bool checks) {
  static constexpr std::string_view types[] = {"ice_block"}, parts[] = {"ice", "liquid"};
  object.choice("type", "ice_block", types);
  IceBlock block;
  block.seed = static_cast<std::uint64_t>(object.integer("seed", 1, 0, 2147483647));
  block.subdivision = object.integer("subdivision", block.subdivision, 4, 1024);
  block.outer = read_surface(object, block.outer);
  if (const auto cavity = object.find("cavity")) {
    block.hollow = true;
    block.cavity = cavity->object("generate_ice_cavity",
                                  [&](JsonObject& inner) { return read_cavity(inner, block.outer); });
  }
  if (object.choice("part", "ice", parts) == "ice") return checks ? Mesh() : make_ice(block);
  const double level = object.at("level", "the height of the liquid's surface").number();
  const double wall = object.number("wall", 0.5, {.low = 0.01, .high = 0.99});
  return checks ? Mesh() : make_ice_liquid(block, level, wall);
}

Mesh follow(const JsonValue& recipe, bool checks) {
  static constexpr std::string_view types[] = {"ice_block"};
  recipe.member("type", "a recipe with a \"type\"").choice(types);
  try {
    return recipe.object("generate_ice_block",
                         [&](JsonObject& object) { return read_ice_block(object, checks); });
  } catch (const GenerateError& error) {
    recipe.fail(error.what());
  }
}

}  // namespace

Mesh generate_mesh(const JsonValue& recipe) { return follow(recipe, false); }

void check_recipe(const JsonValue& recipe) { follow(recipe, true); }

}  // namespace sundog
