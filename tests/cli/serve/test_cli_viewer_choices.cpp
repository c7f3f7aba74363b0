// The viewer's panels offer what the server takes: each button that adds, each entry of each list.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "catch.h"
#include "viewing.h"

using nlohmann::json;

namespace {

/// Tries one button or list of a panel, each entry undone afterwards; what is refused, with the reason. Null:
/// there are no more.
constexpr const char* try_choices = R"(
  const refused = [];
  const wait = (ms) => new Promise((r) => setTimeout(r, ms));
  const idle = async () => { for (let i = 0; i < 400 && !store.edits.idle; ++i) await wait(5); await wait(20); };
  const unfold = async () => {
    while (document.querySelector('#panel details:not([open])')) {
      document.querySelectorAll('#panel details').forEach((d) => (d.open = true));
      await wait(30);
    }
  };
  const nameOf = (e) => e.getAttribute('aria-label') ?? e.closest('.row')?.querySelector('label')?.textContent ?? e.textContent;
  const tried = async (name, act) => {
    store.update({error: null});
    const version = store.state.version;
    act();
    await idle();
    if (store.state.error) refused.push(`${name}: ${store.state.error.reason}`);
    if (store.state.version === version) return;
    store.undo();
    await idle();
    await unfold();
  };
  await unfold();
  const adders = () => [...document.querySelectorAll('#panel button')].filter((b) => /^Add/.test(b.textContent));
  const lists = () => [...document.querySelectorAll('#panel select')];
  const at = args[0], list = lists()[at - adders().length];
  if (at < adders().length) await tried(nameOf(adders()[at]), () => adders()[at].click());
  else if (!list) return null;
  else for (const value of [...list.options].map((o) => o.value)) {
    const now = lists()[at - adders().length];
    if (now && now.value !== value) await tried(`${nameOf(now)} ${value}`, () => {
      now.value = value;
      now.dispatchEvent(new Event('change', {bubbles: true}));
    });
  }
  store.update({error: null});
  return refused;)";

/// Refusals in words that say what to do first.
bool says_what_is_wanted(const std::string& refusal) {
  return refusal.find("needs an image") != std::string::npos ||
         refusal.find("wanted the name of a mesh that a \\\"lathe\\\"") != std::string::npos ||
         refusal.find("wanted at least 8 \"samples\"") != std::string::npos;
}

}  // namespace

TEST_CASE("what a panel offers to add or to choose, the server takes") {
  Viewer& v = viewer();
  // A material is enough: another has the same lists.
  v.run("store.edit([{at: '/materials/floor'}, {at: '/objects/1/material', value: 'red'}])");
  v.settle();
  for (const char* tab : {"build", "camera", "light", "image"}) {
    v.tab(tab);
    int count = 0;
    for (json refused; !(refused = v.run(try_choices, {count})).is_null(); ++count)
      for (const json& refusal : refused) {
        INFO(tab << ": " << refusal);
        CHECK(says_what_is_wanted(refusal));
      }
    CHECK(count >= 3);
  }
  v.open_again();
}

TEST_CASE("an object of each type can be added, and a new lathe takes a spline") {
  Viewer& v = viewer();
  v.tab("build");
  const json refused = v.run(R"(
    const wait = (ms) => new Promise((r) => setTimeout(r, ms));
    const idle = async () => { for (let i = 0; i < 400 && !store.edits.idle; ++i) await wait(5); await wait(20); };
    const list = () => document.querySelector('[aria-label="Type of the new object"]');
    const refused = [];
    for (const type of [...list().options].map((o) => o.value)) {
      if (type === 'model') continue;  // it needs a file
      store.update({error: null});
      const version = store.state.version;
      list().value = type;
      list().dispatchEvent(new Event('change', {bubbles: true}));
      await wait(30);
      list().parentElement.querySelector('button').click();
      await idle();
      if (type === 'lathe') { store.set(store.state.selection + '/curve', 'spline'); await idle(); }
      if (store.state.error) refused.push(`${type}: ${store.state.error.reason}`);
      while (store.state.version !== version && store.state.canUndo) { store.undo(); await idle(); }
    }
    return refused;)");
  CHECK(refused == json::array());
  v.open_again();
}

