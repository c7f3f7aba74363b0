// The viewer's page and its server have one document: after every edit, however fast, and from two pages.
#include <nlohmann/json.hpp>
#include <string>

#include "catch.h"
#include "viewing.h"

using nlohmann::json;

namespace {

/// A walk through edits of every kind: `rounds` times one to four of them at once. What differs afterwards.
constexpr const char* random_walk = R"(
  const {equal} = await import('/pointer.js');
  let seed = args[0];
  const random = (n) => {
    seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff;
    return (seed >> 8) % n;
  };
  const some = (list) => random(Math.max(1, list?.length ?? 0));
  const doc = () => store.state.document;
  const edits = [
    () => store.set('/lights/-', {type: 'point', position: [random(9), 3, 1], intensity: random(50) / 10}),
    () => store.set('/lights/' + some(doc().lights), undefined),
    () => doc().lights?.length && store.set(`/lights/${some(doc().lights)}/intensity`, random(100) / 10),
    () => store.set('/lights', random(3) ? [{type: 'ambient'}, {type: 'point', position: [1, 2, 3]}] : undefined),
    () => store.edit([{at: '/objects/-', value: {type: 'sphere', material: 'red', name: 'ball ' + random(1000)}}]),
    () => doc().objects.length > 1 && store.set('/objects/' + some(doc().objects), undefined),
    () => store.set(`/objects/${some(doc().objects)}/name`, 'thing ' + random(1000)),
    () => store.set('/materials/more ' + random(4), random(2) ? {color: [0.5, random(10) / 10, 0.5]} : undefined),
    () => store.set('/materials/red', random(2) ? undefined : {color: [0.8, 0.2, random(10) / 10]}),
    () => { for (let i = 0; i < 5; ++i) store.set('/camera/fov', 20 + random(60), 'turn' + args[0]); },
    () => store.set('/camera/fov', 1000),
    () => store.set('/image/background', random(2) ? [0.1, random(10) / 10, 0.3] : undefined),
    () => store.undo(),
    () => store.redo(),
  ];
  const differences = [];
  for (let round = 0; round < args[1] && differences.length === 0; ++round) {
    const done = [];
    for (let i = random(4); i >= 0; --i) {
      done.push(random(edits.length));
      edits[done.at(-1)]();
    }
    if (args[2]) continue;  // another page edits as well: they are compared in the end
    for (let i = 0; i < 2000 && !store.edits.idle; ++i) await new Promise((r) => setTimeout(r, 2));
    const server = await store.link.json('scene');
    if (!store.edits.idle || !equal(store.state.document, server))
      differences.push({round, done, page: store.state.document, server, idle: store.edits.idle});
  }
  return differences;)";

std::string light_intensities(Viewer& v, const std::string& document) {
  return v.run("const d = " + document +
               "; return d.lights.map((l) => `${l.type} ${l.intensity ?? 'default'}`).join(', ')");
}

}  // namespace

TEST_CASE("page and server have the same document after every edit of a random walk") {
  Viewer& v = viewer();
  for (int seed = 1; seed <= 12; ++seed) {
    INFO("seed " << seed);
    CHECK(v.run(random_walk, {seed, 5, false}) == json::array());
  }
  v.open_again();
}

TEST_CASE("two pages that edit at the same time end with one document, the server's") {
  Viewer& v = viewer();
  v.browser.open_tab(v.served.url);
  v.settle();
  const std::string idle = "return store.edits.idle && store.state.connected === 'yes'";
  v.run("window.walked = (async (args) => {" + std::string(random_walk) + "})([6, 8, true]); return 1");
  v.browser.use_tab(0);
  v.run(random_walk, {7, 8, true});
  v.wait(idle);
  v.browser.use_tab(v.browser.tabs() - 1);
  v.wait(idle);
  const char* same =
      "const {equal} = await import('/pointer.js'); return equal(store.state.document, await "
      "store.link.json('scene'))";
  CHECK(v.run(same) == true);
  v.browser.use_tab(0);
  CHECK(v.run(same) == true);
  v.open_again();
}

TEST_CASE("a light is added and removed once, and the light that is named is the one that changes") {
  Viewer& v = viewer();
  const std::string page = "store.state.document", server = "await store.link.json('scene')";
  v.tab("light");
  v.press("Add light");
  v.wait("return store.edits.idle && store.state.document.lights.length === 3");
  CHECK(light_intensities(v, server) == light_intensities(v, page));
  v.press("Remove");  // the first one
  v.wait("return store.edits.idle && store.state.document.lights.length === 2");
  v.run("store.set('/lights/0/intensity', 3)");
  v.wait("return store.edits.idle");
  CHECK(light_intensities(v, page).starts_with("point 3, point "));
  CHECK(light_intensities(v, server) == light_intensities(v, page));
  v.open_again();
  // The list itself may be missing.
  v.run("store.set('/lights', undefined); store.set('/lights/-', {type: 'ambient'})");
  v.wait("return store.edits.idle");
  CHECK(light_intensities(v, page) == "ambient default");
  CHECK(light_intensities(v, server) == "ambient default");
  v.open_again();
}

TEST_CASE("an undo that follows edits at once takes back the last of them") {
  Viewer& v = viewer();
  const json after = v.run(R"(
    store.set('/camera/fov', 31);
    store.set('/camera/fov', 32);
    store.undo();
    while (!store.edits.idle) await new Promise((r) => setTimeout(r, 5));
    const first = store.state.document.camera.fov;
    store.set('/camera/fov', 5000);
    store.undo();  // of what is refused
    while (!store.edits.idle) await new Promise((r) => setTimeout(r, 5));
    return [first, store.state.document.camera.fov];)");
  CHECK(after == json({31, 31}));
  v.open_again();
}

TEST_CASE("edits of two pages are steps of their own, also by gestures of one name") {
  Viewer& v = viewer();
  v.browser.open_tab(v.served.url);
  v.settle();
  v.run("store.set('/camera/fov', 41, 'slide1')");
  v.settle();
  v.browser.use_tab(0);
  v.settle();
  v.run("store.set('/render/max_depth', 2, 'slide1')");
  v.settle();
  v.run("store.undo()");
  v.settle();
  CHECK(v.run("return [store.state.document.camera.fov, store.state.document.render.max_depth]") ==
        json({41, 3}));
  v.open_again();
}
