// Models: as scenes by themselves, as meshes with a name, and as objects.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "catch.h"
#include "scene/bounds.h"
#include "scene/load.h"
#include "scene/materials/conserve_light.h"
#include "scene/model_scene.h"
#include "scene/read/scene_reader.h"
#include "scene_text.h"

using namespace sundog;

namespace {

const MeshShape& mesh_of(const Object& object) { return std::get<MeshShape>(object.shape); }

/// Two spheres, a green one of its own medium and one without a material, as a model file might hold them.
Model two_spheres() {
  Model model;
  model.media.push_back({.name = "glass", .ior = 1.5});
  MaterialDescription green;
  green.name = "green";
  green.diffuse = {0, 1, 0};
  green.medium = 0;
  model.materials.push_back(green);
  model.objects.resize(2);
  model.objects[0].name = "left";
  model.objects[0].material = 0;
  model.objects[1].world_from_object[3] = {3, 0, 0, 1};
  return model;
}

SceneDescription read(const Model& model) {
  const TemporaryFolder folder;
  const JsonContext context{folder.write("model.glb", "known already: it is not read")};
  const nlohmann::json document = make_model_scene(context.file, model);
  return read_scene(JsonValue(document, context), model);
}

}  // namespace

TEST_CASE("a bare model becomes a scene: seen whole, lit, and grey") {
  const TemporaryFolder folder;
  const SceneDescription scene = load_scene(folder.write("tetra.ply", tetrahedron_ply));
  REQUIRE(scene.objects.size() == 2);  // with the ground
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].triangles.size() == 4);
  CHECK(scene.materials.at(static_cast<std::size_t>(scene.objects[0].material)).diffuse == dvec3(0.8));
  CHECK(scene.camera.target == dvec3(0.5));
  CHECK(scene.camera.position.y > 0.5);
  CHECK(scene.render.integrator == "path");
  CHECK(scene.environment.type == EnvironmentType::gradient);
  // The key light comes from the camera's side: it lights what the camera sees.
  const auto key = std::find_if(scene.lights.begin(), scene.lights.end(),
                                [](const auto& light) { return light.type == LightType::directional; });
  REQUIRE(key != scene.lights.end());
  CHECK(glm::dot(key->direction, scene.camera.target - scene.camera.position) > 0);
  CHECK(key->direction.y < 0);
}

namespace {

/// The tetrahedron with a material of these colours, as a model by itself.
SceneDescription lit(const dvec3& ambient, const dvec3& diffuse, double specular = 0, double exponent = 32) {
  Model model = two_spheres();
  model.materials = {{.name = "m",
                      .ambient = ambient,
                      .diffuse = diffuse,
                      .specular = dvec3(specular),
                      .exponent = exponent}};
  for (Object& object : model.objects) object.material = 0;
  return read(model);
}

/// The made-up sky's mean over a horizontal surface, weighted by the cosine.
dvec3 sky_of(const SceneDescription& scene) {
  return scene.environment.intensity * glm::mix(scene.environment.bottom, scene.environment.top, 5.0 / 6);
}

/// The greatest value that a surface which faces the key light and the zenith sends back.
double brightest(const SceneDescription& scene) {
  const dvec3 sky = sky_of(scene);
  const double light = scene.lights.at(0).intensity + std::max({sky.x, sky.y, sky.z});
  double most = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const MaterialDescription& m = scene.materials.at(static_cast<std::size_t>(scene.objects[i].material));
    const dvec3 sum = light * (m.exponent < 20 ? m.diffuse + m.specular : m.diffuse);
    most = std::max({most, sum.x, sum.y, sum.z});
  }
  return most;
}

}  // namespace

TEST_CASE("made-up lights leave no matte material white, and dark ones not black") {
  CHECK(brightest(lit(dvec3(0.1), dvec3(1))) == Approx(0.75));
  CHECK(brightest(lit(dvec3(1), dvec3(1))) == Approx(0.75));          // as OBJ's "Ka 1 1 1"
  CHECK(brightest(lit(dvec3(0.1), dvec3(1), 1, 1)) == Approx(0.75));  // a rough metal's broad highlight
  CHECK(brightest(lit(dvec3(0.1), dvec3(0.8))) == Approx(0.75));
  const double dark = brightest(lit(dvec3(0.01), dvec3(0.1)));
  CHECK(dark > 0.1);
  CHECK(dark < 0.3);
}