TEST_CASE("a key takes the place of those that exclude it, brings its partner, and goes with it") {
  Viewer& v = viewer();
  v.run(
      "store.edit([{at: '/objects/0', value: {type: 'cylinder', material: 'red', height: 1, center: [0, 0, "
      "0]}},"
      "{at: '/lights/1', value: {type: 'spot', position: [3, 4, 3], direction: [-1, -1, -1]}}])");
  v.settle();
  const auto after = [&](const char* label, const char* number) {
    v.type(label, number);
    v.wait("return store.edits.idle");
    CHECK(v.run("return store.state.error").is_null());
    return v.run("return [store.state.document.objects[0], store.state.document.lights[1]]");
  };
  v.tab("build");
  v.run("store.update({selection: '/objects/0'})");
  v.wait("return document.querySelector('#panel [aria-label=\"To y\"]')");
  const json ends = after("To y", "2")[0];
  CHECK(ends["to"] == json::parse("[0, 2, 0]"));
  CHECK(ends["from"] == json::parse("[0, 0, 0]"));
  CHECK(!ends.contains("height"));
  const json middle = after("Height", "3")[0];
  CHECK(middle["height"] == 3);
  CHECK(!middle.contains("from"));
  CHECK(!middle.contains("to"));
  v.tab("light");
  const json aimed = after("Target z", "1")[1];
  CHECK(aimed["target"] == json::parse("[0, 0, 1]"));
  CHECK(!aimed.contains("direction"));
  v.open_again();
}

TEST_CASE("the page's tracks have the values of a render") {
  const json values = viewer().run(R"(
    const {valueAt} = await import('/tracks.js');
    const keys = [[0, 0], [10, 0], [12, 3], [22, 3]].map(([frame, value]) => ({frame, value: [value]}));
    const round = ([v]) => Math.round(v * 1e9) / 1e9;
    const loop = {type: 'smooth', cycle: true, keys: [[0, 0], [10, 4], [20, 0]].map(([frame, value]) => ({frame, value: [value]}))};
    const ease = {type: 'bezier', keys: [{frame: 0, value: [0], handle_right: {frame: 10, value: [0]}}, {frame: 10, value: [1]}]};
    return [[5, 11, 15].map((f) => round(valueAt({type: 'smooth', keys}, f))), round(valueAt({type: 'step', keys}, 11.9)),
      round(valueAt({type: 'linear', keys}, 11)), round(valueAt(loop, 25)) === round(valueAt(loop, 5)), round(valueAt(ease, 5)) < 0.3];)");
  CHECK(values == json::parse("[[0, 1.5, 3], 0, 1.5, true, true]"));
}

TEST_CASE("presets of materials, lights and quality are scenes that can be read") {
  Viewer& v = viewer();
  const json refused = v.run(R"(
    const presets = await import('/presets.js');
    const bad = [];
    const tried = async (name, act) => {
      store.update({error: null});
      act();
      for (let i = 0; i < 500 && !store.edits.idle; ++i) await new Promise((r) => setTimeout(r, 5));
      if (store.state.error) bad.push(name + ': ' + store.state.error.reason);
    };
    for (const name of Object.keys(presets.materials()).filter((_, i) => i % 6 === 0)) await tried(name, () => presets.setMaterial('/materials/red', {}, name));
    for (const name of Object.keys(presets.lights)) await tried(name, () => presets.setLights(name));
    for (const name of Object.keys(presets.qualities)) await tried(name, () => presets.setQuality(name));
    return bad;)");
  CHECK(refused == json::array());
  v.undo_all();
}

TEST_CASE("a colour may be a texture of the presets") {
  Viewer& v = viewer();
  v.run(
      "store.edit([{at: '/objects/1/material', value: 'red'}, {at: '/materials/red/color', value: "
      "'smudges'}])");
  v.settle();
  v.tab("build");
  CHECK(v.run(R"(
    const unfold = async () => {
      for (let i = 0; i < 20; ++i) {
        document.querySelectorAll('#panel details:not([open])').forEach((d) => (d.open = true));
        await new Promise((r) => setTimeout(r, 30));
      }
    };
    await unfold();
    const lists = [...document.querySelectorAll('#panel select')];
    return lists.some((list) => list.value === 'smudges' && [...list.options].some((one) => one.value === 'oak_rings'));)") ==
        true);
  v.undo_all();
}
