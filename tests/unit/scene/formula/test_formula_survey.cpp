// A scene's formula is measured when it is read: what is no distance is made one, once, with a warning that
// names the place; what cannot look as it was meant is reported.
#include <nlohmann/json.hpp>

#include "catch.h"
#include "scene_text.h"

using namespace sundog;

namespace {

SceneDescription scene_of_formula(const nlohmann::json& members) {
  nlohmann::json object{{"type", "formula"},
                        {"material", "m"},
                        {"interval", {{"min", {-1.2, -1.2, -1.2}}, {"max", {1.2, 1.2, 1.2}}}}};
  object.update(members);
  return load_scene_text(scene_of(object.dump()));
}

double safety_of(const SceneDescription& scene) { return scene.fields.at(0).root.formula.safety; }

bool says(const SceneDescription& scene, const std::string& place, const std::string& words) {
  INFO(words);
  for (const std::string& warning : scene.warnings) {
    CHECK(warning.find('\n') == std::string::npos);
    if (warning.find("scene.json: /objects/0" + place + ": ") != std::string::npos &&
        warning.find(words) != std::string::npos)
      return true;
    UNSCOPED_INFO(warning);
  }
  return false;
}

}  // namespace

TEST_CASE("an expression that changes faster than a distance is taken times what makes it one, said once") {
  const auto steep = scene_of_formula({{"distance", "10 * (length(p) - 0.8)"}});
  CHECK(safety_of(steep) == Approx(0.098));
  CHECK(steep.warnings.size() == 1);
  CHECK(says(steep, "/distance", "changes by 10 a unit of length"));
  CHECK(says(steep, "/distance", "a factor of 0.098"));

  const auto waves = scene_of_formula({{"distance", "length(p) - 0.8 + 0.2 * sin(40 * p.x)"}});
  CHECK(safety_of(waves) <= 1 / 9.0);
  CHECK(safety_of(waves) >= 0.95 / 9.0);
  CHECK(waves.fields[0].step_limit > 1000);

  const auto quartic = scene_of_formula({{"distance", "p.x^4 + p.y^4 + p.z^4 - 0.5"}});
  CHECK(safety_of(quartic) <= 1 / (4 * 1.2 * 1.2 * 1.2 * std::sqrt(3.0)));
  CHECK(safety_of(quartic) >= 0.95 / (4 * 1.2 * 1.2 * 1.2 * std::sqrt(3.0)));
}

TEST_CASE(
    "an expression that changes slower than a distance is taken times more, so that no surface is fat") {
  const auto scene = scene_of_formula({{"distance", "0.001 * (length(p) - 0.8)"}});
  CHECK(safety_of(scene) == Approx(980));
  CHECK(says(scene, "/distance", "changes by 0.001 a unit of length"));
}

TEST_CASE("a true distance is taken as it is, in silence") {
  for (const char* distance :
       {"length(p) - 0.8", "q = abs(p) - 0.5\nlength(max(q, 0)) + min(max(max(q.x, q.y), q.z), 0)",
        "length(wrap(p, 0.5)) - 0.1", "length(p - vec3(0.3, 0.2, 0.1)) - 0.01",
        "smooth_min(length(p) - 0.5, p.y + 0.4, 0.2)", "abs(length(p) - 1) - 0.001"}) {
    const auto scene = scene_of_formula({{"distance", distance}});
    INFO(distance);
    CHECK(safety_of(scene) == 1);
    CHECK(scene.warnings == std::vector<std::string>{});
  }
}

TEST_CASE("a safety that the scene sets is kept, and warned of where it is too great") {
  const auto fits = scene_of_formula({{"distance", "10 * (length(p) - 0.8)"}, {"safety", 0.1}});
  CHECK(safety_of(fits) == 0.1);
  CHECK(fits.warnings.empty());
  const auto too_great = scene_of_formula({{"distance", "10 * (length(p) - 0.8)"}, {"safety", 0.5}});
  CHECK(safety_of(too_great) == 0.5);
  CHECK(says(too_great, "/safety", "of 0.098 or less fits, found 0.5"));
}