TEST_CASE("for paths a bare model's materials return no more light than they get") {
  const auto material_of = [](double diffuse, double specular, double exponent) {
    const SceneDescription scene = lit(dvec3(0), dvec3(diffuse), specular, exponent);
    CHECK(scene.render.integrator == "path");
    return scene.materials.at(static_cast<std::size_t>(scene.objects[0].material));
  };
  CHECK(material_of(0.8, 0.2, 32).diffuse.x == 0.8);
  CHECK(material_of(0.8, 0.5, 96).diffuse.x ==
        0.8);  // as Blender's usual MTL: a narrow highlight takes little
  CHECK(material_of(0.4, 0.6, 1).specular.x == 0.6);
  // Phong's max(r.v, 0)^e returns 2 / (e + 1) of uniform light: its integral over the hemisphere, over pi.
  const MaterialDescription broad = material_of(0.8, 0.5, 1), uniform = material_of(0.2, 0.9, 0);
  CHECK(broad.diffuse.x == Approx(0.8 / 1.3));
  CHECK(broad.specular.x == Approx(0.5 / 1.3));
  CHECK(uniform.diffuse.x == Approx(0.2 / 2));
}

TEST_CASE("a model without camera and lights stands on a matte ground of the horizon's colour") {
  const bool metal = GENERATE(false, true);
  const SceneDescription scene = metal ? lit(dvec3(0.1), dvec3(1), 1, 1) : read(two_spheres());
  const Object& ground = scene.objects.at(2);
  REQUIRE(std::holds_alternative<PlaneShape>(ground.shape));
  const SceneBounds bounds = bounds_of(scene.objects, scene.meshes);
  CHECK(ground.world_from_object[3].y < bounds.lower.y);
  CHECK(ground.world_from_object[3].y > bounds.lower.y - 0.01 * glm::length(bounds.upper - bounds.lower));
  const MaterialDescription& m = scene.materials.at(static_cast<std::size_t>(ground.material));
  CHECK(m.specular == dvec3(0));
  const LightDescription& key = scene.lights.at(0);
  const dvec3 lit_color = m.diffuse * (sky_of(scene) - key.intensity * glm::normalize(key.direction).y);
  const dvec3 horizon = 0.5 * (scene.image.background_bottom + scene.image.background_top);
  CHECK(glm::length(lit_color - horizon) < 1e-6);
  CHECK(std::max({m.diffuse.x, m.diffuse.y, m.diffuse.z}) < 0.8 + 1e-9);  // or light between would grow
}

TEST_CASE("a model with a camera or lights of its own, or seen from below, has no made-up ground") {
  Model model = two_spheres();
  model.camera = Camera{};
  CHECK(read(model).objects.size() == 2);
  model = two_spheres();
  model.lights.emplace_back();
  CHECK(read(model).objects.size() == 2);
  const TemporaryFolder folder;
  const auto file = folder.write("tetra.ply", tetrahedron_ply);
  CHECK(load_scene(file, {"/camera/position=[1,0.5,3]"}).objects.size() == 2);
  CHECK(load_scene(file, {"/camera/position=[1,-2,3]"}).objects.size() == 1);
  CHECK(load_scene(file, {"/camera/position/1=-2", "/image/width=99"}).objects.size() == 1);
}

TEST_CASE("a model's own camera, lights and image go before made-up ones") {
  Model model = two_spheres();
  model.camera = Camera{{1, 2, 3}, {4, 5, 7}, {0, 0, 1}, 33.25, 0.125, 1e6, {}, {}};
  model.image = ImageSettings{513, 257, {0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, false, false, {}};
  LightDescription spot;
  spot.type = LightType::spot;
  spot.color = {0.1, 0.7, 0.3};
  spot.intensity = 1.0 / 3;
  spot.position = {9, 8, 7};
  spot.direction = {0, 0, -1};
  spot.inner_angle = 0;
  spot.outer_angle = 90;
  spot.falloff = {0, 0, 1};
  model.lights = {spot};
  const SceneDescription scene = read(model);
  CHECK(scene.camera.position == dvec3(1, 2, 3));
  CHECK(scene.camera.target == dvec3(4, 5, 7));
  CHECK(scene.camera.up == dvec3(0, 0, 1));
  CHECK(scene.camera.fov == 33.25);
  CHECK(scene.camera.near == 0.125);
  CHECK(scene.camera.far == 1e6);
  CHECK(scene.image.width == 513);
  CHECK(scene.image.background_bottom == dvec3(0.1, 0.2, 0.3));
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].type == LightType::spot);
  CHECK(scene.lights[0].color == spot.color);
  CHECK(scene.lights[0].intensity == spot.intensity);
  CHECK(scene.lights[0].position == spot.position);
  CHECK(scene.lights[0].direction == spot.direction);
  CHECK(scene.lights[0].falloff == spot.falloff);
  CHECK(scene.lights[0].inner_angle == 0);
  CHECK(scene.lights[0].outer_angle == Approx(90).margin(0.02));
}

