// The viewer's page in a real browser: what a person does, and the pixels that change by it.
#include <algorithm>
#include <chrono>
#include <cmath>
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
  REQUIRE(run_sundog({"render", viewer().served.scene, "-o", png, "--quiet", "--no-dither"}).status == 0);
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

TEST_CASE("a focal length takes the place of the angle, and parallel rays come nearer by their height") {
  Viewer& v = viewer();
  v.run("store.edit([{at: '/camera/fov', value: 30}])");
  v.wait("return store.state.resolved.camera.fov === 30 && settled()");
  const auto before = v.picture();
  v.tab("camera");
  v.type("Focal length", "100");
  v.wait("return store.edits.idle && store.state.document.camera.focal_length === 100 && settled()");
  CHECK(v.picture() != before);
  CHECK(!v.run("return store.state.document.camera").contains("fov"));
  const double fov = v.run("return store.state.resolved.camera.fov");
  CHECK(std::abs(fov - 20.41) < 0.01);  // of a square: 2 atan(18 / 100)
  v.type("Orthographic", "3");
  v.wait("return store.edits.idle && store.state.resolved.camera.orthographic === 3 && settled()");
  v.run("canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -200, cancelable: true}))");
  v.wait("return store.edits.idle && store.state.document.camera.orthographic < 3");
  CHECK(!v.run("return store.state.document.camera").contains("focal_length"));
  v.open_again();
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

TEST_CASE("the page waits for no pick that the server has refused, or a lost connection has lost") {
  Viewer& v = viewer();
  v.run("store.pick(NaN, 1).then((picked) => { window.refusedPick = picked; })");
  v.wait("return window.refusedPick !== undefined");
  CHECK_THAT(v.run("return window.refusedPick.error").get<std::string>(),
             ContainsSubstring("wanted a pixel"));
  v.run(
      "const {client, mostUpload, models} = store.state;"
      "store.asked.set(-1, (picked) => { window.lostPick = picked; });"
      "store.take({is: 'welcome', client, most_upload_bytes: mostUpload, models: models.join(' ')})");
  CHECK(v.run("return window.lostPick.object") == nullptr);
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
  v.wait(
      "return "
      "document.querySelector('[data-code=Distance]').shadowRoot.querySelector('.cm-lintRange-error')"
      "?.textContent === 'sise'");
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
  CHECK(command.find("--set /camera/fov=33") != std::string::npos);
  CommandOptions options;
  options.folder = folder.path();
  const std::string place = SUNDOG_BINARY;
  REQUIRE(run_command({"sh", "-c", place + command.substr(6) + " --quiet"}, options).status == 0);
  CHECK(sundog::read_file(folder / "picture.png") == picture);
  v.undo_all();
}

TEST_CASE("the picture is saved as EXR with the bits of sundog render") {
  Viewer& v = viewer();
  v.picture();
  v.run("const files = await import('/files.js'); await files.savePicture('exr');");
  const auto file = v.browser.downloads() / "scene.exr";
  for (int i = 0; i < 500 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const std::string again = (v.browser.downloads() / "again.exr").string();
  REQUIRE(run_sundog({"render", v.served.scene, "-o", again, "--quiet"}).status == 0);
  const sundog::Image saved = sundog::read_image(file), rendered = sundog::read_image(again);
  REQUIRE(saved.width == rendered.width);
  for (int y = 0; y < saved.height; ++y)
    for (int x = 0; x < saved.width; ++x)
      for (int c = 0; c < 3; ++c) REQUIRE(saved.pixel(x, y)[c] == rendered.pixel(x, y)[c]);
}

TEST_CASE("a link carries the whole scene, and a preset, a path and a drop are edits like others") {
  Viewer& v = viewer();
  const auto before = v.picture();
  v.tab("light");
  v.type("Intensity", "0.15");
  const auto dark = v.picture();
  const std::string link = v.run(R"(
    const files = await import('/files.js');
    Object.defineProperty(navigator, 'clipboard', {value: {writeText: async (text) => (window.copied = text)}, configurable: true});
    await files.copyLink();
    return window.copied;)");
  v.undo_all();
  CHECK(v.picture() == before);
  v.browser.open_tab(link);
  v.wait("return store.state.file === 'scene.json' && store.state.document?.lights[0].intensity === 0.15");
  CHECK(v.picture() == dark);
  CHECK(v.run("return location.hash.includes('scene=')") == false);
  v.browser.use_tab(0);
  CHECK(v.picture() == dark);
  // A file that is dropped: the scene as it was.
  v.run(R"(
    const file = new File([args[0]], 'scene.json', {type: 'application/json'}), data = new DataTransfer();
    data.items.add(file);
    document.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));)",
        {viewer_scene});
  v.wait("return store.state.document.lights[0].intensity === undefined");
  CHECK(v.picture() == before);
  v.tab("build");
  changes_picture([&] {
    v.run(
        "const {setMaterial} = await import('/presets.js'); setMaterial('/materials/red', "
        "store.state.document.materials.red, 'gold')");
    CHECK(v.run("return store.state.document.materials.red") == json::parse(R"({"preset": "gold"})"));
  });
  v.tab("camera");
  v.press("Keep this view");
  v.run("store.set('/camera/position', [3, 2, 2])");
  v.settle();
  v.run("const {keepView} = await import('/panels/path.js'); keepView(store.state.resolved.camera, 24)");
  v.settle();
  CHECK(
      v.run(
          "return store.state.document.animate.map((t) => [t.type, t.value, t.keys.map((k) => k.frame)])") ==
      json::parse(R"([["smooth", "/camera/position", [0, 24]], ["smooth", "/camera/target", [0, 24]]])"));
  v.undo_all();
  CHECK(v.picture() == before);
}

