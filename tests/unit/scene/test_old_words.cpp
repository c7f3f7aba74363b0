// Words that scenes were once written with are read as the ones of today.
#include <compile/compiled_scene.h>
#include <render/film/hash.h>

#include "catch.h"
#include "scene_text.h"

using namespace sundog;

namespace {

std::uint64_t hash_of(const std::string& object) {
  const std::string text =
      R"({"materials": {"m": {}}, "objects": [{"type": "fractal", "material": "m", )" + object + "}]}";
  return hash_scene(compile(load_scene_text(text)));
}

}  // namespace

TEST_CASE("old names of surfaces and of their parameters give the same tables to the bit") {
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {R"("formula": "box", "parameters": {"half": [1, 0.5, 0.7]})",
       R"("formula": "box", "parameters": {"size": [1, 0.5, 0.7]})"},
      {R"("formula": "round_box", "parameters": {"half": [1, 0.5, 0.7], "radius": 0.1})",
       R"("formula": "rounded_box", "parameters": {"size": [1, 0.5, 0.7], "rounding": 0.1})"},
      {R"("formula": "ellipsoid", "parameters": {"half": [1, 0.5, 0.7]})",
       R"("formula": "ellipsoid", "parameters": {"size": [1, 0.5, 0.7]})"},
      {R"("formula": "lattice", "parameters": {"half": [0.2, 0.2, 0.3], "radius": 0.04})",
       R"("formula": "lattice", "parameters": {"size": [0.2, 0.2, 0.3], "rounding": 0.04})"},
      {R"("formula": "torus", "parameters": {"major_radius": 0.9, "minor_radius": 0.2})",
       R"("formula": "torus", "parameters": {"major": 0.9, "minor": 0.2})"},
      {R"("formula": "torus_knot", "parameters": {"major_radius": 0.9, "minor_radius": 0.3})",
       R"("formula": "torus_knot", "parameters": {"major": 0.9, "minor": 0.3})"},
      {R"("formula": "cylinder", "parameters": {"half_height": 0.6})",
       R"("formula": "cylinder", "parameters": {"height": 0.6})"},
      {R"("formula": "capsule", "parameters": {"half_height": 0.6})",
       R"("formula": "capsule", "parameters": {"height": 0.6})"}};
  for (const auto& [now, once] : pairs) {
    CAPTURE(now, once);
    CHECK(hash_of(now) == hash_of(once));
  }
  CHECK(hash_of(pairs[0].first) != hash_of(R"("formula": "box", "parameters": {"half": [1, 0.5, 0.8]})"));
}

TEST_CASE("a parameter that a surface has not is refused, with the nearest one") {
  const std::string text = R"({"materials": {"m": {}}, "objects": [{"type": "fractal", "material": "m",
    "formula": "box", "parameters": {"hafl": 1}}]})";
  CHECK_THROWS_WITH(load_scene_text(text), ContainsSubstring("did you mean \"half\"?"));
}
