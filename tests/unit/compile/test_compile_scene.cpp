// Materials, media, lights, camera and what a scene uses, as the kernels read them.
#include "base/error.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "models/values/refraction.h"
#include "scene_text.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

SceneDescription glass_sphere() {
  SceneDescription scene;
  scene.media.resize(2);
  scene.media[1].ior = 1.5;
  MaterialDescription glass;
  glass.type = MaterialType::dielectric;
  glass.reflection = glass.transmission = dvec3(1);
  glass.medium = 1;
  scene.materials.push_back(glass);
  Object sphere;
  sphere.material = 0;
  scene.objects.push_back(sphere);
  return scene;
}

dvec3 xyz(const float4& v) { return {v.x, v.y, v.z}; }

void check_vector(const dvec3& found, const dvec3& expected) {
  for (int axis = 0; axis < 3; ++axis) CHECK(found[axis] == Approx(expected[axis]).margin(1e-6));
}

}  // namespace

TEST_CASE("the camera's pixel vectors span the image at depth 1") {
  SceneDescription scene;
  scene.camera.position = {1, 2, 3};
  scene.camera.target = {1, 2, -10};
  scene.camera.fov = 90;
  scene.image.width = 200;
  scene.image.height = 100;
  const SceneInfo info = compile(scene).info;
  check_vector(xyz(info.camera_forward), {0, 0, -1});
  check_vector(xyz(info.camera_corner), {-2, 1, -1});
  check_vector(xyz(info.camera_dx), {0.02, 0, 0});
  check_vector(xyz(info.camera_dy), {0, -0.02, 0});
  check_vector(xyz(info.camera_corner) + 200.0 * xyz(info.camera_dx) + 100.0 * xyz(info.camera_dy),
               {2, -1, -1});
  check_vector(xyz(info.camera_position), {1, 2, 3});
}

TEST_CASE("the same medium under two names becomes one, apart from the world's") {
  SceneDescription scene;
  scene.media.resize(5);  // 0: world; 1, 3: water; 2: like the world; 4: water of another priority
  scene.media[1].ior = scene.media[3].ior = scene.media[4].ior = 1.33;
  scene.media[4].priority = 2;
  for (int i = 0; i < 5; ++i) {
    scene.materials.emplace_back();
    scene.materials.back().medium = i;
  }
  const CompiledScene flat = compile(scene);
  REQUIRE(flat.media.size() == 4);
  CHECK(flat.materials[0].medium == 0);
  CHECK(flat.materials[1].medium == flat.materials[3].medium);
  CHECK(flat.materials[2].medium != 0);
  CHECK(flat.materials[4].medium != flat.materials[1].medium);
  CHECK(flat.media[flat.materials[4].medium].priority == 2);
  CHECK(flat.info.medium_count == 4);
}

TEST_CASE("material flags say what a surface does") {
  SceneDescription scene;
  scene.media.resize(2);
  MaterialDescription material;
  material.blinn = material.checker = material.shadow_opaque = material.vertex_color = true;
  material.checker_size = 0.25;
  material.exponent = 7;
  scene.materials.push_back(material);
  material = {};
  material.reflection = dvec3(0.5);
  material.transmission = dvec3(0.25);
  material.medium = 1;
  scene.materials.push_back(material);
  const CompiledScene flat = compile(scene);
  CHECK(flat.materials[0].flags ==
        (MATERIAL_BLINN | MATERIAL_CHECKER | MATERIAL_SHADOW_OPAQUE | MATERIAL_VERTEX_COLOR | MATERIAL_THIN));
  CHECK(flat.materials[0].checker_diffuse.w == 4);
  CHECK(flat.materials[0].specular.w == 7);
  CHECK(flat.materials[1].flags == (MATERIAL_REFLECTS | MATERIAL_TRANSMITS));
  CHECK(flat.materials[1].transmission == float4{0.25f, 0.25f, 0.25f, 0});
}

