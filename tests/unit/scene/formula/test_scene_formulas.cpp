// Formulas that are hostile, or simply wrong, in a scene file: each is refused before anything is built, with
// its object and key, and inside the text with line and column.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "catch.h"
#include "formula/evaluate.h"
#include "scene_text.h"

using namespace sundog;

namespace {

std::string repeated(std::string_view part, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += part;
  return text;
}

/// A scene of one formula with these members besides its type, material and interval.
std::string scene_of_formula(const nlohmann::json& members) {
  nlohmann::json object{
      {"type", "formula"}, {"material", "m"}, {"interval", {{"min", {-1, -1, -1}}, {"max", {1, 1, 1}}}}};
  object.update(members);
  return scene_of(object.dump());
}

void check_refused(const nlohmann::json& members, const std::string& place, const std::string& words) {
  INFO(members.dump().substr(0, 200));
  const SceneError error = error_of(scene_of_formula(members));
  CHECK(error.place == "/objects/0" + place);
  CHECK(error.reason.find(words) != std::string::npos);
  CHECK(error.reason.find('\n') == std::string::npos);
  CHECK(error.reason.size() < 300);
}

void check_map_refused(const nlohmann::json& map, const std::string& words) {
  check_refused({{"map", map}}, "/map", words);
}

}  // namespace

TEST_CASE("a long text in the place of a formula's name is not quoted whole") {
  const std::string formula = "z = z ^ 2 + c; " + std::string(300, 'z');
  const auto load = [&] {
    load_scene_text(R"({"objects": [{"type": "fractal", "formula": ")" + formula + R"("}]})");
  };
  CHECK_THROWS_WITH(load(), ContainsSubstring("wanted the name of a surface of the list") &&
                                ContainsSubstring("z = z ^ 2") && !ContainsSubstring(std::string(100, 'z')));
}

TEST_CASE("a formula in a scene is accepted as one string or as lines") {
  CHECK(load_scene_text(scene_of_formula({{"map", "z = z ^ 8 + c"}})).fields.size() == 1);
  CHECK(load_scene_text(scene_of_formula({{"map", {"t = 8", "", "z = z ^ 8 + c"}}})).fields.size() == 1);
}

TEST_CASE("a distance that has statements alone, or nothing but a comment, wants an expression") {
  for (const char* text : {" ", "// x", "a = p"})
    check_refused({{"distance", text}}, "/distance", "expected");
}

TEST_CASE("an error in a scene's formula names the line of the array and the column in it") {
  check_map_refused({"t = 1", "z = (z +", "  y)"}, "line 3, column 3: unknown name 'y'");
  check_map_refused({"t = 1", "", "z = z + y"}, "line 3, column 9: unknown name 'y'");
  check_map_refused("z = z + c.w", "line 1, column 10: ");
}

TEST_CASE("a scene's formula cannot run without bounds") {
  check_refused({{"map", "z = z ^ 8 + c"}, {"iterations", 1000000000}}, "/iterations", "from 1 to 1000");
  check_refused({{"map", "z = z ^ 8 + c"}, {"iterations", -1}}, "/iterations", "from 1 to 1000");
  check_refused({{"map", "z = z ^ 8 + c"}, {"bailout", 0}}, "/bailout", "found 0");
  check_refused({{"map", "z = z ^ 8 + c"}, {"bailout", 1e39}}, "/bailout", "1e+39");
  check_refused({{"map", "z = z ^ 8 + c"}, {"interval", {{"min", {-1e30, -1, -1}}, {"max", {1, 1, 1}}}}},
                "/interval/min/0", "-1e+30");
  check_map_refused(repeated("z = z + c\n", 300), "200 statements");
}