TEST_CASE("a model's indices become the scene's") {
  const SceneDescription scene = read(two_spheres());
  REQUIRE(scene.objects.size() == 3);  // with the ground
  REQUIRE(scene.media.size() == 2);
  CHECK(scene.media[1].ior == 1.5);
  const MaterialDescription& green = scene.materials.at(static_cast<std::size_t>(scene.objects[0].material));
  CHECK(green.diffuse == dvec3(0, 1, 0));
  CHECK(green.medium == 1);
  const MaterialDescription& grey = scene.materials.at(static_cast<std::size_t>(scene.objects[1].material));
  CHECK(grey.diffuse == dvec3(0.8));
  CHECK(scene.objects[0].name == "left");
  CHECK(scene.objects[1].world_from_object[3].x == 3);
}

TEST_CASE("instances share one mesh") {
  const SceneDescription scene = load_scene_text(R"({"materials": {"red": {}, "blue": {}},
    "meshes": {"t": {"file": "tetra.ply"}, "again": {"file": "./tetra.ply"}, "flat": {"file": "tetra.ply", "crease_angle": 0}},
    "objects": [
      {"type": "mesh", "mesh": "t"},
      {"type": "mesh", "mesh": "t", "material": "red", "transform": [{"translate": [1, 2, 3]}]},
      {"type": "group", "material": "blue", "objects": [{"type": "model", "file": "tetra.ply"}]},
      {"type": "mesh", "mesh": "again"}, {"type": "mesh", "mesh": "flat"}]})");
  REQUIRE(scene.objects.size() == 5);
  CHECK(scene.meshes.size() == 2);
  for (std::size_t i = 1; i < 4; ++i) CHECK(mesh_of(scene.objects[i]).mesh == mesh_of(scene.objects[0]).mesh);
  CHECK(mesh_of(scene.objects[4]).mesh != mesh_of(scene.objects[0]).mesh);
  const auto name = [&](std::size_t i) {
    return scene.materials.at(static_cast<std::size_t>(scene.objects[i].material)).name;
  };
  CHECK(name(0) == "grey");
  CHECK(name(1) == "red");
  CHECK(name(2) == "blue");
  CHECK(scene.objects[1].world_from_object[3] == glm::dvec4(1, 2, 3, 1));
  CHECK(scene.objects[2].place == "/objects/2/objects/0");
}

TEST_CASE("a generated mesh is placed like any other") {
  const SceneDescription scene = load_scene_text(R"({"materials": {"m": {}},
    "meshes": {"ice": {"generate": {"type": "ice_block", "subdivision": 4}}},
    "objects": [{"type": "mesh", "mesh": "ice", "material": "m"}, {"type": "mesh", "mesh": "ice", "material": "m"}]})");
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].name == "ice");
  CHECK(scene.meshes[0].triangles.size() == 12 * 4 * 4);
  CHECK(scene.objects.size() == 2);
}

TEST_CASE("a box around objects counts meshes and turned solids, and no planes") {
  const SceneDescription scene = load_scene_text(R"({"materials": {"m": {}}, "objects": [
    {"type": "plane", "material": "m"}, {"type": "model", "file": "tetra.ply", "transform": [{"translate": [5, 0, 0]}]},
    {"type": "cylinder", "material": "m", "radius": 0.5, "from": [0, 0, 0], "to": [0, 0, 4]}]})");
  const SceneBounds bounds = bounds_of(scene.objects, scene.meshes);
  CHECK(glm::length(bounds.lower - dvec3(-0.5, -0.5, 0)) < 1e-12);
  CHECK(glm::length(bounds.upper - dvec3(6, 1, 4)) < 1e-12);
  CHECK(bounds_of({}, {}).empty());
  CHECK(bounds_of(std::span(scene.objects).first(1), scene.meshes).empty());
}

TEST_CASE("an empty scene keeps the plain camera") {
  const SceneDescription scene = load_scene_text(R"({"objects": []})");
  CHECK(scene.camera.position == dvec3(0, 0, 5));
  CHECK(scene.camera.target == dvec3(0));
}

TEST_CASE("a model without surfaces is warned of, and what a model warns of is passed on") {
  Model model;
  model.warnings = {"something was read past"};
  const SceneDescription scene = read(model);
  CHECK(scene.objects.empty());
  CHECK(scene.warnings ==
        std::vector<std::string>{"model.glb: something was read past", "model.glb: holds no surfaces"});
}