TEST_CASE("a material scatters as often as its facets have it, or once where its scene says so") {
  const auto material_of = [](const char* more) {
    const std::string text = R"({"objects": [{"type": "sphere", "material": "m"}],
      "materials": {"m": {"diffuse": 0, "reflection": 0.9, "roughness": 0.5)" +
                             std::string(more) + "}}}";
    return compile(load_scene_text(text)).materials[0];
  };
  const Material plain = material_of(""), often = material_of(R"(, "multiple_scattering": true)"),
                 once = material_of(R"(, "multiple_scattering": false)");
  CHECK((plain.flags & MATERIAL_SCATTERS_ONCE) == 0);
  CHECK(often.flags == plain.flags);
  CHECK(once.flags == (plain.flags | MATERIAL_SCATTERS_ONCE));
  CHECK(once.reflection == plain.reflection);
}

TEST_CASE("a thin wall has an index and no medium, and stops shadow rays where it is frosted for paths") {
  const auto compiled = [](const std::string& material, const char* integrator = "path") {
    SceneDescription scene = load_scene_text(R"({"objects": [{"type": "sphere", "material": "m"}],
      "materials": {"m": )" + material + "}}");
    scene.render.integrator = integrator;
    return compile(scene);
  };
  const std::string plain = R"({"type": "dielectric", "thin_walled": true, "ior": 1.4, "roughness": )",
                    pbr = R"({"type": "openpbr", "geometry_thin_walled": true, "transmission_weight": 0.5,
                             "specular_ior": 1.4, "transmission_color": [0.5, 1, 1], "transmission_depth": 2,
                             "specular_roughness": )";
  constexpr u32 wall = MATERIAL_THIN | MATERIAL_WALL | MATERIAL_TRANSMITS | MATERIAL_REFLECTS,
                frosted = MATERIAL_FROSTED | MATERIAL_SHADOW_OPAQUE;
  for (const std::string& text : {plain, pbr}) {
    const u32 also = text == pbr ? u32{MATERIAL_LAYERED} : 0;
    const CompiledScene smooth = compiled(text + "0}"), rough = compiled(text + "0.5}"),
                        blurred = compiled(text + "0.5}", "whitted"), narrow = compiled(text + "0.005}");
    CHECK(smooth.materials[0].flags == (wall | also));
    CHECK(narrow.materials[0].flags == (wall | also | MATERIAL_ROUGH));
    CHECK(rough.materials[0].flags == (wall | also | frosted | MATERIAL_ROUGH));
    CHECK(blurred.materials[0].flags == (wall | also | MATERIAL_ROUGH));
    CHECK(rough.materials[0].transmission.w == 1.4f);
    CHECK(rough.materials[0].kind == MATERIAL_DIELECTRIC);
    CHECK((rough.features.thin_walls && smooth.features.thin_walls && rough.features.rough));
    CHECK_FALSE((rough.features.media || rough.features.rough_glass || rough.features.shadow_filters));
    CHECK(smooth.features.shadow_filters);
    CHECK(rough.info.medium_count == 1);
  }
  CHECK(compiled(pbr + "0}").materials[0].transmission ==
        float4{0.25f, 0.5f, 0.5f, 1.4f});  // whatever the depth
  const std::string fixed = R"({"diffuse": 0, "reflection": 0.1, "transmission": 0.8, "roughness": 0.5)";
  const CompiledScene rough = compiled(fixed + "}");
  CHECK((rough.materials[0].flags & frosted) == frosted);
  CHECK_FALSE((rough.materials[0].flags & MATERIAL_WALL));
  CHECK(rough.features.thin_walls);
  // Light passes straight where the surface is cut away.
  for (const char* partly : {R"(, "opacity": 0.5})", R"(, "sides": "front"})"}) {
    const CompiledScene straight = compiled(fixed + partly);
    CHECK_FALSE((straight.materials[0].flags & frosted));
    CHECK_FALSE(straight.features.thin_walls);
  }
  CHECK((compiled(fixed + R"(, "shadow": "filter"})").materials[0].flags & frosted) == MATERIAL_FROSTED);
  CHECK_FALSE(compiled(fixed + "}", "whitted").features.thin_walls);
}