TEST_CASE("a model that is dropped on the page is shown; one that is damaged is refused") {
  Viewer& v = viewer();
  const json before = v.run("return store.state.document");
  const char* drop = R"(
    const data = new DataTransfer();
    data.items.add(new File([args[0]], args[1]));
    document.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));)";
  v.run(drop, {"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex nonsense", "bad.stl"});
  v.wait("return store.state.error !== null");
  CHECK(v.run("return store.state.document") == before);
  CHECK(v.run("return store.state.error.reason").get<std::string>().starts_with("bad.stl: "));
  v.run("store.update({error: null})");
  v.run(R"(
    const data = new DataTransfer();
    data.items.add(new File([new Uint8Array(33554433)], 'large.glb'));
    document.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));)");
  v.wait("return store.state.error?.reason.startsWith('large.glb has 33554433 bytes') ?? false");
  v.run("store.update({error: null})");
  v.run(drop,
        {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
         "three.ply"});
  v.wait("return store.state.file === 'three.ply' && store.state.status.settled");
  v.settle();
  CHECK(v.run("return new Set(pixels()).size").get<int>() > 2);
  v.run("store.say('open', {file: 'scene.json'})");
  v.wait("return store.state.file === 'scene.json'");
  v.settle();
}

TEST_CASE("devices are switched while the scene is shown") {
  Viewer& v = viewer();
  v.tab("devices");
  const json specs = v.run("return store.state.devices.filter((d) => !d.problem).map((d) => d.spec)");
  const json picked = v.run("return store.state.devices.filter((d) => d.picked).map((d) => d.spec)");
  REQUIRE(!specs.empty());
  const json generation = v.run("return store.state.status.generation");
  const std::string other = specs[0].get<std::string>() + "/1";  // one of its cores
  v.run("store.say('devices', {specs: [args[0]]})", {other});
  v.wait("return store.state.status.generation > " + generation.dump() + " && store.state.status.settled");
  CHECK(v.run("return store.state.status.devices.map((d) => d.spec)") == json({other}));
  v.run("store.say('devices', {specs: args[0]})", json::array({picked}));
  v.wait("return store.state.status.devices.length === " + std::to_string(picked.size()) +
         " && store.state.status.settled");
}
