// Reads recipes of generated meshes and calls their generators.
#include "scene/procedural/procedural.h"

#include "scene/procedural/ice_block.h"

namespace sundog {

namespace {

IceSurface read_surface(JsonObject& object, IceSurface surface) {
  object.read("size", surface.size, "chips", surface.chips, "dents", surface.dents);
  object.read("softness", surface.softness, "tilt", surface.tilt, "roughness", surface.roughness);
  return surface;
}

IceSurface read_cavity(JsonObject& object, const IceSurface& outer) {
  // By default the cavity is like the outside, at 0.6 of its size.
  IceSurface cavity = outer;
  cavity.size *= 0.6;
  cavity = read_surface(object, cavity);
  object.read("offset", cavity.offset);
  return cavity;
}

/// Of a recipe that is only checked the mesh is empty.
Mesh read_ice_block(JsonObject& object, bool checks) {
  IceBlock block;
  std::string part;
  object.read("seed", block.seed, "subdivision", block.subdivision, "part", part);
  block.outer = read_surface(object, block.outer);
  if (const auto cavity = object.find("cavity")) {
    block.hollow = true;
    block.cavity = cavity->object("generate_ice_cavity",
                                  [&](JsonObject& inner) { return read_cavity(inner, block.outer); });
  }
  if (part == "ice") return checks ? Mesh() : make_ice(block);
  const double level = object.at("level").number();
  double wall = 0;
  object.read("wall", wall);
  return checks ? Mesh() : make_ice_liquid(block, level, wall);
}

Mesh follow(const JsonValue& recipe, bool checks) {
  recipe.type();
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
