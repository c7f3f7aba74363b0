// The background gradient goes by the ray's elevation towards the camera's `up`.
#include "catch.h"
#include "compile/compiled_scene.h"

using namespace sundog;

TEST_CASE("the compiled scene knows the unit up that the background gradient goes by", "[compile]") {
  SceneDescription scene;
  scene.media.push_back({.name = "world"});
  scene.camera.up = {0, 3, 4};
  const float4 up = compile(scene).info.up;
  CHECK(up.x == 0);
  CHECK(up.y == Approx(0.6));
  CHECK(up.z == Approx(0.8));
}
