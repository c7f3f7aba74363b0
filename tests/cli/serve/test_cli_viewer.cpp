// The viewer's page in a real browser: what a person does, and the pixels that change by it.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/file.h"
#include "base/image_io.h"
#include "catch.h"
#include "run_command.h"
#include "viewing.h"

using nlohmann::json;

namespace {

Viewer& viewer() {
  static Viewer one;
  return one;
}

/// The picture after `act`, which must differ from that before; afterwards all is undone, and the first
/// picture is back.
template <class Act>
void changes_picture(const Act& act) {
  const auto before = viewer().picture();
  const json version = viewer().run("return store.state.version");
  act();
  viewer().wait("return store.state.version > " + version.dump());
  CHECK(viewer().picture() != before);
  viewer().undo_all();
  CHECK(viewer().picture() == before);
}

}  // namespace

TEST_CASE("the page loads, without an error, and shows the scene to the bit") {
  viewer().picture();
  CHECK(viewer().run("return [canvas.width, canvas.height]") == json({96, 96}));
  CHECK(viewer().browser.errors().empty());
  const std::string png = (viewer().served.folder / "reference.png").string();
  REQUIRE(run_sundog({"render", viewer().served.scene, "-o", png, "--quiet"}).status == 0);
  const json expected = viewer().run(R"(
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(args[0]), (c) => c.charCodeAt(0))]));
    const other = new OffscreenCanvas(image.width, image.height).getContext('2d');
    other.drawImage(image, 0, 0);
    const data = other.getImageData(0, 0, image.width, image.height).data, shown = pixels();
    return shown.length === data.length && shown.every((v, i) => v === data[i]);)",
                                     {to_base64(sundog::read_file(png))});
  CHECK(expected == true);
}

TEST_CASE("each group of settings changes the picture, and undo brings it back") {
  Viewer& v = viewer();
  SECTION("build: a parameter") {
    v.tab("build"), changes_picture([&] { v.type("size", "0.6"); });
  }
  SECTION("build: the interval") {
    v.tab("build"), changes_picture([&] { v.type("X to", "0.3"); });
  }
  SECTION("build: the material") {
    v.tab("build"), changes_picture([&] { v.type("Colour, r, linear", "0.05"); });
  }
  SECTION("build: smoothing") {
    v.tab("build"), changes_picture([&] { v.type("Samples", "4"); });
  }
  SECTION("camera: its angle") {
    v.tab("camera"), changes_picture([&] { v.type("Fov", "80"); });
  }
  SECTION("camera: turn about a vector") {
    v.tab("camera"), changes_picture([&] { v.press("Turn"); });
  }
  SECTION("camera: move by a vector") {
    v.tab("camera"), changes_picture([&] { v.press("Move"); });
  }
  SECTION("light: intensity") {
    v.tab("light"), changes_picture([&] { v.type("Intensity", "0.1"); });
  }
  SECTION("light: place") {
    v.tab("light"), changes_picture([&] { v.type("Position x", "-3"); });
  }
  SECTION("image: size") {
    v.tab("image"), changes_picture([&] { v.type("Width", "64"); });
  }
}

TEST_CASE("dragging orbits, the wheel and keys come nearer, a drag is one step to undo") {
  Viewer& v = viewer();
  const json box = v.run(
      "const b = canvas.getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / "
      "2].map(Math.round)");
  const int x = box[0], y = box[1];
  changes_picture([&] { v.browser.drag({{x, y}, {x + 60, y + 10}, {x + 90, y + 30}}); });
  changes_picture([&] { v.browser.drag({{x, y}, {x + 40, y}}, "\uE008"); });
  changes_picture(
      [&] { v.run("canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -200, cancelable: true}))"); });
  changes_picture([&] {
    v.run("canvas.focus()");
    v.browser.keys({"w"});
  });
  const auto before = v.picture();
  v.browser.drag({{x, y}, {x + 30, y}, {x + 60, y}, {x + 90, y}});
  v.settle();
  const json version = v.run("const n = store.state.version; store.say('undo'); return n");
  v.wait("return store.state.version > " + version.dump());
  CHECK(v.picture() == before);
}

TEST_CASE("a click picks an object; a double click looks there") {
  Viewer& v = viewer();
  v.tab("build");
  v.settle();
  const auto at = [&](double right, double down) {
    const json p = v.run(
        "const b = canvas.getBoundingClientRect(); return [b.left + b.width * args[0], b.top + b.height * "
        "args[1]].map(Math.round)",
        {right, down});
    return std::pair<int, int>(p[0], p[1]);
  };
  v.browser.drag({at(0.5, 0.95)});
  v.wait("return store.state.selection === '/objects/1'");
  CHECK(v.run("return document.querySelector('.object[aria-pressed=true] span').textContent") == "ground");
  v.browser.drag({at(0.5, 0.5)});
  v.wait("return store.state.selection === '/objects/0'");
  changes_picture([&] { v.browser.double_click(at(0.4, 0.45).first, at(0.4, 0.45).second); });
}

