// A denoiser's input: the albedo and normal of the surfaces that a picture's samples see.
#include <string>
#include <vector>

#include "base/image_io.h"
#include "catch.h"
#include "cli_scene.h"

using namespace sundog;

namespace {

/// The AOVs of a scene with these sections: the left half of the picture is a red wall at z = 0, the right
/// half a white one.
AovImages aovs_of(const std::string& camera, const std::string& materials, const std::string& objects,
                  const std::string& integrator = "path") {
  const CliFolder folder;
  const std::string scene =
      folder
          .write("features.json", R"({"camera": {"position": [0, 0, 4], "target": [0, 0, 0], "fov": 30)" +
                                      camera +
                                      R"(}, "image": {"width": 24, "height": 16},
            "render": {"samples": 16, "integrator": ")" +
                                      integrator + R"("},
            "lights": [{"type": "point", "position": [0, 3, 3]}],
            "materials": {"red": {"color": [0.8, 0.1, 0.1], "diffuse": 1}, "white": {"color": [0.9, 0.9, 0.9], "diffuse": 1})" +
                                      materials + R"(}, "objects": [
              {"type": "box", "min": [-9, -9, -1], "max": [0, 9, 0], "material": "red"},
              {"type": "box", "min": [0, -9, -1], "max": [9, 9, 0], "material": "white"})" +
                                      objects + "]}")
          .string();
  std::vector<std::string> command{"render", scene, "-o", folder.file("a.exr"), "--quiet"};
  for (const char* name : {"albedo", "denoise_albedo", "denoise_normal"})
    command.insert(command.end(), {"--aov", name});
  const CommandResult result = run_sundog(command);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  return read_aovs(folder / "a.exr");
}

float value(const AovImages& aovs, const char* name, int x, int c) { return aovs.at(name).pixel(x, 8)[c]; }

}  // namespace

TEST_CASE("features are blurred by the lens, and are else those of the first surface") {
  const AovImages sharp = aovs_of("", "", ""),
                  blurred = aovs_of(R"(, "lens": {"radius": 0.2, "focus": 2})", "", "");
  for (const int x : {2, 9, 14, 21}) {
    CHECK(value(sharp, "denoise_albedo", x, 1) == Approx(value(sharp, "albedo", x, 1)).margin(1e-5));
    CHECK(value(sharp, "denoise_normal", x, 2) == Approx(1).margin(1e-5));
  }
  CHECK(value(blurred, "albedo", 11, 1) == Approx(0.1f));
  CHECK(value(blurred, "denoise_albedo", 11, 1) > 0.2f);
  CHECK(value(blurred, "denoise_albedo", 12, 1) < 0.8f);
  CHECK(value(blurred, "denoise_albedo", 2, 1) == Approx(0.1f).margin(1e-4));
}

TEST_CASE("features are of what stands behind smooth glass and in mirrors, of either integrator") {
  for (const std::string integrator : {"path", "whitted"}) {
    CAPTURE(integrator);
    const AovImages pane = aovs_of(
        "", R"(, "glass": {"type": "dielectric", "ior": 1.5})",
        R"(, {"type": "box", "min": [-9, -9, 1], "max": [9, 9, 1.1], "material": "glass"})", integrator);
    CHECK(value(pane, "albedo", 4, 1) == 0);
    // Glass mirrors a tenth: there is the sky, of which only the mirror's tint is known.
    CHECK(value(pane, "denoise_albedo", 4, 1) == Approx(0.15f).margin(0.1));
    CHECK(value(pane, "denoise_albedo", 4, 0) > 0.7f);
    CHECK(value(pane, "denoise_albedo", 19, 1) > 0.8f);
    const AovImages mirror = aovs_of(
        "",
        R"(, "mirror": {"diffuse": 0, "reflection": 0.9}, "blue": {"color": [0.1, 0.1, 0.8], "diffuse": 1})",
        R"(, {"type": "box", "min": [0, -9, 0.5], "max": [9, 9, 0.6], "material": "mirror"},
             {"type": "box", "min": [-9, -9, 8], "max": [9, 9, 9], "material": "blue"})",
        integrator);
    CHECK(value(mirror, "denoise_albedo", 19, 0) == Approx(0.09f).epsilon(1e-3));
    CHECK(value(mirror, "denoise_albedo", 19, 2) == Approx(0.72f).epsilon(1e-3));
    CHECK(value(mirror, "denoise_normal", 19, 2) == Approx(-1).margin(1e-4));
    CHECK(value(mirror, "denoise_albedo", 4, 0) == Approx(0.8f).epsilon(1e-3));
  }
}

TEST_CASE("a rough mirror has its colour for the denoiser, and none in the albedo") {
  const AovImages aovs =
      aovs_of("", R"(, "rough": {"diffuse": 0, "reflection": 0.9, "roughness": 0.7})",
              R"(, {"type": "box", "min": [0, -9, 0.5], "max": [9, 9, 0.6], "material": "rough"})");
  CHECK(value(aovs, "albedo", 19, 1) == 0);
  CHECK(value(aovs, "denoise_albedo", 19, 1) == Approx(0.9f).epsilon(1e-3));
}

TEST_CASE("the albedo of layered materials is their base's, and narrow lobes are as good as mirrors") {
  const AovImages aovs = aovs_of(
      "", R"(, "layered": {"type": "openpbr", "base_color": [0.2, 0.6, 0.4], "specular_roughness": 0.4},
        "silver": {"type": "openpbr", "base_color": [0.9, 0.9, 0.9], "base_metalness": 1, "specular_roughness": 0.1},
        "blue": {"color": [0.1, 0.1, 0.8], "diffuse": 1})",
      R"(, {"type": "box", "min": [-9, -9, 0.1], "max": [0, 9, 0.2], "material": "layered"},
                 {"type": "box", "min": [0, -9, 0.1], "max": [9, 9, 0.2], "material": "silver"},
                 {"type": "box", "min": [-90, -90, 8], "max": [90, 90, 9], "material": "blue"})");
  CHECK(value(aovs, "albedo", 4, 1) == Approx(0.6f));
  CHECK(value(aovs, "albedo", 4, 2) == Approx(0.4f));
  CHECK(value(aovs, "denoise_albedo", 4, 1) == Approx(0.6f).margin(0.05));
  CHECK(value(aovs, "albedo", 19, 1) == Approx(0.9f));
  CHECK(value(aovs, "denoise_albedo", 19, 0) < 0.45f);  // 0.9 where no ray follows
  CHECK(value(aovs, "denoise_albedo", 19, 2) > 0.6f);
}