TEST_CASE("a scene's formula that yields no number, or one value everywhere, is refused") {
  check_map_refused("z = z / 0", "line 1, column 7: division by zero");
  check_map_refused("z = z / (length(z) - length(z))", "division by zero");
  check_map_refused("z = z + sqrt(-1)", "not defined at -1");
  check_refused({{"map", "z = c * 0"}}, "", "escape from none");
  check_refused({{"map", "z = z * (sqrt(z.x - 100) / sqrt(z.x - 100)) + c"}}, "", "escape from none");
}

TEST_CASE("a scene's formula carries no code, whatever it is called") {
  check_map_refused({"#include \"secret.h\"", "z = z"}, "line 1, column 1: ");
  check_map_refused({"kernel = 1", "z = z"}, "line 1, column 1: 'kernel' is a reserved word");
  check_map_refused("z = z; } __kernel void x() {", "line 1, column 8: ");
  check_map_refused(std::string("z = z\0+ c", 9), "line 1, column 6: unexpected character");
  for (const char* name : {"__global", "float4", "get_global_id", "z", "a b", ""})
    check_refused({{"map", "z = z + c"}, {"parameters", {{name, 1}}}}, "/parameters/" + std::string(name),
                  "");
}

TEST_CASE("a scene's formula that is no text is refused") {
  check_refused({{"map", 3}}, "/map", "wanted a text or an array of its lines, found 3");
  check_map_refused("z = z + max(z.x)", "is called as max(a, b), found 1 argument");
}

TEST_CASE("a scene's formula too deep or too long is refused") {
  check_map_refused("z = " + repeated("(", 1000) + "z" + repeated(")", 1000), "nested deeper than 64");
  check_map_refused("z = z" + repeated(" + c", 5000), "8192 characters");
  check_map_refused(nlohmann::json(std::vector<std::string>(5000, "z = z + c")), "8192 characters");
  check_map_refused("z = z + " + repeated("a", 100), "32 characters");
}

TEST_CASE("a formula that its default interval cuts says so, and no other does") {
  const auto warnings = [](const std::string& members) {
    return load_scene_text(scene_of(R"({"type": "formula", "material": "m", )" + members + "}")).warnings;
  };
  const auto cut = warnings(R"("distance": "length(p - vec3(1, 0, 0)) - 0.8")");
  REQUIRE(cut.size() == 1);
  CHECK(cut[0].find("from -1.5 to 1.5") != std::string::npos);
  CHECK(cut[0].find("set \"interval\"") != std::string::npos);
  CHECK(warnings(R"("distance": "length(p) - 1.4")").empty());
  CHECK(warnings(R"("map": "z = z ^ 8 + c")").empty());
  CHECK(warnings(R"("distance": "length(p - vec3(1, 0, 0)) - 0.8",
                    "interval": {"min": [-1, -1, -1], "max": [1, 1, 1]})")
            .empty());
  CHECK(load_scene_text(scene_of(R"({"type": "fractal", "formula": "gyroid", "material": "m"})"))
            .warnings.empty());
}

TEST_CASE("a map of one's own estimates as the listed one of the same text, at any bailout") {
  const auto field = [](const std::string& members) {
    return load_scene_text(scene_of(R"({"material": "m", "iterations": 16, "safety": 1, )" + members + "}"))
        .fields.at(0)
        .root.formula;
  };
  for (const char* bailout : {"16", "1000"}) {
    const std::string options = fmt::format(R"(, "bailout": {})", bailout);
    FormulaEvaluator own(field(R"("type": "formula", "map": "z = z ^ 8 + c")" + options));
    FormulaEvaluator listed(field(R"("type": "fractal", "formula": "mandelbulb")" + options));
    for (const glm::dvec3& p : {glm::dvec3(1.2, 0.1, 0.3), {0.1, 0.2, -1.1}, {-0.7, 0.6, 0.5}})
      CHECK(own.at(p).distance == Approx(listed.at(p).distance));
  }
}