TEST_CASE("lights and the interval's box are dragged in the picture") {
  Viewer& v = viewer();
  const auto drag_handle = [&](const std::string& which) {
    const json at = v.run(
        "const b = document.querySelector(args[0]).getBoundingClientRect();"
        "return [b.left + b.width / 2, b.top + b.height / 2].map(Math.round)",
        {which});
    const int x = at[0], y = at[1];
    v.browser.drag({{x, y}, {x + 20, y + 20}, {x + 60, y + 50}});
  };
  v.run("store.set('/camera/position', [8, 5, 9])");
  v.settle();
  v.tab("light");
  v.wait("return document.querySelector('.handle.light') !== null");
  const json place = v.run("return store.state.document.lights[1].position");
  drag_handle(".handle.light");
  v.wait("return JSON.stringify(store.state.document.lights[1].position) !== '" + place.dump() + "'");
  v.tab("build");
  v.run("store.update({selection: '/objects/0'})");
  v.wait("return document.querySelectorAll('.handle.face').length === 6");
  drag_handle(".handle.axis1");
  v.wait("return store.state.document.objects[0].interval !== undefined");
  v.undo_all();
}

TEST_CASE("another local size and split draw the same bits") {
  Viewer& v = viewer();
  v.tab("devices");
  const auto before = v.picture();
  const json generation = v.run("return store.state.status.generation");
  v.type("Work group", "16");
  v.type("Split", "static");
  v.type("Coarse first", "");
  v.wait("return store.state.status.generation >= " + generation.dump() +
         " + 3 && store.state.status.settled");
  CHECK(v.picture() == before);
  CHECK(v.run("return store.state.options") ==
        json({{"is", "options"}, {"split", "static"}, {"work_group", "16"}, {"coarse", false}}));
  v.type("Split", "1,2,3");
  v.wait("return store.state.error?.reason.includes('share') ?? false");
  v.run("store.say('options', {split: 'dynamic', work_group: 'auto', coarse: true})");
}

TEST_CASE("a wrong formula is marked at its place, and the picture stays; a right one is drawn") {
  Viewer& v = viewer();
  v.tab("build");
  const auto before = v.picture();
  v.type("Distance", "length(p) - sise");
  v.wait("return store.state.error?.at === '/objects/0/distance'");
  CHECK(v.run("return document.querySelector('#panel .error[role=alert] "
              "pre')?.textContent.split('\\n')[1].indexOf('^')")
            .get<int>() == 12);
  CHECK(v.picture() == before);
  changes_picture([&] { v.type("Distance", "max(abs(p.x), max(abs(p.y), abs(p.z))) - size"); });
}

TEST_CASE("a surface of the list takes the place of another") {
  Viewer& v = viewer();
  v.tab("build");
  changes_picture([&] {
    v.run("store.set('/objects/0', {type: 'fractal', formula: 'mandelbulb', material: 'red'})");
    v.wait("return document.querySelector('#panel .surface') !== null");
    v.run("document.querySelector('#panel .surface').click()");
    v.wait("return document.querySelectorAll('[data-surface]').length >= 32");
    v.run("document.querySelector('[data-surface=menger]').click()");
    v.wait("return store.state.document.objects[0].formula === 'menger'");
  });
}

TEST_CASE("what is saved renders with sundog to the same bits, and so does the copied command") {
  Viewer& v = viewer();
  v.tab("camera");
  v.type("Fov", "33");
  v.picture();
  v.run("const files = await import('/files.js'); await files.saveScene(); await files.savePicture('png');");
  const auto& folder = v.browser.downloads();
  const auto there = [&](const char* name) {
    for (int i = 0; i < 500 && !std::filesystem::exists(folder / name); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return sundog::read_file(folder / name);
  };
  const std::string picture = there("scene.png");
  there("scene.json");
  const std::string again = (folder / "again.png").string();
  REQUIRE(run_sundog({"render", (folder / "scene.json").string(), "-o", again, "--quiet"}).status == 0);
  CHECK(sundog::read_file(again) == picture);
  const std::string command = v.run("return (await (await store.link.call('command')).text()).trim()");
  CHECK(command.find("--set '/camera/fov=33'") != std::string::npos);
  CommandOptions options;
  options.folder = folder.path();
  const std::string place = SUNDOG_BINARY;
  REQUIRE(run_command({"sh", "-c", place + command.substr(6) + " --quiet"}, options).status == 0);
  CHECK(sundog::read_file(folder / "picture.png") == picture);
  v.undo_all();
}

TEST_CASE("two pages see each other's changes, and a page that is loaded again is as before") {
  Viewer& v = viewer();
  const auto before = v.picture();
  v.browser.open_tab(v.served.url);
  v.settle();
  CHECK(v.picture() == before);
  v.tab("light");
  v.type("Intensity", "0.2");
  const auto after = v.picture();
  CHECK(after != before);
  v.browser.use_tab(0);
  v.settle();
  CHECK(v.picture() == after);
  v.browser.reload();
  v.settle();
  CHECK(v.picture() == after);
  v.undo_all();
  CHECK(v.picture() == before);
}

TEST_CASE("a page with a wrong token says so and shows nothing") {
  Viewer& v = viewer();
  v.browser.open_tab("about:blank");
  v.browser.open(v.served.url.substr(0, v.served.url.find('#')) + "#token=00000000000000000000000000000000");
  v.wait("return document.querySelector('.status')?.dataset.state === 'token'");
  CHECK(v.run("return canvas.dataset.frame ?? 'none'") == "none");
  v.browser.use_tab(0);
}
