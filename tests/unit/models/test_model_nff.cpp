// NFF, from a small file written here, and the Standard Procedural Databases of the optional assets.
#include "assets.h"
#include "catch.h"
#include "model_files.h"

using namespace sundog;

namespace {

const std::string scene = R"(# a small scene
b 0.1 0.2 0.3
v
from 1 2 3
at 0 0 1
up 0 0 1
angle 45
hither 0.5
resolution 640 480
l 4 3 2
l 1 -4 4 1 0.5 0.25
f 1 0.5 0.25 0.8 0.2 30 0 0
p 4
0 0 0
2 0 0
2 2 0
0 2 0
s 1 2 3 -0.5
f 1 1 1 0.1 0.1 100 0.9 1.5
c
0 0 0 1
0 4 0 1
c 1 1 1 2
  5 1 1 0.5
pp 3
0 0 0 0 0 2
1 0 0 0 1 0
0 1 0 1 0 0
p 3
0 0 1
1 0 1
0 1 1
)";

dvec3 at(const Object& object, dvec3 p) { return dvec3(object.world_from_object * glm::dvec4(p, 1)); }

}  // namespace

TEST_CASE("an NFF's view and background become camera and image", "[models]") {
  const Model model = load_text("a.nff", scene);
  REQUIRE(model.camera);
  CHECK(model.camera->position == dvec3(1, 2, 3));
  CHECK(model.camera->target == dvec3(0, 0, 1));
  CHECK(model.camera->up == dvec3(0, 0, 1));
  CHECK(model.camera->fov == 45);
  CHECK(model.camera->near == 0.5);
  REQUIRE(model.image);
  CHECK(model.image->width == 640);
  CHECK(model.image->height == 480);
  CHECK(model.image->background_bottom == dvec3(0.1, 0.2, 0.3));
  CHECK(model.image->background_top == dvec3(0.1, 0.2, 0.3));
}

TEST_CASE("an NFF's lights share SPD's intensity with an ambient one", "[models]") {
  const Model model = load_text("a.nff", scene);
  REQUIRE(model.lights.size() == 3);
  for (const LightDescription& light : model.lights) CHECK(light.intensity == Approx(std::sqrt(2.0) / 4));
  CHECK(model.lights[1].position == dvec3(1, -4, 4));
  CHECK(model.lights[1].color == dvec3(1, 0.5, 0.25));
  CHECK(model.lights[2].type == LightType::ambient);
}

TEST_CASE("an NFF's fills hold Whitted's constants", "[models]") {
  const Model model = load_text("a.nff", scene);
  REQUIRE(model.materials.size() == 2);
  CHECK(model.materials[0].diffuse == dvec3(0.8, 0.4, 0.2));
  CHECK(model.materials[0].specular == dvec3(0.2));
  CHECK(model.materials[0].reflection == dvec3(0.2));
  CHECK(model.materials[0].exponent == 30);
  CHECK(model.materials[0].medium == -1);
  CHECK(model.materials[1].transmission == dvec3(0.9));
  REQUIRE(model.materials[1].medium == 0);
  CHECK(model.media.at(0).ior == 1.5);
}

TEST_CASE("an NFF's spheres, cones and cylinders stay exact, and open", "[models]") {
  const Model model = load_text("a.nff", scene);
  REQUIRE(model.objects.size() == 5);  // sphere, mesh of fill 1, cylinder, cone, mesh of fill 2
  CHECK(std::get<SphereShape>(model.objects[0].shape).radius == 0.5);
  CHECK(at(model.objects[0], {0, 0, 0}) == dvec3(1, 2, 3));
  CHECK(model.objects[0].place == "line 18");
  const auto cylinder = std::get<CylinderShape>(model.objects[2].shape);
  CHECK(cylinder.radius == 1);
  CHECK(cylinder.half_height == 2);
  CHECK_FALSE(cylinder.capped);
  const auto cone = std::get<ConeShape>(model.objects[3].shape);
  CHECK(cone.bottom_radius == 2);
  CHECK(cone.top_radius == 0.5);
  CHECK_FALSE(cone.capped);
  CHECK(glm::length(at(model.objects[3], {0, -cone.half_height, 0}) - dvec3(1, 1, 1)) < 1e-12);
  CHECK(glm::length(at(model.objects[3], {0, cone.half_height, 0}) - dvec3(5, 1, 1)) < 1e-12);
  CHECK(glm::determinant(model.objects[3].world_from_object) == Approx(1));
  CHECK(model.objects[3].material == 1);
}

