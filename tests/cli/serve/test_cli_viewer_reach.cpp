// Who the viewer's page is within reach of: fingers instead of a mouse, and, by axe-core's rules, people with
// screen readers or keyboards, in both colour schemes, on a phone and on a screen.
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/file.h"
#include "catch.h"
#include "viewing.h"

using nlohmann::json;

namespace {

/// axe-core's findings in the page as it is now, one line each.
struct Findings {
  json violations;
  int rules = 0;  // that the page was held to
};

const auto axe_core = std::filesystem::path(SUNDOG_BINARY).parent_path() / "axe-core/package/axe.min.js";

Findings findings() {
  static const std::string source = sundog::read_file(axe_core);
  if (viewer().browser.run("return Boolean(window.axe)") != true) viewer().browser.run(source);
  const json found = viewer().browser.run(R"(
    const found = await window.axe.run(document, {resultTypes: ['violations']});
    return [found.violations.flatMap((v) => v.nodes.map((n) => `${v.id}: ${n.target.join(' ')}: ${n.failureSummary}`)), found.passes.length];)");
  return {found[0], found[1]};
}

/// The middle of the picture, in the page's pixels.
std::pair<int, int> middle() {
  const json at = viewer().run(
      "const r = canvas.getBoundingClientRect(); return [(r.left + r.right) / 2, (r.top + r.bottom) / 2]");
  return {static_cast<int>(at[0].get<double>()), static_cast<int>(at[1].get<double>())};
}

double distance_of_camera() {
  return viewer().run(
      "const {position: p, target: t} = store.state.document.camera;"
      "return Math.hypot(p[0] - t[0], p[1] - t[1], p[2] - t[2])");
}

}  // namespace

TEST_CASE("axe-core finds nothing in the page: dark and light, at 390 and 1280 pixels, in each panel") {
  if (!std::filesystem::exists(axe_core)) {
    std::printf("axe-core is not here (cmake/FetchAxe.cmake): not tested by its rules\n");
    return;
  }
  Viewer& v = viewer();
  for (const bool dark : {true, false})
    for (const int width : {390, 1280}) {
      v.browser.prefer_dark(dark);
      v.browser.resize(width, 800);
      for (const char* tab : {"build", "camera", "light", "image", "devices", "statistics"}) {
        INFO((dark ? "dark, " : "light, ") << width << " pixels, " << tab);
        v.tab(tab);
        const Findings found = findings();
        CHECK(found.violations == json::array());
        CHECK(found.rules > 15);
      }
    }
  v.browser.resize(1100, 760);
  v.tab("build");
}

TEST_CASE("the menu of what to save lies within a narrow window") {
  Viewer& v = viewer();
  v.browser.resize(390, 800);
  v.press("Save");
  v.wait("return document.querySelector('[role=menu]')");
  CHECK(v.run("const {left, right} = document.querySelector('[role=menu]').getBoundingClientRect();"
              "return left >= 0 && right <= innerWidth") == true);
  v.press("Save");
  v.browser.resize(1100, 760);
}

TEST_CASE("labels in panels are whole") {
  Viewer& v = viewer();
  for (const char* tab : {"camera", "image"}) {
    v.tab(tab);
    CHECK(v.run("return [...document.querySelectorAll('#panel .row > label')].filter((l) => l.scrollWidth > "
                "l.clientWidth).map((l) => l.textContent)") == json::array());
  }
  v.tab("build");
}

TEST_CASE("one finger orbits, two come nearer") {
  Viewer& v = viewer();
  const auto before = v.picture();
  const double distance = distance_of_camera();
  const auto [x, y] = middle();
  v.browser.touch({{{x, y}, {x + 40, y}, {x + 80, y + 10}}});
  v.wait("return store.state.canUndo");
  CHECK(v.picture() != before);
  CHECK(distance_of_camera() == Approx(distance));
  v.undo_all();
  CHECK(v.picture() == before);
  v.browser.touch({{{x - 20, y}, {x - 50, y}, {x - 90, y}}, {{x + 20, y}, {x + 50, y}, {x + 90, y}}});
  v.wait("return store.state.canUndo");
  CHECK(v.picture() != before);
  CHECK(distance_of_camera() < 0.8 * distance);
  v.undo_all();
  CHECK(v.picture() == before);
}