TEST_CASE("fields that let light through come first, as rays remember the sides of so many fields alone") {
  const CompiledScene compiled = compile(load_scene_text(R"({"objects": [
    {"type": "fractal", "formula": "menger", "material": "matte", "transform": [{"translate": [9, 0, 0]}]},
    {"type": "fractal", "formula": "menger", "material": "glass"}],
    "materials": {"matte": {"diffuse": 0.8}, "glass": {"type": "dielectric", "ior": 1.5}}})"));
  CHECK(compiled.features.near_fields);
  CHECK((compiled.instances[0].object == 1 && compiled.instances[0].touch == 1));
  CHECK((compiled.instances[1].object == 0 && compiled.instances[1].touch == 0));
}

TEST_CASE("features follow the materials that are used") {
  SceneDescription scene = glass_sphere();
  CompiledScene flat = compile(scene);
  CHECK((flat.features.secondary_rays && flat.features.media && flat.features.shadow_filters));
  CHECK(flat.features.shapes[SHAPE_SPHERE]);
  CHECK_FALSE(flat.features.shapes[SHAPE_MESH]);
  CHECK(flat.instances[0].flags == (INSTANCE_IDENTITY | INSTANCE_FILTERS | INSTANCE_TRANSMITS));

  scene.materials[0].shadow_opaque = true;
  CHECK_FALSE(compile(scene).features.shadow_filters);
  scene.materials[0].medium = -1;
  CHECK_FALSE(compile(scene).features.media);

  scene = glass_sphere();
  scene.materials.emplace_back();
  scene.objects[0].material = 1;
  flat = compile(scene);
  CHECK_FALSE(flat.features.secondary_rays);
  CHECK_FALSE(flat.features.media);
  CHECK_FALSE(flat.features.absorption);
  // Kernels without media have no members for these.
  scene.render.integrator = "path";
  scene.media.at(1).absorption = scene.media.at(1).scattering = {0.5, 0.1, 0};
  scene.media.at(1).dispersion = cauchy_of_abbe(1.5, 40);
  flat = compile(scene);
  CHECK_FALSE((flat.features.absorption || flat.features.scattering || flat.features.dispersion));
  scene = glass_sphere();
  scene.materials.emplace_back();
  scene.objects[0].material = 1;
  flat = compile(scene);
  scene.media[0].absorption = {0, 0.1, 0};
  CHECK(compile(scene).features.media);
  CHECK(compile(scene).features.absorption);

  CHECK_FALSE(flat.features.highlights);
  scene.materials[1].specular = {0, 0.1, 0};
  CHECK(compile(scene).features.highlights);
  scene.materials[1].specular = {0, 0, 0};
  scene.materials[1].metal_rough.emplace();
  CHECK(compile(scene).features.highlights);  // of its roughness
  scene.materials[1].metal_rough.reset();
  MaterialDescription& unused = scene.materials[0];
  unused.specular = dvec3(1);
  unused.roughness = 0.5;
  unused.layers.emplace();
  flat = compile(scene);
  CHECK_FALSE((flat.features.highlights || flat.features.rough || flat.features.layers));
  unused = glass_sphere().materials[0];

  CHECK_FALSE(flat.features.fractional_exponents);
  for (const double exponent : {20.5, 65536.0}) {
    scene.materials[1].exponent = exponent;
    CHECK(compile(scene).features.fractional_exponents);
  }
}

