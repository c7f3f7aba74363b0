// The viewer's path of the camera: its views are kept as tracks of the scene, and it plays.
#include <nlohmann/json.hpp>

#include "catch.h"
#include "viewing.h"

using nlohmann::json;

TEST_CASE("keeping a view changes the path's own tracks alone, and their keys at that frame alone") {
  Viewer& v = viewer();
  v.tab("camera");
  v.run(R"(store.set('/animate', [
    {type: 'linear', value: '/camera/position', keys: [0, 10, 20].map((frame) => ({frame, value: [frame, 1, 5]}))},
    {type: 'linear', value: '/camera/fov', keys: [{frame: 0, value: 40}]},
    {type: 'bezier', value: '/camera/target', keys: [{frame: 0, value: [0, 1, 0], handle_right: {frame: 9, value: [0, 1, 0]}}, {frame: 20, value: [3, 1, 0]}]}]))");
  v.settle();
  const json before = v.run("return store.state.document.animate");
  v.press("Keep this view");
  v.settle();
  json after = v.run("return store.state.document.animate");
  CHECK(after[0]["keys"].back()["frame"] == 44);
  CHECK(after[2]["keys"].back()["frame"] == 44);
  for (const int own : {0, 2}) after[own]["keys"].erase(after[own]["keys"].size() - 1);
  CHECK(after == before);
  // The views between keys are those that a render has.
  CHECK(
      v.run(
          "const {viewsOf} = await import('/panels/path.js'); const view = viewsOf(store.state.document)[1]; "
          "return [view.frame, view.position]") == json::parse("[10, [10, 1, 5]]"));
  v.press("Clear");
  v.settle();
  CHECK(v.run("return store.state.document.animate") == json::array({before[1]}));
  v.run("store.set('/animate', [{type: 'rotate', value: '/camera/position', last: 120}])");
  v.settle();
  CHECK(v.run("return [...document.querySelectorAll('button')].find((b) => b.textContent === 'Keep this "
              "view').disabled") == true);
  CHECK(v.run("return [...document.querySelectorAll('.hint')].some((h) => "
              "h.textContent.includes('/animate/0 moves the camera too'))") == true);
  v.undo_all();
}

TEST_CASE("a path plays as many frames a second as the scene says") {
  Viewer& v = viewer();
  v.tab("camera");
  v.run(R"(store.set('/frames_per_second', 1);
    store.set('/animate', [{type: 'linear', value: '/camera/position', keys: [0, 90].map((frame) => ({frame, value: [frame, 1, 5]}))}]))");
  v.settle();
  v.press("Play");
  v.wait("return store.state.document.camera.position[0] > 0");
  CHECK(v.run("await new Promise((r) => setTimeout(r, 1000)); return store.state.document.camera.position[0]")
            .get<double>() < 20);
  v.press("Stop");
  v.undo_all();
}
