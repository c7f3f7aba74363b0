// The viewer's editor of formulas: what is typed stays, each pause is a step to undo, and keys do what they
// do elsewhere.
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "catch.h"
#include "viewing.h"

using nlohmann::json;

namespace {

constexpr const char* first_formula = "length(p) - size";
constexpr const char* control_key = "\uE009";
constexpr const char* shift_key = "\uE008";

json shown_text() {
  return viewer().run("return document.querySelector('[data-code=Distance]').editor.state.doc.toString()");
}
json served_text() {
  return viewer().run("return (await store.link.json('scene')).objects[0].distance ?? null");
}

/// Puts the cursor into the editor, with all of its text selected.
void select_whole_text() {
  viewer().tab("build");
  viewer().run(R"(
    store.update({selection: '/objects/0'});
    await new Promise((r) => setTimeout(r, 50));
    const {editor} = document.querySelector('[data-code=Distance]');
    editor.focus();
    editor.dispatch({selection: {anchor: 0, head: editor.state.doc.length}});)");
}

void wait_for_formula(const std::string& formula) {
  viewer().wait(
      "const d = (await store.link.json('scene')).objects[0].distance; return store.edits.idle && d === '" +
      formula + "'");
}

void wait_milliseconds(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

/// The server sends an undo to the page; wait_for_formula() asks the server, which has it first.
void wait_for_text(const std::string& formula) {
  viewer().wait("return document.querySelector('[data-code=Distance]').editor.state.doc.toString() === '" +
                formula + "'");
}

}  // namespace

TEST_CASE("what is typed fast arrives as it was typed") {
  Viewer& v = viewer();
  const std::string formula = "max(length(p) - size, p.x * 0.5 + 0.1)";
  for (const int gap : {0, 20, 30}) {
    INFO("a key every " << gap << " ms");
    select_whole_text();
    v.browser.type(formula, gap);
    CHECK(shown_text() == formula);
    wait_for_formula(formula);
    CHECK(shown_text() == formula);
    select_whole_text();
    v.browser.type(first_formula, 0);
    wait_for_formula(first_formula);
  }
  v.open_again();
}

TEST_CASE("each pause in typing is a step to undo, by key and by button, and redo comes back") {
  Viewer& v = viewer();
  const std::string second = "length(p) - size * 0.5", third = "length(p) - size * 0.25";
  for (const std::string& formula : {second, third}) {
    select_whole_text();
    v.browser.type(formula, 0);
    wait_for_formula(formula);
  }
  const auto after = [&](const std::string& formula) {
    wait_for_formula(formula);
    wait_for_text(formula);
  };
  v.browser.keys({control_key, "z"});
  after(second);
  v.browser.keys({control_key, "z"});
  after(first_formula);
  CHECK(v.run("return store.state.canUndo") == false);
  v.browser.keys({control_key, "z"});  // there is nothing more
  wait_milliseconds(700);
  after(first_formula);
  v.browser.keys({control_key, shift_key, "z"});
  after(second);
  v.press("Redo");
  after(third);
  v.press("Undo");
  after(second);
  v.open_again();
}

TEST_CASE("a text that is cleared or refused stays in its editor, until undo takes it back") {
  Viewer& v = viewer();
  select_whole_text();
  v.browser.keys({"\uE017"});  // Delete
  v.wait("return store.drafts.error('/objects/0/distance') !== null");
  CHECK(shown_text() == "");
  CHECK(served_text() == first_formula);
  v.browser.keys({control_key, "z"});
  CHECK(shown_text() == first_formula);
  select_whole_text();
  v.browser.type("length(q) - size", 0);
  v.wait("return store.drafts.error('/objects/0/distance') !== null");
  v.tab("light");
  v.type("Intensity", "0.4");  // what comes from the server meanwhile
  v.settle();
  v.tab("build");
  v.wait("return document.querySelector('[data-code=Distance]') !== null");
  CHECK(shown_text() == "length(q) - size");
  v.press("Undo");  // of the text first
  v.wait(
      "return document.querySelector('[data-code=Distance]').editor.state.doc.toString() === 'length(p) - "
      "size'");
  CHECK(v.run("return store.state.document.lights[0].intensity") == 0.4);
  v.open_again();
}

TEST_CASE(
    "Enter is a new line while completions are offered, blank lines stay, and errors stand at their line") {
  Viewer& v = viewer();
  select_whole_text();
  v.browser.type("a = abs", 20);
  v.wait(
      "return "
      "document.querySelector('[data-code=Distance]').shadowRoot.querySelector('.cm-tooltip-autocomplete') "
      "!== null");
  v.browser.keys({"\uE007"});
  CHECK(shown_text() == "a = abs\n");
  select_whole_text();
  v.browser.type("// a ball", 0);
  for (int i = 0; i < 2; ++i) v.browser.keys({"\uE007"});
  v.browser.type("length(p) - sise", 0);
  v.wait("return store.drafts.error('/objects/0/distance') !== null");
  CHECK(shown_text() == "// a ball\n\nlength(p) - sise");
  v.wait(
      "return "
      "document.querySelector('[data-code=Distance]').shadowRoot.querySelector('.cm-lintRange-error')"
      "?.textContent === 'sise'");
  select_whole_text();
  v.browser.type(first_formula, 0);
  wait_for_formula(first_formula);
  v.open_again();
}

TEST_CASE("a number that is undone while its field has the focus is shown_text as it is") {
  Viewer& v = viewer();
  v.tab("camera");
  const json before = v.run("return store.state.document.camera.fov");
  v.run(
      "[...document.querySelectorAll('#panel label')].find((l) => l.textContent === 'Fov').control.select()");
  v.browser.type("33", 0);
  v.wait("return store.edits.idle && store.state.document.camera.fov === 33");
  v.browser.keys({control_key, "z"});
  v.wait("return store.edits.idle && store.state.document.camera.fov === " + before.dump());
  v.wait("return document.activeElement.value === '" + before.dump() + "'");
  v.open_again();
}