TEST_CASE("a gradient without bound away from the surface costs nothing, a jump at the surface is refused") {
  const auto pole = scene_of_formula({{"distance", "log(length(p) / 0.8)"}});
  CHECK(safety_of(pole) >= 0.5);
  CHECK(safety_of(pole) <= 0.8);  // of its gradient at the surface
  const auto jump = error_of(scene_of(
      R"({"type": "formula", "material": "m", "distance": "p.x > 0 ? length(p) - 0.9 : length(p) - 0.5",
          "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]}})"));
  CHECK(jump.place == "/objects/0/distance");
  CHECK(jump.reason.find("jumps") != std::string::npos);
}

TEST_CASE("a folded formula's distance is measured where its orbits end") {
  const nlohmann::json map{"z = abs(z)", "z = 2 * z - vec3(1, 1, 1)"};
  const auto steep =
      scene_of_formula({{"map", map}, {"distance", "3 * (length(z) - 1.2)"}, {"iterations", 5}});
  CHECK(says(steep, "/distance", "changes by 3 a unit of length of z"));
  CHECK(safety_of(steep) <= 1 / 3.0);
  const auto fits = scene_of_formula({{"map", map}, {"distance", "length(z) - 1.2"}, {"iterations", 5}});
  CHECK(safety_of(fits) == 0.9);
  CHECK(fits.warnings.empty());
}

TEST_CASE("formulas inside operations are measured in their own part of space") {
  const auto scene = load_scene_text(scene_of(
      R"({"type": "union", "material": "m", "interval": {"min": [9, -2, -2], "max": [13, 2, 2]}, "fields": [
            {"type": "fractal", "formula": "sphere"},
            {"type": "moved", "translate": [11, 0, 0], "scale": 2,
             "field": {"type": "formula", "distance": "p.x * p.x + p.y * p.y + p.z * p.z - 0.5"}}]})"));
  const FormulaField& formula = scene.fields.at(0).root.children[1].children[0].formula;
  CHECK(formula.safety <= 1 / (2 * std::sqrt(3.0)));  // the corners lie 1 from its origin along each axis
  CHECK(formula.safety >= 0.95 / (2 * std::sqrt(3.0)));
  CHECK(says(scene, "/fields/1/field/distance", "changes by 3.46 a unit"));
}

TEST_CASE("a listed formula's parameters lower its safety where they must") {
  const auto scene = load_scene_text(scene_of(
      R"({"type": "fractal", "formula": "torus_knot", "material": "m", "parameters": {"turns": 11, "windings": 3}})"));
  const auto usual =
      load_scene_text(scene_of(R"({"type": "fractal", "formula": "torus_knot", "material": "m"})"));
  CHECK(usual.warnings.empty());
  CHECK(safety_of(usual) == 0.45);
  CHECK(safety_of(scene) < 0.4);
  CHECK(says(scene, "", "is too long at"));
}

TEST_CASE("an argument outside of its function's domain is reported with its place, its value and a point") {
  const auto map = scene_of_formula({{"map", {"t = 2", "z = vec3(log(z.x), z.y, z.z) ^ t + c"}}});
  CHECK(says(map, "/map", "line 2, column 10: log is asked for -"));
  const auto root = scene_of_formula({{"distance", "length(p) - 0.8 + 0.01 * sqrt(p.x)"}});
  CHECK(says(root, "/distance", "line 1, column 26: sqrt is asked for -"));
  CHECK(says(root, "/distance", "of 1024 points"));
  const auto power = scene_of_formula({{"distance", "length(p) - 0.8 + 0.01 * p.x ^ 2.5"}});
  CHECK(says(power, "/distance", "a power that is not whole is asked for -"));
  const auto guarded = scene_of_formula(
      {{"distance", "length(p) - 0.8 + 0.01 * (p.x > 0 ? sqrt(p.x + 1) : p.x < -1 ? 0 : sqrt(p.x + 1))"}});
  CHECK(guarded.warnings.empty());  // a branch that is not taken computes nothing
}

