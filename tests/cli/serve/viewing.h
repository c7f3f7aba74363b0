// The viewer's page in a browser, with a server of its own.
#pragma once
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "browser.h"
#include "catch.h"
#include "served.h"

using nlohmann::json;

/// Names for every script: the page's own store, and the canvas's pixels.
inline constexpr const char* viewer_prelude = R"(
  const {store} = await import('/store.js');
  const canvas = document.querySelector('canvas');
  const pixels = () => Array.from(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data);
  const hash = () => pixels().reduce((h, v) => (h * 31 + v) >>> 0, 7);
  const settled = () => canvas.dataset.settled === 'true' && Number(canvas.dataset.version) === store.state.version
    && store.edits.idle;
)";

/// A port that no connection is given by itself: while the server is away, the page that tries to reach it
/// could otherwise be given the server's own port to come from, and meet itself there.
inline int free_port() {
  for (int port = 20000 + ::getpid() % 10000;; ++port) {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    const bool free = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(socket);
    if (free) return port;
  }
}

/// One server and one browser for all cases: each leaves the scene as it was (undo).
struct Viewer {
  Served served;
  Browser browser{1100, 760};
  Viewer() {
    browser.open(served.url);
    settle();
  }
  json run(const std::string& script, const json& arguments = json::array()) {
    return browser.run(viewer_prelude + script, arguments);
  }
  void wait(const std::string& script, double seconds = 120) {
    browser.wait_until(viewer_prelude + script, seconds);
  }
  void settle() { wait("return settled()"); }
  /// The picture at rest, as a number.
  std::uint64_t picture() {
    json seen;
    do {
      settle();
      seen = run("return settled() ? hash() : null");  // another picture may have come meanwhile
    } while (seen.is_null());
    return seen;
  }
  void tab(const std::string& name) {
    run("document.getElementById('tab-' + args[0]).click(); await new Promise((r) => setTimeout(r, 30))",
        {name});
  }
  /// Types a value into the widget of that label in the open panel, as a person does.
  void type(const std::string& label, const std::string& value) {
    const json found = run(R"(
      const code = document.querySelector(`#panel [data-code="${args[0]}"]`)?.editor;
      if (code) {
        code.focus();
        code.dispatch({changes: {from: 0, to: code.state.doc.length, insert: args[1]}, userEvent: 'input'});
        code.contentDOM.blur();
        return '';
      }
      const input = document.querySelector(`#panel [aria-label="${args[0]}"]`) ?? [...document.querySelectorAll('#panel label')].find((l) => l.textContent === args[0])?.control;
      if (!input) return 'no widget ' + args[0];
      input.focus();
      if (input.type === 'checkbox') input.click();
      else {
        const set = Object.getOwnPropertyDescriptor(Object.getPrototypeOf(input), 'value').set;
        set.call(input, args[1]);
        input.dispatchEvent(new Event('input', {bubbles: true}));
        input.dispatchEvent(new Event('change', {bubbles: true}));
      }
      input.blur();
      return '';)",
                           {label, value});
    REQUIRE(found == "");
  }
  void press(const std::string& label) {
    REQUIRE(run("const b = [...document.querySelectorAll('button')].find((b) => b.textContent === args[0] && "
                "!b.disabled); if (!b) return false; b.click(); return true",
                {label}) == true);
  }
  /// Opens the scene's file again: all edits, and the steps to undo, are gone.
  void open_again() {
    const json since =
        run("const n = store.state.since; store.update({error: null}); store.say('open', {file: "
            "'scene.json'}); return n");
    wait("return store.edits.idle && store.state.since !== " + since.dump());
    settle();
  }
  /// Undoes everything and waits for the first picture again.
  void undo_all() {
    for (int i = 0; i < 60 && run("return store.state.canUndo") == true; ++i) {
      const json version = run("const v = store.state.version; store.say('undo'); return v");
      wait("return store.state.version > " + version.dump());
    }
    settle();
  }
};

inline Viewer& viewer() {
  static Viewer one;
  return one;
}
