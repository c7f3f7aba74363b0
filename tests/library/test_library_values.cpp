// Every struct of the public headers, used as its comment says.
#include <cmath>
#include <optional>

#include "library_testing.h"
#include "temporary_folder.h"

namespace fs = std::filesystem;

namespace {

sundog::Scene tiny_scene() {
  sundog::Scene scene = small_scene();
  return scene.set_size(16, 12);
}

/// The warnings of a scene with a ball of that material.
std::vector<std::string> check_material(const sundog::Material& material) {
  return tiny_scene().add_material("m", material).add_sphere({2, 1, 0}, 1, {.material = "m"}).check();
}

std::vector<std::string> check_light(const sundog::Light& light) {
  sundog::Scene scene = tiny_scene();
  return scene.set("/lights", "[]").add_light(light).check();
}

}  // namespace

TEST_CASE("glass is a type and an index, and is seen through") {
  sundog::Scene scene = tiny_scene();
  scene.add_material("glass", {.type = "dielectric", .ior = 1.5});
  CHECK_FALSE(scene.contains("/materials/glass/color"));
  scene.add_sphere({0, 1, 2}, 0.8, {.material = "glass"});
  CHECK(scene.check().empty());
  const auto middle = [](const sundog::Scene& seen) {
    return sundog::render(seen, {.devices = test_device()}).image().pixels()[4 * (6 * 16 + 8)];
  };
  const float through = middle(scene);
  scene.add_material("glass", {.color = {0, 0, 0}});
  CHECK(through > middle(scene) + 0.05f);
}

TEST_CASE("each member of a material counts by itself") {
  const auto glass = [] { return sundog::Material{.type = "dielectric", .ior = 1.5}; };
  std::vector<sundog::Material> materials(9, sundog::Material{});
  materials[1].color = {0.5, 0, 1};
  materials[2].ambient = 0;
  materials[3].diffuse = 1;
  materials[4].specular = 0.5, materials[4].exponent = 1;
  materials[5].reflection = 1;
  materials[6].transmission = 1;
  materials[7].roughness = 1;
  materials[8].ior = 1.33, materials[8].emission = {4, 0, 0};
  const std::size_t plain = materials.size();
  materials.resize(plain + 6, glass());
  materials[plain].reflection = 0.5;
  materials[plain + 1].transmission = 0;
  materials[plain + 2].roughness = 0.3;
  materials[plain + 3].diffuse = 0.2, materials[plain + 3].color = {1, 0, 0};
  materials[plain + 4].ambient = 0.1;
  materials[plain + 5].emission = {1, 1, 1};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    CAPTURE(i);
    CHECK(check_material(materials[i]).empty());
  }
  CHECK(error_of([&] { (void)check_material({.type = "dielectric"}); }).place() == "/materials/m");
}

TEST_CASE("each type of light takes its members") {
  for (const char* type : {"ambient", "directional", "point", "spot", "rectangle", "disk", "sphere"}) {
    CAPTURE(type);
    CHECK(check_light({.type = type}).empty());
    CHECK(check_light({.type = type,
                       .color = {1, 0, 0},
                       .intensity = 0,
                       .position = {0, 3, 0},
                       .direction = {0, 0, -1},
                       .angle = 89,
                       .radius = 0.1,
                       .size = {0.1, 3},
                       .samples = 1024})
              .empty());
    CHECK(sundog::render(tiny_scene().set("/lights", "[]").add_light({.type = type, .position = {0, 4, 4}}),
                         {.devices = test_device()})
              .complete());
  }
}

TEST_CASE("a camera, a formula and a placement may leave out whatever has a default") {
  for (const sundog::Camera& camera :
       {sundog::Camera{}, sundog::Camera{.lens_radius = 0.1}, sundog::Camera{.focus = 2},
        sundog::Camera{.up = {1, 0, 0}, .fov = 179, .lens_radius = 0.1, .focus = 3}})
    CHECK(tiny_scene().set_camera(camera).check().empty());
  for (const sundog::Formula& formula :
       {sundog::Formula{.map = "z = z^2 + c"}, sundog::Formula{.distance = "length(p) - 1"},
        sundog::Formula{
            .map = "z = z^power + c", .parameters = {{"power", 8}}, .iterations = 5, .bailout = 4},
        sundog::Formula{.distance = "length(p) - 1", .low = {-2, -2, -2}, .high = {2, 2, 2}}}) {
    CAPTURE(formula.map, formula.distance);
    CHECK_NOTHROW((void)tiny_scene().add_formula(formula, sundog::Placement{}).check());
  }
  sundog::Mat4 right = sundog::identity;
  right[3] = 2;
  CHECK(tiny_scene()
            .add_box({0, 0, 0}, {1, 1, 1}, {.name = "box", .transform = right})
            .add_plane({0, -1, 0}, {0, 1, 0}, {})
            .check()
            .empty());
}

