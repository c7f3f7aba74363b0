// The viewer's pages in a real browser: after a restart of their server, two at once, and without its token.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/file.h"
#include "catch.h"
#include "run_command.h"
#include "viewing.h"

using nlohmann::json;

TEST_CASE("pages come back when the server is started anew, and give it their scene") {
  TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  const std::vector<std::string> command = {
      SUNDOG_BINARY, "serve", "scene.json", "--token-file", "token", "--port", std::to_string(free_port())};
  auto server = std::make_unique<BackgroundProgram>(command, folder.path());
  const std::string url = server->line_with("http://");
  Viewer& v = viewer();
  v.browser.open_tab(url);
  v.settle();
  v.run("store.set('/camera/fov', 31)");
  const auto changed = v.picture();
  const json frames = v.run("return Number(canvas.dataset.frame)");
  server.reset();
  v.wait("return store.state.connected === 'no'");
  server = std::make_unique<BackgroundProgram>(command, folder.path());
  CHECK(server->line_with("http://") == url);
  v.wait(
      "return store.state.connected === 'yes' && store.state.document.camera.fov === 31 && "
      "store.state.version <= 2");
  // The old server's picture has the same version: a new one is waited for.
  v.wait("return Number(canvas.dataset.frame) > " + frames.dump());
  CHECK(v.picture() == changed);
  v.browser.use_tab(0);
}

TEST_CASE(
    "a page without its server saves the scene, and takes a new token from an address opened in its tab") {
  TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  const std::vector<std::string> command = {SUNDOG_BINARY, "serve", "scene.json", "--port",
                                            std::to_string(free_port())};
  auto server = std::make_unique<BackgroundProgram>(command, folder.path());
  Viewer& v = viewer();
  v.browser.open_tab(server->line_with("http://"));
  v.settle();
  v.run("store.set('/camera/fov', 31)");
  v.settle();
  server.reset();
  v.wait("return store.state.connected === 'no'");
  const json saved = v.run(R"(
    const files = await import('/files.js');
    URL.createObjectURL = (blob) => { window.blob = blob; return '#'; };
    HTMLAnchorElement.prototype.click = () => {};
    await files.savePicture('png');
    return [await files.saveScene(), JSON.parse(await window.blob.text()).camera.fov, store.state.notice];)");
  CHECK(saved[0] == true);
  CHECK(saved[1] == 31);
  CHECK(saved[2].get<std::string>().starts_with("no server: start sundog serve again"));
  server = std::make_unique<BackgroundProgram>(command, folder.path());
  const std::string url = server->line_with("http://");
  v.wait("return store.state.connected === 'token'");
  v.run("location.href = args[0]", {url});
  v.wait("return store.state.connected === 'yes' && store.state.document.camera.fov === 31 && settled()");
  v.browser.use_tab(0);
}

TEST_CASE("the page says that a kernel is being built, and when the picture is complete") {
  TemporaryFolder folder;
  folder.write("scene.json", viewer_scene);
  BackgroundProgram server({SUNDOG_BINARY, "serve", "scene.json"}, folder.path(),
                           {{"XDG_CACHE_HOME", (folder / "cache").string()}});  // without any kernel
  Viewer& v = viewer();
  v.browser.open_tab(server.line_with("http://"));
  v.settle();
  v.run(R"(
    const line = document.querySelector('.doing');
    window.said = [];
    window.listener = new MutationObserver(() => window.said.push(line.textContent));
    window.listener.observe(line, {characterData: true, childList: true, subtree: true});)");
  // Other samplers have kernels of their own.
  v.run("store.set('/render/sampler', 'stratified')");
  v.picture();
  v.wait("return window.said.at(-1)?.startsWith('finished in')");
  const json said = v.run("window.listener.disconnect(); return window.said");
  INFO(said.dump());
  CHECK(std::ranges::any_of(said,
                            [](const std::string& text) { return text.starts_with("building a kernel"); }));
  v.browser.use_tab(0);
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

TEST_CASE("opening another scene asks where it would drop edits") {
  Viewer& v = viewer();
  const auto opens = [&](const std::string& file) {
    v.press("Open");
    v.wait("return [...document.querySelectorAll('.files button')].some((b) => b.textContent === '" + file +
           "')");
    v.run("[...document.querySelectorAll('.files button')].find((b) => b.textContent === args[0]).click()",
          {file});
  };
  const std::string asked =
      "return document.querySelector('dialog')?.ariaLabel === 'Edits that are not saved'";
  v.run("store.set('/camera/fov', 29)");
  v.settle();
  opens("sub/other.json");
  v.wait(asked);
  v.press("Keep editing");
  v.wait("return document.querySelector('dialog') === null");
  CHECK(v.run("return [store.state.file, store.state.document.camera.fov]") == json({"scene.json", 29}));
  v.run(R"(
    const data = new DataTransfer();
    data.items.add(new File([args[0]], 'dropped.json'));
    document.dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));)",
        {viewer_scene});
  v.wait(asked);
  v.press("Open without saving");
  v.wait("return store.state.file === 'dropped.json'");
  v.run("store.set('/camera/fov', 28)");
  v.settle();
  opens("scene.json");
  v.wait(asked);
  v.press("Save and open");
  v.wait("return store.state.file === 'scene.json'");
  v.settle();
  const auto saved = v.browser.downloads() / "dropped.json";
  for (int i = 0; i < 500 && !std::filesystem::exists(saved); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(json::parse(sundog::read_file(saved))["camera"]["fov"] == 28);
  opens("sub/other.json");  // there is nothing to lose
  v.wait("return store.state.file === 'other.json'");
  v.open_again();
}

TEST_CASE("a page with a wrong token says so and shows nothing") {
  Viewer& v = viewer();
  v.browser.open_tab("about:blank");
  v.browser.open(v.served.url.substr(0, v.served.url.find('#')) + "#token=00000000000000000000000000000000");
  v.wait("return document.querySelector('.status')?.dataset.state === 'token'");
  CHECK(v.run("return canvas.dataset.frame ?? 'none'") == "none");
  v.browser.use_tab(0);
}