TEST_CASE("points without a number, and intervals without a surface, are reported with a point") {
  const auto lost = scene_of_formula({{"distance", "p.x > 0.5 ? exp(70 + p.x) * exp(70) : length(p) - 0.4"}});
  CHECK(says(lost, "", "no finite distance at"));
  CHECK(says(lost, "", "of 1024 points"));
  CHECK(says(scene_of_formula({{"distance", "length(p) + 5"}}), "/distance",
             "holds no surface: the least distance found is 5"));
  CHECK(says(scene_of_formula({{"distance", "length(p) - 5"}}), "/distance",
             "the whole interval is inside: the greatest distance found is -2.92"));
  CHECK(says(scene_of_formula({{"map", "z = z ^ 2 + c + vec3(9, 0, 0)"}}), "", "holds no surface"));
}

TEST_CASE("a linear estimate has as many iterations as keep its solid thin, and fewer are reported") {
  const auto menger = [](nlohmann::json members) {
    members["interval"] = {{"min", {-1.5, -1.5, -1.5}}, {"max", {1.5, 1.5, 1.5}}};
    members["map"] = {"z = abs(z)",
                      "z = z.x < z.y ? z.yxz : z",
                      "z = z.x < z.z ? z.zyx : z",
                      "z = z.y < z.z ? z.xzy : z",
                      "z = 3 * z - vec3(2, 2, 0)",
                      "z.z = z.z > 1 ? z.z - 2 : z.z"};
    members["estimate"] = "linear";
    return scene_of_formula(members);
  };
  const auto usual = menger({});
  CHECK(usual.fields.at(0).root.formula.iterations == 12);  // 1000 / 3^12 is 0.002, the interval 5.2 across
  CHECK_FALSE(says(usual, "", "thicker than the set"));
  const auto few = menger({{"iterations", 8}});
  CHECK(few.fields.at(0).root.formula.iterations == 8);
  CHECK(says(few, "/iterations", "thicker than the set by about 0.15: wanted 12 or more"));
  CHECK(menger({{"bailout", 4}}).fields.at(0).root.formula.iterations == 8);
  nlohmann::json half{{"type", "formula"}, {"map", "z = 2 * z - vec3(1, 0, 0)"}, {"estimate", "linear"}};
  const auto hybrid = scene_of_formula({{"type", "hybrid"}, {"steps", {half}}});
  CHECK(hybrid.fields.at(0).root.formula.iterations == 18);  // 1000 / 2^18 is 0.004, the interval 6.9 across
}

TEST_CASE("a map that scales is measured, and told to take the linear estimate; a power is not") {
  const auto scene = [](nlohmann::json members) {
    members["interval"] = {{"min", {-9, -9, -9}}, {"max", {9, 9, 9}}};
    return scene_of_formula(members);
  };
  const nlohmann::json box = "z = -1.5 * ballfold(boxfold(z, 1), 0.5, 1) + c";
  const auto unset = scene({{"map", box}});
  CHECK(says(unset, "/map", "set \"estimate\": \"linear\""));
  CHECK(safety_of(unset) < 0.6);
  // Orbits that escape by the last iterations measure the distance to a set as large as the bailout.
  const auto few = scene({{"map", box}, {"estimate", "linear"}, {"iterations", 20}});
  CHECK(says(few, "", "is too long at"));
  CHECK(safety_of(few) < 0.6);
  const auto listed = [](const std::string& iterations) {
    return load_scene_text(scene_of(R"({"type": "fractal", "formula": "mandelbox", "material": "m",
                                        "parameters": {"scale": -1.5}, "iterations": )" +
                                    iterations + "}"));
  };
  CHECK(safety_of(listed("20")) < 0.6);
  CHECK(listed("60").warnings.empty());
  CHECK(scene({{"map", box}, {"estimate", "linear"}, {"iterations", 60}}).warnings.empty());
  CHECK(scene({{"map", "z = i < 2 ? z ^ 8 + c : 2 * z"}}).warnings.empty());
  const auto hybrid = [&](const char* first) {
    const nlohmann::json other{{"type", "fractal"}, {"formula", first}},
        turn{{"type", "formula"}, {"map", "z = rotate(z, vec3(1, 1, 0), 0.3)"}};
    return scene({{"type", "hybrid"}, {"steps", {other, turn}}, {"iterations", 24}});
  };
  CHECK(says(hybrid("mandelbox"), "/steps/1/map", "set \"estimate\""));
  CHECK(hybrid("mandelbulb").warnings.empty());
}
