// Transforms and motion that a scene file may not hold: each error names the place and what was wanted.
#include "bad_scenes.h"
#include "catch.h"

using namespace bad_scenes;

TEST_CASE("bad transforms are refused with their place") {
  const auto transform = [](const std::string& list, const std::string& place, std::vector<std::string> words,
                            bool schema = true) {
    return sphere(R"("transform": )" + list, "/transform" + place, std::move(words), schema);
  };
  check({
      transform("{}", "", {"wanted an array of transforms", "found an object"}),
      transform("[{}]", "/0", {"wanted one of", "\"translate\"", "\"matrix\"", "found none"}),
      transform(R"([{"translate": [0, 0, 0], "scale": 2}])", "/0", {"found \"translate\" and \"scale\""}),
      transform(R"([{"rotation": 3}])", "/0/rotation", {"unknown key", "did you mean \"rotate\"?"}),
      transform(R"([{"rotate": {"degrees": 30}}])", "/0/rotate", {"missing key \"axis\""}),
      transform(R"([{"rotate": {"axis": [0, 0, 0], "degrees": 30}}])", "/0/rotate/axis", {"not all 0"}),
      transform(R"([{"rotate": {"axis": [0, 1e-13, 0], "degrees": 30}}])", "/0/rotate/axis", {"length 0"},
                false),
      transform(R"([{"rotate": {"quaternion": [0, 0, 0, 0]}}])", "/0/rotate/quaternion", {"not all 0"}),
      transform(R"([{"scale": 2}, {"scale": 0}])", "/1/scale", {"not 0", "found 0"}),
      transform(R"([{"scale": [1, 0, 1]}])", "/0/scale/1", {"not 0", "found 0"}),
      transform(R"([{"scale": "2"}])", "/0/scale", {"a factor", "found the string \"2\""}),
      transform(R"([{"matrix": [1, 0, 0, 0]}])", "/0/matrix", {"16 numbers", "4 items"}),
      transform(R"([{"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,5,5,1]}])", "/0/matrix", {"last row is 0 0 0 1"},
                false),
      transform(R"([{"matrix": [1,2,0,0, 2,4,0,0, 0,0,1,0, 0,0,0,1]}])", "/0", {"singular"}, false),
      transform(R"([{"matrix": [1,2,3,0, 4,5,6,0, 7,8,9,0, 0,0,0,1]}])", "/0", {"singular"}, false),
      transform(R"([{"scale": 1e10}, {"scale": 1e10}])", "", {"range of floats"}, false),
      transform(R"([{"scale": 1e-10}, {"scale": 1e-10}])", "", {"singular"}, false),
      object(R"({"type": "group", "transform": [{"scale": 1e-9}], "material": "m", "objects": [
                 {"type": "sphere", "transform": [{"scale": 1e-9}]}]})",
             "/objects/0/transform", {"singular"}, false),
      sphere(R"("turns_by": {"degrees": 10})", "/turns_by", {"axis"}),
      sphere(R"("turns_by": {"axis": [0, 0, 0], "degrees": 10})", "/turns_by/axis", {"not all 0"}),
      sphere(R"("turns_by": {"axis": [0, 1, 0], "degrees": 1e6})", "/turns_by/degrees", {"36000"}),
      sphere(R"("turns_by": 10)", "/turns_by", {"object"}),
      sphere(R"("grows_to": 0)", "/grows_to", {"0.001", "found 0"}),
  });
}