TEST_CASE("the camera inside a medium is noticed") {
  SceneDescription scene = glass_sphere();
  CHECK_FALSE(compile(scene).features.camera_inside);
  scene.camera.position = {0.1, 0, 0.5};
  CHECK(compile(scene).features.camera_inside);
  CHECK(compile(scene).info.camera_inside == 1);
  scene.objects[0].shape = PlaneShape{};
  scene.camera.position = {0, 1, 5};
  CHECK_FALSE(compile(scene).features.camera_inside);
  scene.camera.position = {0, -1, 5};
  CHECK(compile(scene).features.camera_inside);
}

TEST_CASE("lights are packed by kind, ambient ones summed") {
  SceneDescription scene;
  LightDescription light;
  light.type = LightType::ambient;
  light.color = {0.1, 0.2, 0.3};
  scene.lights = {light, light};
  light.type = LightType::directional;
  light.direction = {0, -3, 0};
  scene.lights.push_back(light);
  light.type = LightType::spot;
  light.position = {1, 2, 3};
  light.intensity = 10;
  light.inner_angle = 0;
  light.outer_angle = 60;
  light.falloff = {1, 2, 3};
  scene.lights.push_back(light);
  const CompiledScene flat = compile(scene);
  check_vector(xyz(flat.info.ambient), {0.2, 0.4, 0.6});
  REQUIRE(flat.lights.size() == 2);
  CHECK(flat.lights[0].kind == LIGHT_DIRECTIONAL);
  check_vector(xyz(flat.lights[0].direction), {0, -1, 0});
  CHECK(flat.lights[1].kind == LIGHT_SPOT);
  CHECK(flat.lights[1].direction.w == Approx(0.5));
  CHECK(flat.lights[1].edge_u.z == 1);
  check_vector(xyz(flat.lights[1].color), {1, 2, 3});
  CHECK(flat.lights[1].falloff_quadratic == 3);

  scene.lights[2].direction = {0, 0, 0};
  CHECK_THROWS_AS(compile(scene), SceneError);
}

TEST_CASE("vertex normals are unit length; those without direction take the faces' around them") {
  SceneDescription scene = scene_of(bumpy_sphere(10));
  for (glm::vec3& n : scene.meshes[0].normals) n *= 17.0f;
  scene.meshes[0].normals[25] = glm::vec3(0);
  scene.meshes[0].normals[26] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  const CompiledScene flat = compile(scene);
  REQUIRE(flat.vertices.size() == scene.meshes[0].positions.size());
  for (std::size_t i = 20; i < flat.vertices.size() - 20; ++i) {
    const Vertex& v = flat.vertices[i];
    const dvec3 n(v.nx, v.ny, v.nz), outward = glm::normalize(dvec3(scene.meshes[0].positions[i]));
    CHECK(glm::length(n) == Approx(1));
    CHECK(glm::dot(n, outward) > 0.5);
    CHECK((v.r == 1 && v.g == 1 && v.b == 1));
  }
}

TEST_CASE("a mesh without normals is faceted") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  const CompiledScene flat = compile(scene_of(mesh));
  REQUIRE(flat.vertices.size() == 6);
  for (std::size_t t = 0; t < 2; ++t)
    for (const u32 v : flat.triangles[t].vertex)
      CHECK((t == 0 ? flat.vertices[v].nz : flat.vertices[v].ny) == 1);
}

TEST_CASE("triangles keep their own materials, and what has none gets a default") {
  SceneDescription scene = scene_of(bumpy_sphere(4));
  scene.materials.resize(2);
  scene.meshes[0].materials.assign(scene.meshes[0].triangles.size(), 1);
  scene.objects[0].material = -1;
  CompiledScene flat = compile(scene);
  CHECK(flat.instances[0].material == NO_MATERIAL);
  CHECK(flat.triangles[5].material == 1);
  CHECK(flat.materials.size() == 2);

  scene.meshes[0].materials[5] = -1;
  flat = compile(scene);
  CHECK(flat.triangles[5].material == 2);
  CHECK(flat.materials.size() == 3);

  scene.objects[0].material = 1;
  CHECK(compile(scene).instances[0].material == 1);
}
