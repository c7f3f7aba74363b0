// Scenes whose fog or medium without end takes all light of the sun: a warning says so, with the mend.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "catch.h"
#include "scene/json/parse.h"
#include "scene/read/scene_reader.h"

using namespace sundog;

namespace {

/// The warnings of a scene with these sections.
std::string warnings_of(const std::string& sections) {
  const nlohmann::json document = parse_json(
      R"({"materials": {"m": {}}, "objects": [{"type": "sphere", "material": "m"}], )" + sections + "}",
      "test.json");
  const JsonContext context{"test.json"};
  std::string all;
  for (const std::string& warning : read_scene(JsonValue(document, context)).warnings) all += warning + "\n";
  return all;
}

const std::string
    path = R"("render": {"integrator": "path"}, )",
    whitted = R"("render": {"integrator": "whitted"}, )",
    fog = R"("world": {"fog": {"color": [0.75, 0.75, 0.75], "density": 0.08, "anisotropy": 0.6}}, )",
    plain_fog = R"("world": {"fog": {"density": 0.08}}, )",
    medium = R"("media": {"haze": {"absorption": [0, 0, 0.5]}}, "world": {"medium": "haze"}, )",
    sun = R"("lights": [{"type": "directional", "direction": [0, -1, 0]}])",
    sky = R"("environment": {"type": "sky"})",
    lamp = R"("lights": [{"type": "point", "position": [0, 3, 0]}])";

}  // namespace

TEST_CASE(
    "fog or a medium without end before a sun or a sky is warned of, with a box of the same in its place") {
  for (const std::string& light : {sun, sky}) {
    const std::string found = warnings_of(path + fog + light);
    CHECK(found.find("/world/fog: ") == 0);
    CHECK(found.find("\"scattering\": [0.06, 0.06, 0.06], \"absorption\": [0.02, 0.02, 0.02]") !=
          std::string::npos);
    CHECK(warnings_of(path + medium + light).find("/world/medium: ") == 0);
    CHECK(warnings_of(whitted + medium + light).find("/world/medium: ") == 0);
    CHECK(warnings_of(path + plain_fog + light).empty());
    CHECK(warnings_of(whitted + fog + light).empty());  // its own colour is all that it has there
    CHECK(warnings_of(path + light).empty());
  }
  CHECK(warnings_of(path + fog + lamp).empty());
}