TEST_CASE("an NFF's polygons are flat, its patches smooth, one mesh a fill", "[models]") {
  const Model model = load_text("a.nff", scene);
  REQUIRE(model.meshes.size() == 2);
  CHECK(model.meshes[0].triangles.size() == 2);
  CHECK(model.meshes[0].normals.empty());
  CHECK(model.meshes[0].materials == std::vector<int>{0, 0});
  const Mesh& mixed = model.meshes[1];
  REQUIRE(mixed.triangles.size() == 2);
  CHECK(mixed.materials == std::vector<int>{1, 1});
  CHECK(mixed.normals[mixed.triangles[0].x] == glm::vec3(0, 0, 1));
  CHECK(mixed.normals[mixed.triangles[0].y] == glm::vec3(0, 1, 0));
  for (int k = 0; k < 3; ++k) CHECK(mixed.normals[mixed.triangles[1][k]] == glm::vec3(0, 0, 1));
}

TEST_CASE("a bad NFF is refused with its line", "[models]") {
  CHECK_THAT(load_error("a.nff", "x 1 2 3\n"), ContainsSubstring("line 1: one of v b l f s c p pp"));
  CHECK_THAT(load_error("a.nff", "f 1 1 1 1 0 1 0 0\ns 0 0 0 0\n"),
             ContainsSubstring("line 2: a sphere of radius 0"));
  CHECK_THAT(load_error("a.nff", "s 0 0 0"), ContainsSubstring("the file ends before a sphere's radius"));
  CHECK_THAT(load_error("a.nff", "c\n0 0 0 1\n0 0 0 1\n"), ContainsSubstring("coincide"));
  CHECK_THAT(load_error("a.nff", "c\n0 0 0 1\n0 0 1 -1\n"),
             ContainsSubstring("line 3") && ContainsSubstring("sign"));
  CHECK_THAT(load_error("a.nff", "p 2\n0 0 0\n1 0 0\n"), ContainsSubstring("line 1: a polygon of 2 corners"));
  CHECK_THAT(load_error("a.nff", "p 4000000000\n0 0 0\n"), ContainsSubstring("the file ends"));
  CHECK_THAT(load_error("a.nff", "f 1 1 1 1 0 1 0.5 0\n"),
             ContainsSubstring("line 1: an index of refraction of 0"));
  CHECK_THAT(load_error("a.nff", "v\nfrom 0 0 0\nat 0 0 1\nup 0 1 0\nangle 180\n"),
             ContainsSubstring("line 5"));
  CHECK_THAT(load_error("a.nff", "l 1 2 3\n"), ContainsSubstring("no objects"));
}

TEST_CASE("the Standard Procedural Databases have their published counts", "[assets]") {
  if (assets_directory().empty()) return;
  struct Count {
    const char* name;
    std::size_t spheres, cones, triangles, lights;
  };
  // Primitives and lights as published; a quadrilateral counts as two triangles here.
  for (const Count& want :
       {Count{"balls", 7381, 0, 2, 3}, Count{"rings", 4200, 4200, 2, 3}, Count{"tetra", 0, 0, 4096, 1},
        Count{"mount", 4, 0, 8192, 1}, Count{"teapot", 0, 0, 9120 + 288, 2}}) {
    INFO(want.name);
    const Model model =
        load_model(assets_directory() / "reference/spd" / (std::string(want.name) + ".nff.gz"));
    Count found{want.name, 0, 0, 0, model.lights.size() - 1};
    for (const Object& object : model.objects) {
      found.spheres += std::holds_alternative<SphereShape>(object.shape);
      found.cones += std::holds_alternative<ConeShape>(object.shape) ||
                     std::holds_alternative<CylinderShape>(object.shape);
    }
    for (const Mesh& mesh : model.meshes) found.triangles += mesh.triangles.size();
    CHECK(found.spheres == want.spheres);
    CHECK(found.cones == want.cones);
    CHECK(found.triangles == want.triangles);
    CHECK(found.lights == want.lights);
    CHECK(model.camera.has_value());
    CHECK(model.image.value().width == 512);
  }
}