TEST_CASE("a mesh has normals, coordinates and colours or none of them") {
  const std::vector<std::array<float, 3>> three{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up(3, {0, 0, 2});
  const std::vector<std::array<float, 2>> uvs(3);
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  const sundog::MeshView plain{.positions = three, .triangles = triangles};
  std::vector<sundog::MeshView> views(4, plain);
  views[1].normals = up;
  views[2].uvs = uvs;
  views[3].colors = up, views[3].owner = std::make_shared<int>();
  for (const sundog::MeshView& view : views)
    CHECK(tiny_scene().add_mesh("one", view).add_instance("one", {}).check().empty());
}

TEST_CASE("each option of a render, a session, a file and a tone map counts by itself") {
  const sundog::Image picture = sundog::render(tiny_scene(), {.devices = test_device()}).image();
  std::vector<sundog::RenderOptions> options(4, sundog::RenderOptions{.devices = test_device()});
  options[1].work_group = sundog::WorkGroup{.x = 8};
  options[2].work_group = sundog::WorkGroup{.driver = true};
  options[3].tile = 4, options[3].time_limit = 1000, options[3].picture_seconds = 0;
  for (const sundog::RenderOptions& option : options) {
    const sundog::Film film = sundog::render(tiny_scene(), option);
    CHECK(same_pixels(film.image(), picture));
    const sundog::Figures& figures = film.figures();
    const sundog::DeviceFigures& device = figures.devices.at(0);
    CHECK(device.pixels == 16 * 12);
    CHECK_FALSE(device.retired);
  }
  sundog::Session session(test_device());
  std::vector<sundog::SessionOptions> settings(3);
  settings[1].coarse = false, settings[1].patience = 0;
  settings[2].work_group.x = 4, settings[2].tile = 8;
  for (const sundog::SessionOptions& setting : settings) {
    session.start(tiny_scene(), setting);
    CHECK(same_pixels(session.finish(), picture));
  }
  for (const sundog::ToneMap& map :
       {sundog::ToneMap{}, sundog::ToneMap{.curve = "reinhard"}, sundog::ToneMap{.curve = "aces"},
        sundog::ToneMap{.curve = "agx"}, sundog::ToneMap{.exposure = -32},
        sundog::ToneMap{.white_balance = 1667}})
    CHECK(std::isfinite(picture.tone_mapped(map).pixels()[0]));
  const TemporaryFolder folder;
  const auto file = folder.write("scene.json", tiny_scene().to_json());
  for (const sundog::LoadOptions& option :
       {sundog::LoadOptions{}, sundog::LoadOptions{.native_code = true},
        sundog::LoadOptions{.outside_files = true}, sundog::LoadOptions{.size = {16, 12}}})
    CHECK(sundog::Scene::load(file, option).check().empty());
  const fs::path moving = fs::path(SUNDOG_SOURCE_DIR) / "scenes/julia.json";
  CHECK(sundog::Scene::load(moving, sundog::LoadOptions{.frame = 3}).check().empty());
}

TEST_CASE("an error has the facts that it is made of, and a pick what the pixel shows") {
  const sundog::Error error(
      sundog::ErrorKind::scene, "a.json: /x: wanted a number",
      sundog::ErrorFacts{
          .file = "a.json", .place = "/x", .reason = "wanted a number", .log = "", .status = 0});
  CHECK((error.file() == "a.json" && error.place() == "/x" && error.reason() == "wanted a number"));
  sundog::Session session(test_device());
  session.start(tiny_scene());
  static_cast<void>(session.finish());
  const std::optional<sundog::Pick> pick = session.pick(8, 6);
  REQUIRE(pick);
  CHECK(pick->depth > 0);
}