TEST_CASE("only a single map without folds takes the radial derivative by itself") {
  const auto derivative = [](const std::string& members) {
    return load_scene_text(scene_of(R"({"material": "m", )" + members + "}"))
        .fields.at(0)
        .root.formula.steps.at(0)
        .definition.derivative;
  };
  using enum FormulaDerivative;
  CHECK(derivative(R"("type": "formula", "map": "z = z ^ 8 + c")") == radial);
  CHECK(derivative(R"("type": "formula", "map": "z = z ^ 8 + c", "derivative": "running")") == running);
  CHECK(derivative(R"f("type": "formula", "map": ["z = boxfold(z, 1)", "z = z ^ 3 + c"])f") == automatic);
  CHECK(derivative(R"f("type": "formula", "map": ["z = abs(z)", "z = z ^ 3 + c"])f") == automatic);
  CHECK(derivative(R"f("type": "formula", "map": "z = z ^ 2 + vec3(sin(z.x), z.y, z.z) + c")f") == automatic);
  CHECK(derivative(R"("type": "hybrid", "steps": [{"type": "formula", "map": "z = z ^ 3 + c"}])") ==
        automatic);
}

TEST_CASE("exact solids are operands of fields: their distances are those of the solids") {
  struct Case {
    std::string solid;
    glm::dvec3 at;
    double distance;
  };
  for (const Case& c :
       {Case{R"("type": "sphere", "radius": 0.5, "center": [1, 0, 0])", {3, 0, 0}, 1.5},
        Case{R"("type": "box", "min": [0, 0, 0], "max": [1, 2, 3])", {0.5, 2.25, 1}, 0.25},
        Case{R"("type": "round_box", "half": 1, "radius": 0.2)", {0, 3, 0}, 2},
        Case{R"("type": "cylinder", "from": [0, 0, 0], "to": [2, 0, 0], "radius": 0.5)", {1, 0, 2}, 1.5},
        Case{R"("type": "cone", "bottom_radius": 1, "top_radius": 1, "height": 2)", {0, 0.5, 0}, -0.5},
        Case{R"("type": "cone", "bottom_radius": 1, "top_radius": 0, "height": 1)", {1, 0.5, 0}, 0.70710678},
        Case{R"("type": "torus", "major_radius": 1, "minor_radius": 0.25, "axis": [1, 0, 0])",
             {0, 0, 1},
             -0.25},
        Case{R"("type": "plane", "point": [0, 0.5, 0])", {7, 3, 0}, 2.5},
        Case{R"("type": "sphere", "transform": [{"scale": 2}, {"translate": [0, 1, 0]}])", {0, 4, 0}, 1}}) {
    INFO(c.solid);
    const auto scene = load_scene_text(scene_of(
        R"({"type": "difference", "material": "m", "interval": {"min": [-9, -9, -9], "max": [9, 9, 9]},
            "fields": [{)" +
        c.solid + R"(}, {"type": "sphere", "name": "hole", "radius": 0.1}]})"));
    CHECK(scene.warnings.empty());
    const SdfNode& moved = scene.fields.at(0).root.children.at(0);
    const glm::dvec3 p = glm::transpose(moved.rotation) * (c.at - moved.offset) / moved.scale;
    CHECK(FormulaEvaluator(moved.children.at(0).formula).at(p).distance * moved.scale ==
          Approx(c.distance).margin(1e-7));
  }
  const auto refused = [](const std::string& solid) {
    return error_of(scene_of(
        R"({"type": "union", "material": "m", "interval": {"min": [-9, -9, -9], "max": [9, 9, 9]},
            "fields": [{"type": "sphere"}, )" +
        solid + "]}"));
  };
  CHECK(refused(R"({"type": "cylinder", "capped": false})").reason.find("no inside") != std::string::npos);
  CHECK(refused(R"({"type": "disk"})").reason.find("no inside") != std::string::npos);
  CHECK(refused(R"({"type": "box", "transform": [{"scale": [1, 2, 1]}]})").place ==
        "/objects/0/fields/1/transform");
  CHECK(refused(R"({"type": "box", "material": "m"})").reason.find("whole field") != std::string::npos);
}
