// sundog formulas: the list as text and as JSON.
#include <nlohmann/json.hpp>

#include "catch.h"
#include "run_command.h"

using nlohmann::json;

TEST_CASE("formulas prints at least twenty surfaces with their parameters, ranges, bounds and sources") {
  const CommandResult text = run_sundog({"formulas"}), list = run_sundog({"formulas", "--json"});
  CHECK(text.status == 0);
  CHECK(text.err.empty());
  CHECK(list.status == 0);
  const json all = json::parse(list.out);
  CHECK(all["schema"] == 1);
  CHECK(all["formulas"].size() >= 20);
  for (const json& formula : all["formulas"]) {
    const std::string name = formula["name"];
    INFO(name);
    CHECK(text.out.find(name + "\n    " + formula["title"].get<std::string>() +
                        "\n    source: " + formula["source"].get<std::string>()) != std::string::npos);
    CHECK(formula["safety"] > 0);
    CHECK(formula["interval"]["min"].size() == 3);
    for (const json& p : formula["parameters"]) {
      const std::vector<double> values = p["default"].is_array() ? p["default"].get<std::vector<double>>()
                                                                 : std::vector<double>{p["default"]};
      for (const double value : values) CHECK((value >= p["min"] && value <= p["max"]));
    }
  }
  for (const char* part :
       {"bound: the estimate times", "smooth_min(a, b, k)", "difference    fields, smooth"})
    CHECK(text.out.find(part) != std::string::npos);
  CHECK(all["operations"].size() == 8);
  CHECK(all["functions"].size() > 30);
}

TEST_CASE("formulas takes no scene") {
  const CommandResult result = run_sundog({"formulas", "scene.json"});
  CHECK(result.status == 2);
  CHECK(result.err.find("scene.json") != std::string::npos);
}
